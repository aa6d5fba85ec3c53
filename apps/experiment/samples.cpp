#include "experiment/samples.h"

#include "experiment/trials.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/sensed_surface.h"

namespace pcl_surflet {
namespace apps {

std::uint64_t
trainingSeed(std::uint64_t seed, std::size_t object)
{
  return mix64(mix64(mix64(seed) ^ 0x747261696e696e67ULL) + object);
}

std::vector<SurfletSet>
unturnedSamples(const ExperimentObject& object, std::uint64_t seed)
{
  std::vector<SurfletSet> samples;
  for (unsigned i = 0; i < kTrainingRounds; ++i)
    samples.push_back(withEstimatedNormals(sampleIsoMesh(object.mesh, kMeshSurflets, seed + i),
                                           Condition().normal_radius * object.spacing, 1)
                          .surflets);
  return samples;
}

} // namespace apps
} // namespace pcl_surflet
