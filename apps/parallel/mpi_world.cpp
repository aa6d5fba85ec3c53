// Ranks by Boost.MPI.
#include "app_common.h"
#include "parallel/foreman.h"
#include "parallel/launcher.h"
#include "parallel/world.h"

#include <boost/mpi/collectives.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cstdlib>
#include <functional>

namespace pcl_surflet {
namespace apps {
namespace {

namespace mpi = boost::mpi;

class MpiWorld : public World {
public:
  int
  rank() const override
  {
    return ranks_.rank();
  }
  int
  size() const override
  {
    return ranks_.size();
  }

  std::vector<Bytes>
  fromAll(const Bytes& own) override
  {
    std::vector<Bytes> all;
    mpi::all_gather(ranks_, own, all);
    return all;
  }

  void
  fromFirst(Bytes& content) override
  {
    // MPI counts what it sends as int.
    constexpr std::size_t kMost = std::size_t{1} << 30;
    std::uint64_t size = content.size();
    mpi::broadcast(ranks_, size, 0);
    content.resize(size);
    for (std::size_t at = 0; at < size; at += kMost)
      mpi::broadcast(ranks_, content.data() + at,
                     static_cast<int>(std::min<std::size_t>(kMost, size - at)), 0);
  }

  void
  sum(std::vector<std::uint64_t>& numbers) override
  {
    // mpi::inplace() would have Boost refer to an address that is none.
    const auto mine = numbers;
    mpi::all_reduce(ranks_, mine.data(), static_cast<int>(mine.size()), numbers.data(),
                    std::plus<std::uint64_t>());
  }

  void
  shareOut(std::size_t items, const Work& work, const Take& take) override
  {
    if (rank() == 0)
      Foreman(ranks_, items, work, take).run();
    else
      workForForeman(ranks_, work);
  }

  std::string
  machine() const override
  {
    return mpi::environment::processor_name();
  }

  [[noreturn]] void
  abort(int code) override
  {
    mpi::environment::abort(code);
    std::abort(); // not reached
  }

private:
  // Only the main thread speaks to MPI. Boost.MPI would end all ranks when an exception passes by.
  mpi::environment environment_{mpi::threading::funneled, false};
  mpi::communicator ranks_;
};

} // namespace

std::unique_ptr<World>
joinWorld()
{
  const Launch launch = launchOf();
  if (!launch.by_launcher)
    return nullptr;
  auto world = std::make_unique<MpiWorld>();
  if (launch.processes > 1 && world->size() == 1)
    throw DataError("started several times, but not by a launcher of the MPI that this program was "
                    "built with; take that one's mpirun, or set PCL_SURFLET_MPI=off to let every "
                    "process do all the work");
  if (world->size() == 1)
    return nullptr; // ends MPI again
  return world;
}

} // namespace apps
} // namespace pcl_surflet
