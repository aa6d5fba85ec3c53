// Scans one by one: pcl_surflet_replay and pcl_surflet_evaluate_online.
#include "app_runner.h"

#include <sstream>

using namespace pcl_surflet::test;

namespace {

class Replay : public Apps {
protected:
  void
  SetUp() override
  {
    ASSERT_NO_FATAL_FAILURE(makeSceneDatabase({"torus"}, "20000"));
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-scans", path("scans"), "-empty",
                               path("e.pcd"), "-views", "pass", "-stops", "4", "-path", "0.4",
                               "-pixels", "160x120", "-distance", "0.7", "-size", "0.5", "torus"})
                  .code,
              0);
  }
  std::string
  scan(int k) const
  {
    return path("scans/scan_0" + std::to_string(k) + ".pcd");
  }
};

} // namespace

TEST_F(Replay, ARowEveryScanAndTheCellsAfterTheLast)
{
  const AppRun r =
      run("replay", {"-database", path("db.pcd"), "-leaf", "0.008", "-empty", path("e.pcd"), "-csv",
                     "-out", path("cells.pcd"), scan(0), scan(1), scan(2), scan(3), scan(3)});
  ASSERT_TRUE(ended(r, 0, {}));
  const auto table = parseCsv(r.out);
  ASSERT_EQ(table.size(), 6u);
  ASSERT_EQ(table[0].size(), 12u);
  EXPECT_EQ(table[0][4], "vanished");
  for (std::size_t row = 1; row < 6; ++row) {
    ASSERT_EQ(table[row].size(), 12u);
    EXPECT_GT(std::stoi(table[row][1]), 0) << "points";
    if (row > 1) {
      EXPECT_GE(std::stoi(table[row][2]), std::stoi(table[row - 1][2])) << "cells";
    }
  }
  EXPECT_LT(20 * std::stoi(table[5][3]), std::stoi(table[4][2])) << "the same scan changes little";
  EXPECT_EQ(table[5][4], "0");
  const std::string cells = readFile(path("cells.pcd"));
  EXPECT_NE(cells.find("label instance"), std::string::npos);
}

TEST_F(Replay, SaysThatTheModelsAreForOtherCells)
{
  ASSERT_EQ(run("train", {"-database", path("cells.pcd"), "-bins", "7,7,7,7", "-leaf", "0.008",
                          path("torus.pcd")})
                .code,
            0);
  EXPECT_TRUE(ended(run("replay", {"-database", path("cells.pcd"), "-leaf", "1e9", scan(0)}), 0,
                    {"cells of 0.008", "not of 1e+09", "-leaf"}));
}

TEST_F(Replay, GoesOnAfterABadScan)
{
  writeFile(path("bad.pcd"), "nonsense");
  const AppRun r = run("replay", {"-database", path("db.pcd"), "-leaf", "0.008", scan(0),
                                  path("bad.pcd"), path("torus.pcd"), scan(1)});
  EXPECT_TRUE(ended(r, 2, {"bad.pcd"}));
  EXPECT_NE(r.out.find("scan_01.pcd"), std::string::npos);
}

TEST(EvaluateOnline, EndsAsTheBatchAndForgetsWhatIsTakenAway)
{
  const AppRun r =
      run("evaluate_online",
          {"-scenes",  "1",  "-seed",     "3",   "-lengths", "0.6",   "-per_length", "3.4",
           "-take",    "1",  "-stride",   "0.2", "-leaf",    "0.008", "-pixels",     "200x150",
           "-opening", "40", "-distance", "1",   "cup",      "bottle"});
  ASSERT_TRUE(ended(r, 0, {}));
  std::istringstream lines(r.out);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    double length = 0;
    std::string name;
    std::size_t items = 0, present = 0, clusters = 0;
    if (!(words >> length >> items >> name) || (name != "online" && name != "batch"))
      continue;
    ++rows;
    EXPECT_TRUE(words >> present >> clusters);
    EXPECT_EQ(present, 2u) << line;
    EXPECT_EQ(clusters, 2u) << line;
    EXPECT_NE(line.find("100.0"), std::string::npos) << line;
  }
  EXPECT_EQ(rows, 2u) << r.out;
  EXPECT_NE(r.out.find("of 1 found and taken away 100.0"), std::string::npos) << r.out;
}
