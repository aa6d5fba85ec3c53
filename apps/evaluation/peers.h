/** \file
 * Methods that name objects and tell where they are, behind one interface. */
#pragma once

#include "evaluation/peer_scoring.h"
#include "evaluation/recognisers.h"

#include "pcl_surflet/recognition/pose.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief An object, as all peers know it. */
struct Known {
  SceneItem item;
  SurfletSet cells; ///< of the complete surface, in the item's coordinates
  std::array<double, 3> centre{};
  PoseModel pose;
};

/** \brief A scene as all peers get it. */
struct Given {
  CellScene all;                      ///< as sensed, thin walls kept
  std::vector<std::uint32_t> visible; ///< cells away from those of the empty scene
  std::uint64_t seed = 0;
};

/** \brief What a peer finds in a scene. */
struct Answer {
  std::vector<FoundObject> found;
  double seconds = 0;       ///< of CPU time
  std::size_t failures = 0; ///< searches that crashed or took too long
};

/** \brief One of the methods that are compared. */
class Peer {
public:
  virtual ~Peer() = default;
  virtual Answer answer(const Given& given) const = 0;
};

/** \brief Surflets of a surface by which all methods are trained and judged. */
constexpr std::size_t kModelSurflets = 40000;

/** \brief The items, as the peers know them. \param leaf edge of the cells */
std::vector<Known> knownObjects(const std::vector<SceneItem>& items, double leaf);

/** \brief Names that peer() understands. */
std::vector<std::string> peerNames();

/** \brief Whether a peer searches for each model by its pose, and accepts what has enough support.
 */
bool isPoseFinder(const std::string& name);

/** \brief A peer by name. \p known must live as long as it does.
 * \param limit CPU seconds after which the search for one model is ended */
std::unique_ptr<Peer> peer(const std::string& name, const std::vector<SceneItem>& items,
                           const std::vector<Known>& known, const RecogniserOptions& options,
                           unsigned limit);

} // namespace apps
} // namespace pcl_surflet
