#include "parallel/foreman.h"

#include <boost/mpi/nonblocking.hpp>
#include <boost/mpi/status.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>

#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

namespace pcl_surflet {
namespace apps {
namespace {

namespace mpi = boost::mpi;

enum Tag { kItem, kAnswer };
constexpr std::size_t kNoMore = std::numeric_limits<std::size_t>::max();
/** \brief MPI counts the bytes of a message as int. */
constexpr std::size_t kLargestAnswer = std::numeric_limits<int>::max() - 1000;
constexpr std::size_t kWaitingPerRank = 4;

using Answer = std::pair<std::size_t, Bytes>;

/** \brief MPI's own waiting takes a whole processor, which others need. */
void
rest()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

} // namespace

Foreman::Foreman(const mpi::communicator& ranks, std::size_t items, const World::Work& work,
                 const World::Take& take)
    : ranks_(ranks), items_(items), work_(work), take_(take),
      most_waiting_(kWaitingPerRank * static_cast<std::size_t>(ranks.size()))
{
  for (int r = 1; r < ranks.size(); ++r)
    free_.push_back(r);
}

std::optional<std::size_t>
Foreman::nextItem()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (next_ == items_ || next_ >= taken_ + most_waiting_)
    return std::nullopt;
  return next_++;
}

void
Foreman::keep(std::size_t item, Bytes answer)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  answers_.emplace(item, std::move(answer));
}

void
Foreman::workAlong()
{
  const auto allGivenOut = [&] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return next_ == items_;
  };
  try {
    while (!allGivenOut())
      if (const auto item = nextItem())
        keep(*item, work_(*item));
      else
        rest();
  }
  catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = std::current_exception();
  }
}

bool
Foreman::receiveAnswers()
{
  bool any = false;
  while (const auto status = ranks_.iprobe(mpi::any_source, kAnswer)) {
    Answer answer;
    ranks_.recv(status->source(), kAnswer, answer);
    keep(answer.first, std::move(answer.second));
    free_.push_back(status->source());
    any = true;
  }
  return any;
}

bool
Foreman::handOut()
{
  bool any = false;
  while (!free_.empty()) {
    const auto item = nextItem();
    if (!item)
      break;
    ranks_.send(free_.front(), kItem, *item);
    free_.pop_front();
    any = true;
  }
  return any;
}

bool
Foreman::takeNext()
{
  Bytes answer;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_)
      std::rethrow_exception(failure_);
    const auto at = answers_.find(taken_);
    if (at == answers_.end())
      return false;
    answer = std::move(at->second);
    answers_.erase(at);
  }
  take_(taken_, answer);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++taken_;
  return true;
}

void
Foreman::dismissAll()
{
  for (int r = 1; r < ranks_.size(); ++r)
    ranks_.send(r, kItem, kNoMore);
}

void
Foreman::run()
{
  std::thread worker([this] { workAlong(); });
  try {
    while (taken_ < items_) { // only this thread changes it
      const bool received = receiveAnswers(), gave = handOut(), took = takeNext();
      if (!received && !gave && !took)
        rest();
    }
  }
  catch (...) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      next_ = items_;
    }
    worker.join();
    throw;
  }
  worker.join();
  dismissAll();
}

void
workForForeman(const mpi::communicator& ranks, const World::Work& work)
{
  for (;;) {
    while (!ranks.iprobe(0, kItem))
      rest();
    std::size_t item = 0;
    ranks.recv(0, kItem, item);
    if (item == kNoMore)
      return;
    Answer answer(item, work(item));
    if (answer.second.size() > kLargestAnswer)
      throw std::length_error(
          "the results of one file are larger than 2 GiB, which cannot be sent; "
          "run it with one process");
    ranks.send(0, kAnswer, answer);
  }
}

} // namespace apps
} // namespace pcl_surflet
