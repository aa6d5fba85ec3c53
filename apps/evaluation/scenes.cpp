#include "evaluation/scenes.h"

#include "pcl_surflet/core/counter_random.h"

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::uint64_t kPresenceStream = 0x70726573ULL;

} // namespace

Scene
seenScene(const std::vector<SceneItem>& objects, const std::vector<SceneItem>& clutter,
          const SceneOptions& options, const Sensing& sensing)
{
  Scene scene = generateScene(objects, clutter, options);
  if (!sensing)
    return scene;
  return sensedScene(
      scene, senseViews(bodiesOf(scene, objects, clutter, options), *sensing, options.seed));
}

SurfletSet
seenBackground(SceneOptions options, const Sensing& sensing)
{
  options.seed = kTrainingSeed;
  if (!sensing)
    return emptyBackground(options);
  return sensedSurflets(senseViews(backgroundBodies(options), *sensing, options.seed));
}

SceneSensing
aroundAlone(const SceneSensing& sensing, Posture posture)
{
  SceneSensing round = sensing;
  round.views.views = posture == Posture::Upright ? ViewSet::Ring24 : ViewSet::All24;
  return round;
}

std::size_t
presentOf(std::size_t items, double probability, std::uint64_t seed)
{
  CounterRandom random(seed, kPresenceStream);
  std::size_t present = 0;
  for (std::size_t i = 0; i < items; ++i)
    present += random.uniform() < probability ? 1 : 0;
  return present;
}

} // namespace apps
} // namespace pcl_surflet
