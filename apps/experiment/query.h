/** \file
 * Disturbed samples of objects [Wahl 2007, Sec. 3.6.4-3.6.8]: what recognisers are asked about. */
#pragma once

#include "experiment/recogniser.h"

#include <array>
#include <cstdint>

namespace pcl_surflet {
namespace apps {

/** \brief What is done to an object before it is to be recognised. */
struct Condition {
  double noise = 0;   ///< amplitude along the normal (of a view: along the line of sight), as a
                      ///< share of the diameter
  double visible = 1; ///< share of the surface left by a random plane
  double resolution =
      1; ///< training spacing / query spacing: half of it is a quarter of the points
  std::array<double, 3> stretch{1, 1, 1}; ///< factors along the principal axes
  double normal_radius = 3; ///< of estimated normals, in spacings of the undisturbed object: 2
                            ///< leave 1 % noise visible in the normals, 4 round small details
  bool view = false;        ///< only what a distant sensor in a random direction sees
};

/** \brief A disturbed object as recognisers get it. */
struct Query {
  SurfletSet sampled;   ///< with the mesh's normals, of noise and views with estimated ones
  SurfletSet estimated; ///< with estimated normals (pcl::NormalEstimation); empty unless asked for

  const SurfletSet&
  with(Normals normals) const
  {
    return normals == Normals::Sampled ? sampled : estimated;
  }
};

/** \brief A fresh even sample of the stretched object, turned at random, then disturbed.
 *
 * What a view hides is found by drawing the mesh, not by the depth buffer of surflets that models
 * are trained with: a model that fits that buffer only would be found out. The sensor of a view
 * stands on the z axis. */
Query makeQuery(const ExperimentObject& object, const Condition& condition, std::uint64_t seed,
                bool estimate);

/** \brief Seed of a query. A setting's queries do not depend on the settings that follow it. */
std::uint64_t querySeed(std::uint64_t seed, std::size_t setting, std::size_t object,
                        std::size_t test);

} // namespace apps
} // namespace pcl_surflet
