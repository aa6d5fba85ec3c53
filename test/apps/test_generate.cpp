// Scenes made by pcl_surflet_generate.
#include "app_runner.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

using namespace pcl_surflet::test;

namespace {

class Generate : public Apps {};

std::string
headerLine(const std::string& pcd, const std::string& key)
{
  const auto at = pcd.find("\n" + key + " ");
  return at == std::string::npos ? "" : pcd.substr(at + 1, pcd.find('\n', at + 1) - at - 1);
}

} // namespace

TEST_F(Generate, WritesSceneTruthAndEmptyBackground)
{
  const AppRun r = run("generate", {"-out", path("s.pcd"), "-poses", path("p.csv"), "-empty",
                                    path("e.pcd"), "-density", "10000", "-clutter", "cone,cube",
                                    "-unknown", "1", "cup", "bottle"});
  ASSERT_TRUE(ended(r, 0, {"s.pcd", "3 items"}));
  const std::string scene = readFile(path("s.pcd"));
  EXPECT_EQ(headerLine(scene, "FIELDS"), "FIELDS x y z normal_x normal_y normal_z label instance");
  const auto poses = parseCsv(readFile(path("p.csv")));
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_EQ(poses[0].size(), 24u);
  EXPECT_EQ(poses[1][0] + poses[1][1] + poses[1][3], "cup11");
  EXPECT_EQ(poses[2][0] + poses[2][1] + poses[2][3], "bottle21");
  EXPECT_EQ(poses[3][3], "0") << "clutter is unknown";
  std::size_t points = 10000; // the table
  for (std::size_t row = 1; row < poses.size(); ++row)
    points += std::stoul(poses[row].back());
  EXPECT_EQ(headerLine(scene, "POINTS"), "POINTS " + std::to_string(points));
  EXPECT_EQ(headerLine(readFile(path("e.pcd")), "POINTS"), "POINTS 10000");
  EXPECT_EQ(headerLine(readFile(path("e.pcd")), "FIELDS"),
            "FIELDS x y z normal_x normal_y normal_z");
}

TEST_F(Generate, ScenesCanBeReadAgain)
{
  ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-density", "10000", "cup"}).code, 0);
  ASSERT_EQ(run("train", {"-database", path("db.pcd"), "-pairs", "1000", path("s.pcd")}).code, 0);
}

TEST_F(Generate, MeshesAreScaledAndTurnedUp)
{
  ASSERT_EQ(run("generate_shape", {"cone", path("cone.off")}).code, 0);
  for (const std::string up : {"x", "y", "z"}) {
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-poses", path("p.csv"), "-density", "20000",
                               "-background", "none", "-size", "5", path("cone.off") + ":2:" + up})
                  .code,
              0);
    const auto poses = parseCsv(readFile(path("p.csv")));
    // An upright cone carries most of its surface low; on its side, in the middle.
    const double height = std::stod(poses[1][22]);
    EXPECT_GT(height, 0.1);
    EXPECT_EQ(height < 0.62, up == "z") << up << " " << height;
  }
}

TEST_F(Generate, ItemsBecomeMeshesToTrainFrom)
{
  ASSERT_EQ(run("generate_shape", {"cone", path("thing.off")}).code, 0);
  ASSERT_EQ(
      run("generate", {"-out", path("s.pcd"), "-models", path("m"), "-density", "5000",
                       "-background", "none", "-size", "9", "cup", path("thing.off") + ":2:x"})
          .code,
      0);
  ASSERT_TRUE(
      ended(run("train", {"-database", path("db.pcd"), path("m/cup.off"), path("m/thing.off")}), 0,
            {"added 'cup'", "added 'thing'"}));
  const auto table = parseCsv(run("info", {"-csv", path("db.pcd")}).out);
  ASSERT_EQ(table.size(), 3u);
  const auto column = std::find(table[0].begin(), table[0].end(), "delta_max") - table[0].begin();
  ASSERT_LT(std::size_t(column), table[0].size());
  EXPECT_NEAR(std::stod(table[2][std::size_t(column)]), 2, 0.02) << "in the scene's unit";
  EXPECT_TRUE(ended(
      run("generate", {"-out", path("s.pcd"), "-models", path("s.pcd"), "-density", "5000", "cup"}),
      2, {"s.pcd"}));
}

TEST_F(Generate, SeedsDecide)
{
  const auto made = [&](const std::string& seed) {
    EXPECT_EQ(run("generate", {"-out", path("s.pcd"), "-density", "5000", "-seed", seed, "-posture",
                               "mixed", "-noise", "0.001", "cup", "torus"})
                  .code,
              0);
    return readFile(path("s.pcd"));
  };
  const std::string first = made("4");
  EXPECT_TRUE(first == made("4"));
  EXPECT_FALSE(first == made("5"));
}

TEST_F(Generate, ASensorSeesOneSide)
{
  const std::vector<std::string> common = {"-density",       "5000", "-pixels",       "160x120",
                                           "-normal_radius", "0.03", "-sensor_noise", "0.0005"};
  const auto made = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), common.begin(), common.end());
    return run("generate", arguments);
  };
  ASSERT_TRUE(
      ended(made({"-views", "two", "-out", path("s.pcd"), "-poses", path("p.csv"), "-scans",
                  path("scans"), "-alone", path("alone"), "-empty", path("e.pcd"), "cup", "torus"}),
            0, {"s.pcd", "2 items"}));
  const std::string scan = readFile(path("scans/scan_01.pcd"));
  EXPECT_EQ(headerLine(scan, "FIELDS"), "FIELDS x y z normal_x normal_y normal_z label instance");
  EXPECT_EQ(headerLine(scan, "WIDTH"), "WIDTH 160");
  EXPECT_EQ(headerLine(scan, "HEIGHT"), "HEIGHT 120");
  // From the other side, 1.4 from a point 0.05 above the table, 45 degrees high.
  const auto viewpoint = headerLine(scan, "VIEWPOINT");
  std::istringstream numbers(viewpoint.substr(10));
  std::vector<double> v(7);
  for (double& number : v)
    numbers >> number;
  EXPECT_NEAR(v[0], -1.4 * std::sqrt(0.5), 1e-5) << viewpoint;
  EXPECT_NEAR(v[1], 0, 1e-5);
  EXPECT_NEAR(v[2], 0.05 + 1.4 * std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(std::hypot(v[3], v[4], std::hypot(v[5], v[6])), 1, 1e-5);
  EXPECT_FALSE(std::filesystem::exists(path("scans/scan_02.pcd")));
  const auto poses = parseCsv(readFile(path("p.csv")));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_GT(std::stoul(poses[1].back()), 50u) << "points that are seen of the cup";
  EXPECT_NE(headerLine(readFile(path("e.pcd")), "POINTS"), "");
  // All of it can be trained from, or read again.
  ASSERT_TRUE(ended(run("train", {"-database", path("db.pcd"), "-pairs", "1000",
                                  path("alone/cup.pcd"), path("alone/torus.pcd"), path("s.pcd")}),
                    0, {"added 'cup'"}));
}

TEST_F(Generate, SensorsAreDescribedConsistently)
{
  const std::string out = path("s.pcd");
  const auto refused = [&](std::vector<std::string> arguments,
                           const std::vector<std::string>& words) {
    arguments.insert(arguments.end(), {"-out", out, "-density", "5000", "cup"});
    EXPECT_TRUE(ended(run("generate", arguments), 1, words));
  };
  refused({"-scans", path("d")}, {"-scans", "-views"});
  refused({"-alone", path("d")}, {"-alone", "-views"});
  refused({"-views", "one", "-noise", "0.001"}, {"-noise", "-sensor_noise"});
  refused({"-views", "three"}, {"three", "ring24"});
  for (const char* bad : {"640", "0x3", "axb", "640x480x3", "-1x5"})
    refused({"-views", "one", "-pixels", bad}, {"-pixels"});
  refused({"-views", "one", "-grazing", "91"}, {"-grazing"});
}

TEST_F(Generate, BadDataIsNamed)
{
  makeShapes();
  const std::string out = path("s.pcd");
  EXPECT_TRUE(ended(run("generate", {"-out", out, path("none.off")}), 2, {"none.off"}));
  EXPECT_TRUE(ended(run("generate", {"-out", out, path("ball.pcd")}), 2, {"ball.pcd", "faces"}));
  EXPECT_TRUE(ended(run("generate", {"-out", out, "-size", "0.1", "cup"}), 2, {"do not fit"}));
  EXPECT_TRUE(ended(run("generate", {"-out", out, "-density", "1e12", "cup"}), 2, {"density"}));
  EXPECT_TRUE(ended(run("generate", {"-out", path("no/s.pcd"), "-density", "100", "cup"}), 2,
                    {"no/s.pcd"}));
}
