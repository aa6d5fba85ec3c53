#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pcl_surflet {

unsigned
resolveThreads(unsigned threads)
{
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

void
parallelFor(std::size_t items, unsigned threads,
            const std::function<void(std::size_t, unsigned)>& work)
{
  threads = static_cast<unsigned>(std::min<std::size_t>(resolveThreads(threads), items));
  if (threads <= 1) {
    for (std::size_t i = 0; i < items; ++i)
      work(i, 0);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&](unsigned worker) {
    try {
      for (std::size_t i = next++; i < items; i = next++)
        work(i, worker);
    }
    catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure)
        failure = std::current_exception();
      next = items;
    }
  };
  std::vector<std::thread> pool;
  pool.reserve(threads - 1);
  try {
    for (unsigned t = 1; t < threads; ++t)
      pool.emplace_back(run, t);
  }
  catch (const std::exception&) {
    // No more threads, or no memory for one: those there are do all the work. An exception from
    // here would end the program, as they still run.
  }
  run(0);
  for (auto& thread : pool)
    thread.join();
  if (failure)
    std::rethrow_exception(failure);
}

} // namespace pcl_surflet
