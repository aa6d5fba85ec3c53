// pcl_surflet_experiment: its names, its options, and a tiny run of the experiment on space.
#include "app_runner.h"

#include <algorithm>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

class Experiment : public Apps {};

} // namespace

TEST_F(Experiment, HelpNamesEveryExperimentAndOption)
{
  const AppRun r = run("experiment", {"-h"});
  EXPECT_TRUE(ended(r, 0, {}));
  for (const std::string word : {"classification", "space", "-meshes", "-out", "-tests",
                                 "-saturations", "-radii", "-queries", "-seed", "-threads"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

TEST_F(Experiment, WrongUsageIsNamed)
{
  const std::string out = path("results");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "NAME"},
      {{"alchemy", "-out", out}, "classification, space"},
      {{"space", "classification", "-out", out}, "'classification'"},
      {{"space"}, "-out"},
      {{"classification", "-out", out}, "-meshes"},
      {{"classification", "-meshes", out}, "-out"},
      {{"space", "-out", out, "-threads", "2"}, "-threads"},
      {{"space", "-out", out, "-meshes", out}, "-meshes"},
      {{"classification", "-out", out, "-meshes", out, "-radii", "2"}, "-radii"}};
  for (const auto& [arguments, named] : wrong)
    EXPECT_TRUE(ended(run("experiment", arguments), 1, {named, "-h"})) << named;
  for (const std::string option : {"-saturations", "-radii", "-queries"})
    for (const std::string bad : {"0", "x", "-1", "1.5", "99999999999"})
      EXPECT_TRUE(ended(run("experiment", {"space", "-out", out, option, bad}), 1, {option}))
          << option << " " << bad;
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(Experiment, MissingMeshesAndPlacesItCannotWriteTo)
{
  EXPECT_TRUE(ended(
      run("experiment", {"classification", "-meshes", path("no_meshes"), "-out", path("results")}),
      2, {path("no_meshes")}));
  writeFile(path("file"), "kept");
  EXPECT_TRUE(ended(run("experiment", {"space", "-out", path("file/below")}), 2,
                    {path("file/below"), "-out"}));
  EXPECT_EQ(readFile(path("file")), "kept");
}

TEST_F(Experiment, SpaceWritesItsTable)
{
  const std::string out = path("results of space");
  const AppRun r = run("experiment", {"space", "-out", out, "-saturations", "1", "-radii", "2",
                                      "-queries", "3", "-seed", "5"});
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_NE(r.out.find("linear/octree"), std::string::npos);
  const auto rows = parseCsv(readFile(out + "/experiment_46.csv"));
  ASSERT_EQ(rows.size(), 3u);
  std::vector<std::string> columns = {"saturation", "radius", "hits"};
  for (const std::string method : {"list", "octree", "avl", "linear"})
    for (const std::string what : {"_us", "_relative_percent", "_bytes_per_point"})
      columns.push_back(method + what);
  EXPECT_EQ(rows[0], columns);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), columns.size());
    EXPECT_EQ(rows[i][0], "0.001");
    EXPECT_EQ(rows[i][1], i == 1 ? "0.01" : "0.5");
    const double fastest =
        std::min({std::stod(rows[i][4]), std::stod(rows[i][7]), std::stod(rows[i][10])});
    EXPECT_EQ(fastest, 0) << "relative to the fastest of list, octree and AVL tree";
    for (const std::size_t time : {3u, 6u, 9u, 12u})
      EXPECT_GT(std::stod(rows[i][time]), 0);
  }
  EXPECT_GE(std::stod(rows[1][2]), 1) << "a query is a point of the cloud";
  EXPECT_GT(std::stod(rows[2][2]), 1000);
  EXPECT_NE(readFile(out + "/experiment_46.gnuplot").find("experiment_46.csv"), std::string::npos);
  // The picture needs gnuplot, the numbers do not.
  EXPECT_NE(fs::exists(out + "/experiment_46.svg"), r.err.find("no picture") != std::string::npos);
}
