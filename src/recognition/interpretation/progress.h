/** \file
 * Progress and cancellation of an interpretation; internal, not installed. */
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>

namespace pcl_surflet {
namespace interpretation {

/** \brief Asks DissertationParameters::progress whether to go on. */
class ProgressReport {
public:
  /** \param cancelled is set once the callback says no */
  ProgressReport(const std::function<bool(double)>& callback, bool& cancelled)
      : callback_(callback), cancelled_(cancelled)
  {
  }

  /** \brief Tells the calling thread's callback that \p share is done. \return false if cancelled,
   * now or before */
  bool
  goesOn(double share)
  {
    last_ = std::max(last_, share);
    if (!cancelled_ && callback_ && !callback_(last_))
      cancelled_ = stop_ = true;
    return !cancelled_;
  }

  /** \brief What follows are \p items of a parallelFor(), which bring the share from \p from to
   * \p to. */
  void
  beginPart(double from, double to, std::size_t items)
  {
    from_ = from;
    step_ = items > 0 ? (to - from) / static_cast<double>(items) : 0;
    begun_ = 0;
  }

  /** \brief To be asked at the beginning of every item. Worker 0 is the calling thread and the only
   * one that calls back; the others see what it was told. */
  bool
  goesOnInPart(unsigned worker)
  {
    const auto begun = static_cast<double>(begun_++);
    if (worker == 0 && !stop_)
      goesOn(from_ + step_ * begun);
    return !stop_;
  }

private:
  const std::function<bool(double)>& callback_;
  bool& cancelled_;
  double last_ = 0, from_ = 0, step_ = 0;
  std::atomic<std::size_t> begun_{0};
  std::atomic<bool> stop_{false};
};

} // namespace interpretation
} // namespace pcl_surflet
