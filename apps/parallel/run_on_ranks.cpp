#include "app_common.h"
#include "parallel/ranks.h"

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Others may be waiting for this rank: they must not wait for ever. */
[[noreturn]] void
endAll(const std::string& program, const Ranks& ranks, const std::string& what)
{
  complain(program + ": rank " + std::to_string(ranks.rank()) + " of " +
           std::to_string(ranks.size()) + ": " + what + "; all ranks end");
  ranks.abort(kBadData);
}

int
runOn(const std::string& program, const Ranks& ranks,
      const std::function<int(const Ranks& ranks)>& body)
{
  try {
    const int code = body(ranks);
    return ranks.isFirst() ? code : kOk;
  }
  catch (const ReportedElsewhere&) {
    return kOk;
  }
  catch (const SharedError& error) {
    throw;
  }
  catch (const std::exception& error) {
    if (ranks.size() > 1)
      endAll(program, ranks, error.what());
    throw;
  }
}

} // namespace

int
runOnRanks(const std::string& program, const std::function<int(const Ranks& ranks)>& body)
{
  return runMain(program, [&] {
    const Ranks ranks;
    return runOn(program, ranks, body);
  });
}

} // namespace apps
} // namespace pcl_surflet
