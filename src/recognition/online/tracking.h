/** \file
 * Which detections a scan concerns, and which go on; internal, not installed. */
#pragma once

#include "attention.h"

#include "pcl_surflet/recognition/model_database.h"

namespace pcl_surflet {
namespace online {

/** \brief What is known about a detection beside what users see. */
struct Note {
  Patch patch;
  double coverage = 0;
  bool is_in_doubt = false; ///< an attractor
  std::size_t changes = 0;  ///< in its ball since it was interpreted
};

/** \brief A place where a cell changed. */
struct ChangedPlace {
  Place at{};
  std::uint64_t owner = 0; ///< id of the detection whose cell it was, or 0
};

/** \brief What the places that changed mean for what was found. */
struct Concern {
  std::vector<std::size_t> kept, reopened; ///< detections, by their place in the list
  std::vector<std::size_t> changes;        ///< of every detection, in its ball
  std::vector<Place> open;                 ///< places to be interpreted
};

double distanceOf(const Place& a, const Place& b);

/** \brief The ball in which a detection's model finds its cells. */
double ballOf(const ModelDatabase& database, std::size_t model, double reach);

/** \brief Detections in whose ball, or among whose cells, something changed are reopened: not
 * before the changes are \p stale times its cells, if one is not in doubt. Places in the balls of
 * those that are kept are left alone, all others are open. \param notes one for each detection that
 * is still there; these come first */
Concern concernOf(const std::vector<OnlineDetection>& detections, const std::vector<Note>& notes,
                  const std::vector<ChangedPlace>& changed, const ModelDatabase& database,
                  double reach, double stale);

/** \brief Do two detections mean the same thing? One model, and half of the cells or nearly one
 * centre in common. */
bool isSame(const Detection& a, const Detection& b, const ModelDatabase& database);

/** \brief Gives \p found ids: those of the \p reopened ones that they continue, or new ones. A
 * detection goes on in the nearest found first. \return which of \p reopened go on */
std::vector<bool> adopt(std::vector<OnlineDetection>& found,
                        const std::vector<OnlineDetection>& before,
                        const std::vector<std::size_t>& reopened, const ModelDatabase& database,
                        std::uint64_t& next_id);

} // namespace online
} // namespace pcl_surflet
