// Objects found by pcl_surflet_interpret.
#include "app_runner.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

using namespace pcl_surflet::test;

namespace {

class Interpret : public Apps {
protected:
  void
  SetUp() override
  {
    ASSERT_NO_FATAL_FAILURE(makeSceneDatabase({"bottle", "torus"}, "20000"));
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-poses", path("p.csv"), "-empty",
                               path("e.pcd"), "-density", "100000", "bottle", "torus"})
                  .code,
              0);
  }
};

} // namespace

TEST_F(Interpret, FindsWhatWasPutThere)
{
  const AppRun r = run("interpret", {"-database", path("db.pcd"), "-background", "exclude",
                                     "-empty", path("e.pcd"), "-leaf", "0.008", "-csv", "-verbose",
                                     "-out", path("labelled.pcd"), path("s.pcd")});
  ASSERT_TRUE(ended(r, 0, {"promising", "bottle", "torus"}));
  const auto table = parseCsv(r.out);
  const auto truth = parseCsv(readFile(path("p.csv")));
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t row = 1; row < 3; ++row) {
    const auto& item = truth[table[row][1] == "bottle" ? 1 : 2];
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(table[row][3 + axis]), std::stod(item[20 + axis]), 0.02);
  }
  EXPECT_NE(table[1][1], table[2][1]);
  EXPECT_NE(
      readFile(path("labelled.pcd")).find("FIELDS x y z normal_x normal_y normal_z label instance"),
      std::string::npos);
}

TEST_F(Interpret, FindsTheTableItselfAndWritesTheObjects)
{
  const AppRun r =
      run("interpret", {"-database", path("db.pcd"), "-background", "exclude", "-planes", "1",
                        "-leaf", "0.008", "-csv", "-objects_dir", path("new/dir"), path("s.pcd")});
  ASSERT_TRUE(ended(r, 0, {}));
  const auto table = parseCsv(r.out);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].size(), 10u);
  for (std::size_t row = 1; row < 3; ++row) {
    EXPECT_GT(std::stod(table[row][8]), 0) << "confidence";
    EXPECT_EQ(table[row][9], "") << "coverage of models trained from points is unknown";
    const std::string object =
        readFile(path("new/dir/s_" + std::to_string(row) + "_" + table[row][1] + ".pcd"));
    EXPECT_NE(object.find("\nPOINTS " + table[row][2] + "\n"), std::string::npos);
  }
}

TEST_F(Interpret, EstimatesPoses)
{
  ASSERT_EQ(run("generate", {"-out", path("ignored.pcd"), "-models", path("meshes"), "-density",
                             "1000", "bottle", "torus"})
                .code,
            0);
  const AppRun r = run("interpret", {"-database", path("db.pcd"), "-background", "exclude",
                                     "-empty", path("e.pcd"), "-leaf", "0.008", "-csv", "-pose",
                                     path("meshes"), "-viewpoints", "0,0,2:1,0,1", path("s.pcd")});
  ASSERT_TRUE(ended(r, 0, {}));
  const auto table = parseCsv(r.out);
  const auto truth = parseCsv(readFile(path("p.csv")));
  ASSERT_EQ(table.size(), 3u);
  ASSERT_EQ(table[0].size(), 26u);
  EXPECT_EQ(table[0][10], "tx");
  for (std::size_t row = 1; row < 3; ++row) {
    ASSERT_EQ(table[row].size(), 26u);
    const auto& item = truth[table[row][1] == "bottle" ? 1 : 2];
    // Both stand upright: the origin is where the truth has it, the axis is the vertical.
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(table[row][10 + axis]), std::stod(item[7 + 4 * axis]), 0.005);
    EXPECT_EQ(table[row][21], "continuous") << table[row][1];
    EXPECT_NEAR(std::abs(std::stod(table[row][25])), 1, 0.01) << "axis z";
    EXPECT_GT(std::stod(table[row][18]), 0.7) << "inliers";
  }
  const AppRun text =
      run("interpret", {"-database", path("db.pcd"), "-background", "exclude", "-empty",
                        path("e.pcd"), "-leaf", "0.008", "-pose", path("meshes"), path("s.pcd")});
  EXPECT_TRUE(ended(text, 0, {}));
  EXPECT_NE(text.out.find("look alike"), std::string::npos) << text.out;
}

TEST_F(Interpret, RefusesPosesWithoutModels)
{
  EXPECT_TRUE(ended(
      run("interpret", {"-database", path("db.pcd"), "-pose", path("nowhere"), path("s.pcd")}), 2,
      {"nowhere"}));
  EXPECT_TRUE(
      ended(run("interpret", {"-database", path("db.pcd"), "-viewpoints", "0,0,1", path("s.pcd")}),
            1, {"-viewpoints", "-pose"}));
  EXPECT_TRUE(ended(run("interpret", {"-database", path("db.pcd"), "-pose", path(""), "-viewpoints",
                                      "0,0", path("s.pcd")}),
                    1, {"-viewpoints"}));
}

TEST_F(Interpret, RefusesTwoSurfacesOfOneName)
{
  std::filesystem::create_directory(path("meshes"));
  for (const std::string name : {"torus.off", "torus.ply"})
    ASSERT_EQ(run("generate_shape", {"torus", path("meshes/" + name), "-points", "500"}).code, 0);
  EXPECT_TRUE(
      ended(run("interpret", {"-database", path("db.pcd"), "-pose", path("meshes"), path("s.pcd")}),
            2, {"torus.off", "torus.ply", "leave one"}));
}

TEST_F(Interpret, SaysThatTheModelsAreForOtherCells)
{
  ASSERT_EQ(run("train", {"-database", path("cells.pcd"), "-bins", "7,7,7,7", "-leaf", "0.008",
                          path("bottle.pcd"), path("torus.pcd")})
                .code,
            0);
  const auto noted = [&](const std::vector<std::string>& leaf) {
    std::vector<std::string> arguments = {"-database", path("cells.pcd"), "-background", "exclude",
                                          "-empty",    path("e.pcd"),     path("s.pcd")};
    arguments.insert(arguments.begin(), leaf.begin(), leaf.end());
    return run("interpret", arguments);
  };
  EXPECT_TRUE(ended(noted({"-leaf", "0.012"}), 0, {"cells of 0.008", "not of 0.012", "-leaf"}));
  const AppRun given = noted({"-leaf", "0.008"}), by_default = noted({});
  EXPECT_EQ(given.err, "");
  EXPECT_EQ(by_default.out, given.out) << "what they were trained for";
}

TEST_F(Interpret, RefusesNamesThatCannotBeKept)
{
  std::filesystem::create_directory(path("other"));
  std::filesystem::copy(path("s.pcd"), path("other/s.pcd"));
  EXPECT_TRUE(ended(run("interpret", {"-database", path("db.pcd"), "-objects_dir", path("o"),
                                      path("s.pcd"), path("other/s.pcd")}),
                    1, {path("s.pcd"), path("other/s.pcd"), "-objects_dir"}));
  EXPECT_TRUE(ended(
      run("interpret", {"-database", path("db.pcd"), "-picture", path("p.jpg"), path("s.pcd")}), 1,
      {"p.jpg", ".png"}));
  EXPECT_FALSE(std::filesystem::exists(path("o")));
}

TEST_F(Interpret, PosesJudgeNames)
{
  // A goblet takes the place of the torus: nothing else has the name, so its pose must refute it.
  ASSERT_EQ(run("generate", {"-out", path("ignored.pcd"), "-models", path("meshes"), "-density",
                             "1000", "bottle", "wine_glass"})
                .code,
            0);
  std::filesystem::rename(path("meshes/wine_glass.off"), path("meshes/torus.off"));
  const std::vector<std::string> common = {
      "-database", path("db.pcd"), "-background", "exclude", "-empty",       path("e.pcd"),
      "-leaf",     "0.008",        "-csv",        "-pose",   path("meshes"), path("s.pcd")};
  EXPECT_EQ(parseCsv(run("interpret", common).out).size(), 3u);
  auto verified = common;
  verified.insert(verified.begin(), {"-verify", "-max", "5"});
  const AppRun r = run("interpret", verified);
  ASSERT_TRUE(ended(r, 0, {"refute"}));
  const auto table = parseCsv(r.out);
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[1][1], "bottle");
  EXPECT_TRUE(ended(run("interpret", {"-database", path("db.pcd"), "-verify", path("s.pcd")}), 1,
                    {"-verify", "-pose"}));
}

TEST_F(Interpret, SaysWhyNothingIsFound)
{
  const AppRun r = run("interpret", {"-database", path("db.pcd"), "-background", "exclude",
                                     "-empty", path("e.pcd"), "-leaf", "0.008", path("e.pcd")});
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_NE(r.out.find("nothing found: all points are background"), std::string::npos) << r.out;
  const AppRun strict =
      run("interpret", {"-database", path("db.pcd"), "-background", "exclude", "-empty",
                        path("e.pcd"), "-leaf", "0.008", "-min_confidence", "1", path("s.pcd")});
  ASSERT_TRUE(ended(strict, 0, {"left out 2", "-min_confidence"}));
  EXPECT_NE(strict.out.find("nothing found: nothing is sure enough"), std::string::npos)
      << strict.out;
}

// VTK and Mesa leak, and reserve what sanitisers count.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Interpret, DrawsAPictureWithoutADisplay)
{
  const std::string before = getenv("DISPLAY") != nullptr ? getenv("DISPLAY") : "";
  unsetenv("DISPLAY");
  const AppRun r =
      run("interpret", {"-database", path("db.pcd"), "-background", "exclude", "-planes", "1",
                        "-leaf", "0.008", "-picture", path("p.png"), path("s.pcd")});
  EXPECT_TRUE(ended(r, 0, {}));
  const std::string png = readFile(path("p.png"));
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_GT(png.size(), 10000u) << "there is something on it";
  const auto drawn = [&](const std::string& azimuth) {
    EXPECT_TRUE(ended(run("view", {"-width", "200", "-height", "150", "-azimuth", azimuth,
                                   "-picture", path("v.png"), path("e.pcd")}),
                      0, {}));
    return readFile(path("v.png"));
  };
  EXPECT_FALSE(drawn("10") == drawn("50")) << "another eye sees something else";
  if (!before.empty())
    setenv("DISPLAY", before.c_str(), 1);
}

TEST_F(Interpret, CapturesAreDrawnAsTheirCameraSawThem)
{
  const auto drawn = [&](const std::string& file, std::vector<std::string> how) {
    how.insert(how.end(),
               {"-width", "100", "-height", "80", "-picture", path("v.png"), path(file)});
    EXPECT_TRUE(ended(run("view", how), 0, {}));
    return readFile(path("v.png"));
  };
  ASSERT_EQ(run("generate", {"-out", path("all.pcd"), "-scans", path("scans"), "-views", "one",
                             "-pixels", "160x120", "bottle", "torus"})
                .code,
            0);
  const std::string capture = "scans/scan_00.pcd";
  const std::string as_seen = drawn(capture, {});
  EXPECT_TRUE(as_seen == drawn(capture, {"-up", "-y", "-azimuth", "-90", "-elevation", "10"}));
  EXPECT_FALSE(as_seen == drawn(capture, {"-azimuth", "-60"}));
  EXPECT_FALSE(as_seen == drawn(capture, {"-up", "z"}));
  EXPECT_TRUE(drawn("s.pcd", {}) ==
              drawn("s.pcd", {"-up", "z", "-azimuth", "-60", "-elevation", "35"}));
  // The same image with its last row first is no capture of such a camera.
  std::string upside_down = readFile(path(capture));
  const std::size_t begin = upside_down.find("DATA binary\n") + 12, row = 160 * 32;
  ASSERT_EQ(upside_down.size() - begin, 120 * row);
  for (std::size_t r = 0; r < 60; ++r)
    std::swap_ranges(&upside_down[begin + r * row], &upside_down[begin + r * row] + row,
                     &upside_down[begin + (119 - r) * row]);
  writeFile(path("turned.pcd"), upside_down);
  EXPECT_TRUE(drawn("turned.pcd", {}) == drawn("turned.pcd", {"-up", "z"}));
  EXPECT_TRUE(ended(run("view", {"-up", "up", "-picture", path("v.png"), path("s.pcd")}), 1,
                    {"-up", "-y", "'up'"}));
}
#endif

TEST_F(Interpret, NoDisplayIsAnErrorAndNoCrash)
{
  setenv("DISPLAY", ":4711", 1); // nobody there
  EXPECT_TRUE(ended(run("view", {path("s.pcd")}), 2, {"DISPLAY", "-picture"}));
  const std::string path_before = getenv("PATH");
  setenv("PATH", directory_.c_str(), 1); // no Xvfb
  EXPECT_TRUE(
      ended(run("view", {"-picture", path("p.png"), path("s.pcd")}), 2, {"apt-get", "xvfb"}));
  EXPECT_TRUE(ended(run("interpret", {"-database", path("db.pcd"), "-leaf", "0.02", "-picture",
                                      path("p.png"), path("s.pcd")}),
                    2, {"p.png", "see above"}));
  EXPECT_FALSE(std::filesystem::exists(path("p.png")));
  setenv("PATH", path_before.c_str(), 1);
  unsetenv("DISPLAY");
}

TEST_F(Interpret, ViewRefusesWhatIsNoScene)
{
  EXPECT_TRUE(ended(run("view", {path("none.pcd")}), 2, {"none.pcd"}));
  EXPECT_TRUE(ended(run("view", {path("db.pcd")}), 2, {"db.pcd", "x, y, z"}));
}

TEST_F(Interpret, GoesOnAfterABadFile)
{
  const AppRun r = run("interpret", {"-database", path("db.pcd"), path("none.pcd"), path("s.pcd")});
  EXPECT_TRUE(ended(r, 2, {"none.pcd"}));
  EXPECT_NE(r.out.find("s.pcd"), std::string::npos);
}

TEST_F(Interpret, SaysWhatIsMissing)
{
  EXPECT_TRUE(
      ended(run("interpret", {"-database", path("db.pcd"), "-background", "model", path("s.pcd")}),
            2, {"background model"}));
  EXPECT_TRUE(ended(run("interpret", {"-database", path("no.pcd"), path("s.pcd")}), 2, {"no.pcd"}));
}
