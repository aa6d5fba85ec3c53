// Poses scored by pcl_surflet_evaluate_pose.
#include "app_runner.h"

#include <sstream>

using namespace pcl_surflet::test;

namespace {

/** \brief The numbers of the row of \p object: present, segmented, posed, right. */
std::vector<int>
countsOf(const std::string& table, const std::string& object)
{
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    std::vector<int> counts(4);
    if (words >> name && name == object &&
        words >> counts[0] >> counts[1] >> counts[2] >> counts[3])
      return counts;
  }
  return {};
}

AppRun
evaluatedPoses(std::vector<std::string> arguments)
{
  for (const char* common : {"-scenes", "1", "-density", "60000", "-size", "0.8", "cup", "bottle"})
    arguments.emplace_back(common);
  return run("evaluate_pose", arguments);
}

} // namespace

TEST(EvaluatePose, CompleteSurfacesArePosedRight)
{
  const AppRun r = evaluatedPoses({"-seed", "5"});
  ASSERT_TRUE(ended(r, 0, {"bottle", "continuous"}));
  EXPECT_EQ(countsOf(r.out, "all"), (std::vector<int>{2, 2, 2, 2})) << r.out;
}

TEST(EvaluatePose, NothingIsRightWithinNoLimit)
{
  const AppRun r = evaluatedPoses({"-seed", "5", "-limit", "0"});
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_EQ(countsOf(r.out, "all"), (std::vector<int>{2, 2, 2, 0})) << r.out;
}

TEST(EvaluatePose, ForeignPointsLowerTheInliers)
{
  const AppRun clean = evaluatedPoses({"-seed", "5", "-verbose"});
  const AppRun mixed = evaluatedPoses({"-seed", "5", "-verbose", "-foreign", "0.2"});
  ASSERT_TRUE(ended(mixed, 0, {}));
  EXPECT_NE(clean.err, mixed.err);
  EXPECT_EQ(countsOf(mixed.out, "all"), (std::vector<int>{2, 2, 2, 2})) << mixed.out;
}

TEST(EvaluatePose, ASensorSeesOneSide)
{
  const AppRun r = evaluatedPoses({"-seed", "5", "-views", "one", "-pixels", "320x240",
                                   "-normal_radius", "0.012", "-sensor_noise", "0.0005"});
  ASSERT_TRUE(ended(r, 0, {}));
  const auto counts = countsOf(r.out, "bottle");
  ASSERT_EQ(counts.size(), 4U) << r.out;
  EXPECT_EQ(counts[3], 1) << r.out;
}
