// The peers with poses find a known motion; their scores are right where the truth is by hand.
#include "evaluation/peer_scoring.h"
#include "evaluation/pose_peers.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr double kLeaf = 0.0058;

SurfletSet
cup(std::uint64_t seed)
{
  return sampleShape(*shapeByName("cup"), 20000, seed);
}

RigidMotion
someMotion()
{
  const double length = std::sqrt(14.0);
  RigidMotion m = turnAbout({1 / length, 2 / length, 3 / length}, {0, 0, 0}, 1.1);
  m.translation = {0.3, -0.2, 0.1};
  return m;
}

double
errorOf(const std::string& name)
{
  const SurfletSet surface = cup(1);
  const SurfletSet model = reduceToTwoSidedCells(surface, kLeaf).cells;
  const SurfletSet scene = reduceToTwoSidedCells(moved(cup(2), someMotion()), kLeaf).cells;
  double best = 0;
  RigidMotion found;
  for (const auto& m : poseFinder(name, model, PosePeerParameters{})->find(scene)) {
    const double share = supportOf(model, m, scene, kLeaf).share;
    if (share > best) {
      best = share;
      found = m;
    }
  }
  return PoseError(surface).nearest(found, someMotion()) / farthestDistance(surface);
}

bool
known(const std::string& name)
{
  const auto& names = poseFinderNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

FoundObject
foundObject(std::size_t object, std::vector<std::uint32_t> cells, double score)
{
  FoundObject f;
  f.object = object;
  f.cells = std::move(cells);
  f.score = score;
  return f;
}

} // namespace

TEST(PosePeers, ShotFindsAKnownMotion) { EXPECT_LT(errorOf("shot"), 0.05); }

TEST(PosePeers, PpfRegistrationFindsAKnownMotion) { EXPECT_LT(errorOf("ppf_registration"), 0.05); }

TEST(PosePeers, RepairedOpenCvFindsAKnownMotion)
{
  if (!known("opencv_repaired"))
    GTEST_SKIP() << "built without OpenCV's surface_matching";
  EXPECT_LT(errorOf("opencv_repaired"), 0.05);
}

TEST(PosePeers, UnknownNameIsRefused)
{
  EXPECT_THROW(poseFinder("none", cup(1), PosePeerParameters{}), std::invalid_argument);
}

TEST(PosePeers, SupportIsWholeInPlaceAndNothingElsewhere)
{
  const SurfletSet model = reduceToCells(cup(1), kLeaf).cells;
  const SurfletSet scene = moved(model, someMotion());
  const Support right = supportOf(model, someMotion(), scene, kLeaf);
  EXPECT_EQ(right.share, 1);
  EXPECT_EQ(right.cells.size(), scene.size());
  RigidMotion far = someMotion();
  far.translation[0] += 10;
  EXPECT_EQ(supportOf(model, far, scene, kLeaf).share, 0);
  far.rotation[0][0] = std::nan("");
  EXPECT_TRUE(supportOf(model, far, scene, kLeaf).cells.empty());
}

TEST(PeerScoring, TheSurerOfTwoRivalsRemains)
{
  const auto left = withoutRivals(
      {foundObject(0, {1, 2, 3}, 0.2), foundObject(1, {2, 3, 4}, 0.5), foundObject(2, {7}, 0.1)});
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].object, 1u);
  EXPECT_EQ(left[1].object, 2u);
}

TEST(PeerScoring, CriteriaAreCountedApart)
{
  const SurfletSet surface = cup(1);
  std::vector<JudgedObject> objects;
  objects.push_back({PoseError(surface), farthestDistance(surface), false});
  CellScene scene;
  scene.instance = {0, 0, 1, 1};
  scene.items.resize(1);
  auto& item = scene.items[0];
  item.number = 1;
  item.pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  item.r_mean = 0.1;
  item.surflets = 100;
  FoundObject named = foundObject(0, {2, 3}, 0.9);
  named.centre = {0.06, 0, 0}; // beyond half r_mean
  FoundObject placed = foundObject(0, {0, 1}, 0.4);
  placed.motion = RigidMotion{};
  PeerCounts counts;
  judge(scene, {named, placed, named}, objects, 50, counts);
  EXPECT_EQ(counts.present, 1u);
  const AcceptedCounts all = accepted(counts, 0);
  EXPECT_EQ(all.detections, 3u);
  EXPECT_EQ(all.names, 1u); // the second is a double
  EXPECT_EQ(all.centres, 1u);
  EXPECT_EQ(all.poses, 1u);
}

TEST(PeerScoring, ThresholdKeepsTheRightAndDropsTheWrong)
{
  PeerCounts counts;
  counts.detections = {{0.9, true, false, false},
                       {0.6, true, false, false},
                       {0.5, false, false, false},
                       {0.1, false, false, false}};
  EXPECT_EQ(bestThreshold(counts), 0.6);
}
