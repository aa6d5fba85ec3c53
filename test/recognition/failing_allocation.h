/** \file
 * Memory that runs out when a test wants it to. A program that links this has it everywhere. */
#pragma once

namespace pcl_surflet {
namespace test {

/** \brief Allocations of this thread that still succeed; negative: all. */
extern thread_local long allocations_left;

} // namespace test
} // namespace pcl_surflet
