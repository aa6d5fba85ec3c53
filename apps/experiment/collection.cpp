#include "experiment/collection.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

using Vector = std::array<double, 3>;

double
dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector
cross(const Vector& a, const Vector& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector
middleOf(const TriangleMesh& mesh)
{
  Vector sum{};
  for (const auto& v : mesh.vertices)
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += static_cast<double>(v[i]) / static_cast<double>(mesh.vertices.size());
  return sum;
}

/** \brief Turns every vertex about the unit vector \p axis through the mesh's middle by \p angle
 * (radians) per length along it. */
TriangleMesh
twisted(TriangleMesh mesh, const Vector& axis, double angle)
{
  const Vector middle = middleOf(mesh);
  for (auto& v : mesh.vertices) {
    const Vector r = {v[0] - middle[0], v[1] - middle[1], v[2] - middle[2]};
    const double along = dot(r, axis), c = std::cos(angle * along), s = std::sin(angle * along);
    const Vector side = cross(axis, r);
    for (std::size_t i = 0; i < 3; ++i) // Rodrigues' formula
      v[i] = static_cast<float>(middle[i] + c * r[i] + s * side[i] + (1 - c) * along * axis[i]);
  }
  return mesh;
}

/** \brief Longest edge of a mesh that is to be bent, in spacings of a sample: faces of two
 * triangles could not bend. */
constexpr double kLongestEdge = 2;

} // namespace

TriangleMesh
variantOf(const ExperimentObject& object, double variety, std::uint64_t seed)
{
  CounterRandom random(seed, 1);
  std::array<double, 3> factors{};
  for (double& f : factors)
    f = std::exp(random.uniform(-variety, variety));
  const double angle = random.uniform(-4 * variety, 4 * variety);
  const double diameter = std::exp2(random.uniform(-1, 1));
  const TriangleMesh fine = refineEdges(object.mesh, kLongestEdge * object.spacing);
  return scaledToDiameter(twisted(stretched(fine, object.axes, factors), object.axes[0], angle),
                          diameter);
}

Collection
makeCollection(const std::vector<ExperimentObject>& objects, const CollectionPlan& plan,
               const ProgressFunction& progress)
{
  HistogramModelTrainer trainer;
  trainer.setSeed(plan.seed);
  trainer.setNumberOfThreads(1);
  trainer.setMeshSampling(kMeshSurflets, 1);
  Collection collection;
  for (std::size_t o = 0; o < objects.size(); ++o) {
    progress(o, "class " + objects[o].label);
    std::vector<HistogramModel> models(plan.members);
    parallelFor(models.size(), plan.threads, [&](std::size_t i, unsigned) {
      const auto seed = mix64(mix64(mix64(plan.seed) + o) + i);
      models[i] = trainer.train(objects[o].label + " " + std::to_string(i + 1),
                                variantOf(objects[o], plan.variety, seed));
    });
    for (auto& model : models) {
      collection.database.add(std::move(model));
      collection.classes.push_back(objects[o].label);
    }
  }
  return collection;
}

} // namespace apps
} // namespace pcl_surflet
