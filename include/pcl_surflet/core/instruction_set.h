/** \file
 * Which instruction set the kernels use. */
#pragma once

#include "pcl_surflet/export.h"

namespace pcl_surflet {

/** \brief Instruction sets for which there are kernels. */
enum class InstructionSet {
  Automatic, ///< the best that the processor offers
  Scalar,    ///< the oracle: one pair at a time
  Baseline,  ///< the fallback: four lanes of what every processor of the platform has
  Avx2,      ///< eight lanes
  Avx512     ///< sixteen lanes
};

/** \brief Selects the kernels of all later calls in this process; Automatic takes the best the
 * processor offers. For tests and benchmarks: results do not depend on it, only speed does.
 * Not meant to be called while other threads compute.
 * \return false, changing nothing, if this processor or build has no such instruction set. */
PCL_SURFLET_API bool selectInstructionSet(InstructionSet set);

/** \brief Name of the instruction set in use: "scalar", "baseline", "avx2" or "avx512". */
PCL_SURFLET_API const char* activeInstructionSet();

} // namespace pcl_surflet
