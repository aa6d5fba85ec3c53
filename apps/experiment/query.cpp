#include "experiment/query.h"

#include "experiment/depth_picture.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/sensed_surface.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief What a sensor on the z axis sees of \p sample, a sample of \p mesh before it was turned
 * with \p turn_seed. Normals point to the sensor: it knows no others, and its noise lies there. */
SurfletSet
seenFromAbove(const SurfletSet& sample, const TriangleMesh& mesh, std::uint64_t turn_seed)
{
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  const DepthPicture picture(randomlyRotated(vertices, turn_seed), mesh.triangles);
  SurfletSet seen;
  for (std::size_t i = 0; i < sample.size(); ++i)
    if (const Surflet s = sample[i]; picture.shows(s))
      seen.push_back({s.x, s.y, s.z, 0, 0, 1});
  return seen;
}

} // namespace

Query
makeQuery(const ExperimentObject& object, const Condition& condition, std::uint64_t seed,
          bool estimate)
{
  const bool whole = condition.stretch == std::array<double, 3>{1, 1, 1};
  const TriangleMesh other =
      whole ? TriangleMesh() : stretched(object.mesh, object.axes, condition.stretch);
  const TriangleMesh& mesh = whole ? object.mesh : other;
  const auto target = static_cast<std::size_t>(std::lround(
      static_cast<double>(kMeshSurflets) * condition.resolution * condition.resolution));
  const bool sensed = condition.noise > 0 || condition.view;
  Query query;
  query.sampled = randomlyRotated(sampleIsoMesh(mesh, target, seed), mix64(seed));
  if (condition.view)
    query.sampled = seenFromAbove(query.sampled, mesh, mix64(seed));
  if (condition.noise > 0)
    query.sampled = displacedAlongNormals(query.sampled, condition.noise, mix64(seed + 1));
  if (condition.visible < 1)
    query.sampled = cutByRandomPlane(query.sampled, condition.visible, mix64(seed + 2));
  if (!estimate && !sensed)
    return query;
  query.estimated =
      withEstimatedNormals(query.sampled, condition.normal_radius * object.spacing, 1).surflets;
  if (sensed)
    query.sampled = query.estimated;
  return query;
}

std::uint64_t
querySeed(std::uint64_t seed, std::size_t setting, std::size_t object, std::size_t test)
{
  // Seeds of their own: no query is a sampling that a model was trained with.
  return mix64(mix64(mix64(seed) + setting) + object) + test;
}

} // namespace apps
} // namespace pcl_surflet
