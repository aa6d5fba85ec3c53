/** \file
 * Scores detections with names, places and poses: each criterion by itself. */
#pragma once

#include "evaluation/pose_scoring.h"
#include "evaluation/scoring.h"

#include <limits>
#include <optional>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What a peer says about one object. */
struct FoundObject {
  std::size_t object = 0;           ///< in the order of training
  std::vector<std::uint32_t> cells; ///< of the scene, that it explains
  std::array<double, 3> centre{};
  std::optional<RigidMotion> motion; ///< none: the peer has no pose
  double score = 0;                  ///< the larger the surer
};

/** \brief What an object is judged by. */
struct JudgedObject {
  PoseError error;
  double diameter = 0;
  bool symmetric = false; ///< ADD-S in place of ADD
};

/** \brief A detection and which criteria it meets. */
struct JudgedDetection {
  double score = 0;
  bool name = false;   ///< most of its cells come from an object of its name, the first so
  bool centre = false; ///< within half r_mean of the centre of an object of its name
  bool pose = false;   ///< ADD or ADD-S below a tenth of the diameter
};

/** \brief Results of one peer over many scenes. */
struct PeerCounts {
  std::size_t present = 0, scenes = 0, failures = 0;
  std::vector<JudgedDetection> detections;
  std::vector<double> seconds; ///< of each scene
};

/** \brief Of what explains mostly the same cells only the surest remains, the surest first. */
std::vector<FoundObject> withoutRivals(std::vector<FoundObject> found);

/** \brief Compares a scene's detections with the truth. Items with fewer than \p least surflets
 * are neither present nor right. */
void judge(const CellScene& scene, const std::vector<FoundObject>& found,
           const std::vector<JudgedObject>& objects, std::size_t least, PeerCounts& counts);

/** \brief The least score to accept: it makes the share of objects named right times the share of
 * detections that are right largest. Minus infinity if all may be accepted. */
double bestThreshold(const PeerCounts& counts);

/** \brief How many detections of at least this score meet each criterion. */
struct AcceptedCounts {
  std::size_t detections = 0, names = 0, centres = 0, poses = 0;
};

AcceptedCounts accepted(const PeerCounts& counts, double threshold);

} // namespace apps
} // namespace pcl_surflet
