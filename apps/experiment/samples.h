/** \file
 * The clouds that recognisers other than the mesh-trained ones learn from. */
#pragma once

#include "experiment/objects.h"
#include "pcl_surflet/core/surflet_set.h"

#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Samples of an object for training [Wahl 2007, Sec. 3.6.1]. */
constexpr unsigned kTrainingRounds = 5;

/** \brief Seed of the training samples of object number \p object; no query has it. */
std::uint64_t trainingSeed(std::uint64_t seed, std::size_t object);

/** \brief kTrainingRounds even samples with estimated normals, in the frame of the mesh. */
std::vector<SurfletSet> unturnedSamples(const ExperimentObject& object, std::uint64_t seed);

} // namespace apps
} // namespace pcl_surflet
