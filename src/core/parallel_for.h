/** \file
 * Work items shared among threads. */
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pcl_surflet {
namespace detail {

/** \brief Calls \p work(i) once for every i below \p n from \p threads threads (0 = all of the
 * machine). Items go to whoever is free, \p grain at a time, so each must write to places of its
 * own. The first exception is passed on to the caller. */
template <class Work>
void
parallelFor(std::size_t n, unsigned threads, std::size_t grain, const Work& work)
{
  if (threads == 0)
    threads = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t blocks = (n + grain - 1) / grain;
  threads = static_cast<unsigned>(std::min<std::size_t>(threads, blocks));
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (std::size_t block; (block = next++) < blocks;)
        for (std::size_t i = block * grain; i < std::min(n, (block + 1) * grain); ++i)
          work(i);
    }
    catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      error = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (unsigned t = 1; t < threads; ++t)
    others.emplace_back(run);
  run();
  for (auto& thread : others)
    thread.join();
  if (error)
    std::rethrow_exception(error);
}

} // namespace detail
} // namespace pcl_surflet
