#include "parallel/ranks.h"

#include "app_common.h"

#include <algorithm>
#include <cstdio>
#include <exception>

#include <sched.h>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief The processors that this process may use, as bytes that can be compared. */
Bytes
allowedProcessors(unsigned& count)
{
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0)
    return {};
  count = static_cast<unsigned>(CPU_COUNT(&set));
  return {reinterpret_cast<const char*>(&set), sizeof set};
}

} // namespace

Ranks::Ranks() : world_(joinWorld())
{
  if (!isFirst() && std::freopen("/dev/null", "w", stdout) == nullptr)
    throw DataError("cannot open /dev/null");
}

Ranks::~Ranks() = default;

int
Ranks::rank() const
{
  return world_ ? world_->rank() : 0;
}

int
Ranks::size() const
{
  return world_ ? world_->size() : 1;
}

unsigned
Ranks::threads(std::uint64_t wanted)
{
  if (!world_ || wanted > 0)
    return static_cast<unsigned>(wanted);
  // Launchers may bind every rank to processors of its own, or let those of a machine share all.
  unsigned processors = 1;
  const Bytes own = world_->machine() + '\0' + allowedProcessors(processors);
  const auto all = world_->fromAll(own);
  const auto sharing = static_cast<unsigned>(std::count(all.begin(), all.end(), own));
  return std::max(1u, processors / sharing);
}

void
Ranks::together(const std::function<void()>& work)
{
  if (!world_)
    return work();
  std::exception_ptr failure;
  Bytes what;
  try {
    work();
  }
  catch (const std::exception& error) {
    failure = std::current_exception();
    what = "rank " + std::to_string(rank()) + " on " + world_->machine() + ": " + error.what();
  }
  const auto all = world_->fromAll(what);
  const auto first =
      std::find_if(all.begin(), all.end(), [](const Bytes& b) { return !b.empty(); });
  if (first == all.end())
    return;
  all_end_ = true;
  if (!isFirst())
    throw ReportedElsewhere();
  if (failure)
    std::rethrow_exception(failure);
  throw DataError(*first);
}

void
Ranks::shareOut(std::size_t items, const World::Work& work, const World::Take& take)
{
  world_->shareOut(items, work, take);
}

Bytes
Ranks::fromFirst(Bytes content)
{
  if (world_)
    world_->fromFirst(content);
  return content;
}

PairHistogram
Ranks::sum(PairHistogram own)
{
  if (!world_)
    return own;
  own.counts.push_back(own.features);
  own.counts.push_back(own.rejected);
  world_->sum(own.counts);
  own.rejected = own.counts.back();
  own.counts.pop_back();
  own.features = own.counts.back();
  own.counts.pop_back();
  return own;
}

void
Ranks::endAll(const std::string& program, const std::string& error)
{
  if (!world_ || all_end_)
    return;
  complain(program + ": rank " + std::to_string(rank()) + " on " + world_->machine() + ": " +
           error + "; all ranks end");
  world_->abort(kBadData);
}

void
Ranks::requireSameArguments(int argc, char** argv)
{
  Bytes own;
  for (int i = 1; i < argc; ++i)
    own += argv[i] + Bytes(1, '\0');
  const Bytes first = fromFirst(own);
  together([&] {
    if (own != first)
      throw UsageError(
          "started with other arguments than the first rank; give all the same, or set "
          "PCL_SURFLET_MPI=off to let every process work for itself");
  });
}

int
runOnRanks(const std::string& program, int argc, char** argv,
           const std::function<int(Ranks& ranks)>& body)
{
  return runMain(program, [&] {
    Ranks ranks;
    try {
      ranks.requireSameArguments(argc, argv);
      const int code = body(ranks);
      return ranks.isFirst() ? code : kOk;
    }
    catch (const ReportedElsewhere&) {
      return kOk;
    }
    catch (const std::exception& error) {
      ranks.endAll(program, error.what());
      throw;
    }
  });
}

} // namespace apps
} // namespace pcl_surflet
