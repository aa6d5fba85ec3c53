/** \file
 * Collections of shapes with classes, for retrieval [Wahl 2007, Sec. 3.1.1]. */
#pragma once

#include "experiment/objects.h"
#include "experiment/output.h"
#include "pcl_surflet/recognition/model_database.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Another shape of the object's class: its principal axes stretched by exp(u), each u
 * uniform in [-\p variety, \p variety], its middle twisted about the longest axis by an angle
 * uniform in [-4 \p variety, 4 \p variety] per diameter, and scaled by a factor in [1/2, 2], that
 * of another unit of length. \param variety >= 0 */
TriangleMesh variantOf(const ExperimentObject& object, double variety, std::uint64_t seed);

/** \brief Models and the class of each. */
struct Collection {
  ModelDatabase database;
  std::vector<std::string> classes; ///< label of the object that a model is a variant of
};

struct CollectionPlan {
  std::uint64_t members = 20; ///< of each class
  double variety = 0.2;       ///< as variantOf() takes it
  std::uint64_t seed = 1;
  unsigned threads = 0; ///< 0: all
};

/** \brief A class an object, each model trained from one even sample of its variant. */
Collection makeCollection(const std::vector<ExperimentObject>& objects, const CollectionPlan& plan,
                          const ProgressFunction& progress);

} // namespace apps
} // namespace pcl_surflet
