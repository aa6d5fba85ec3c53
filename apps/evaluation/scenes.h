/** \file
 * Scenes as the methods get them: complete surfaces, or what a virtual sensor sees. */
#pragma once

#include "pcl_surflet/sensed_scene.h"

#include <optional>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Never the seed of a scene. */
constexpr std::uint64_t kTrainingSeed = 0x747261696eULL;

/** \brief How scenes are seen; without value, complete surfaces. */
using Sensing = std::optional<SceneSensing>;

/** \brief generateScene(), seen. */
Scene seenScene(const std::vector<SceneItem>& objects, const std::vector<SceneItem>& clutter,
                const SceneOptions& options, const Sensing& sensing);

/** \brief The empty background, seen another time than any scene. */
SurfletSet seenBackground(SceneOptions options, const Sensing& sensing);

/** \brief How an object alone is seen, as models are trained from it: a sensor looks from 24
 * places, not from below if objects stand upright [Wahl 2007, Sec. 5.5.3]. \p posture is that of
 * the scenes. */
SceneSensing aroundAlone(const SceneSensing& sensing, Posture posture);

/** \brief How many of \p items are present in scene \p seed, where each is so with this
 * probability. */
std::size_t presentOf(std::size_t items, double probability, std::uint64_t seed);

} // namespace apps
} // namespace pcl_surflet
