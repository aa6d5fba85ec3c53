/** \file
 * Which instruction set the kernels use. */
#pragma once

#include "pcl_surflet/export.h"

namespace pcl_surflet {

/** Scalar is the oracle: one pair at a time. Baseline is the fallback, four lanes of what every
 * processor of the platform has. */
enum class InstructionSet { Automatic, Scalar, Baseline, Avx2, Avx512 };

/** \brief Selects the kernels of all later calls in this process; Automatic takes the best the
 * processor offers. For tests and benchmarks: results do not depend on it, only speed does.
 * Not meant to be called while other threads compute.
 * \return false, changing nothing, if this processor or build has no such instruction set. */
PCL_SURFLET_API bool selectInstructionSet(InstructionSet set);

/** \brief Name of the instruction set in use: "scalar", "baseline", "avx2" or "avx512". */
PCL_SURFLET_API const char* activeInstructionSet();

} // namespace pcl_surflet
