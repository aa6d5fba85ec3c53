/** \file
 * Items of work go to whichever rank is free: they differ too much in size to be dealt out before.
 */
#pragma once

#include "parallel/world.h"

#include <boost/mpi/communicator.hpp>

#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>

namespace pcl_surflet {
namespace apps {

/** \brief The first rank: hands out the items, takes the answers in order, and works itself in a
 * second thread, which does not speak to MPI. */
class Foreman {
public:
  Foreman(const boost::mpi::communicator& ranks, std::size_t items, const World::Work& work,
          const World::Take& take);
  void run();

private:
  std::optional<std::size_t> nextItem();
  void workAlong();
  bool receiveAnswers();
  bool handOut();
  bool takeNext();
  void dismissAll();
  void keep(std::size_t item, Bytes answer);

  const boost::mpi::communicator& ranks_;
  const std::size_t items_;
  const World::Work& work_;
  const World::Take& take_;
  const std::size_t most_waiting_; ///< answers, so that memory stays bounded
  std::deque<int> free_;           ///< ranks without work

  std::mutex mutex_; ///< of what follows
  std::size_t next_ = 0, taken_ = 0;
  std::map<std::size_t, Bytes> answers_;
  std::exception_ptr failure_; ///< of the thread that works
};

/** \brief The other ranks, until the foreman has no more. */
void workForForeman(const boost::mpi::communicator& ranks, const World::Work& work);

} // namespace apps
} // namespace pcl_surflet
