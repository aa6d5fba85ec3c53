/** \file
 * Work on many files by several ranks. */
#pragma once

#include "parallel/packing.h"
#include "parallel/ranks.h"

namespace pcl_surflet {
namespace apps {

/** \brief Ranks::shareOut() with answers of any type that packing.h knows or that has a member
 * serialize(); with one rank they are not packed. */
template <class Answer, class Work, class Take>
void
shareOut(Ranks& ranks, std::size_t items, const Work& work, const Take& take)
{
  if (ranks.size() == 1) {
    for (std::size_t i = 0; i < items; ++i)
      take(i, work(i));
    return;
  }
  ranks.shareOut(
      items, [&](std::size_t i) { return packed(work(i)); },
      [&](std::size_t i, const Bytes& answer) { take(i, unpacked<Answer>(answer)); });
}

} // namespace apps
} // namespace pcl_surflet
