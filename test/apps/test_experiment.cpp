// pcl_surflet_experiment: its names, its options, and tiny runs.
#include "app_runner.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <map>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

class Experiment : public Apps {
protected:
  /** \brief Two meshes to recognise, and the arguments that name them. */
  std::vector<std::string>
  twoObjects(const std::vector<std::string>& arguments)
  {
    for (const std::string shape : {"sphere", "cup"})
      EXPECT_EQ(run("generate_shape", {shape, path(shape + ".off"), "-points", "500"}).code, 0);
    std::vector<std::string> all = arguments;
    for (const auto& more : {std::string("-meshes"), path("."), std::string("-out"),
                             path("results"), std::string("-objects"), std::string("sphere,cup")})
      all.push_back(more);
    return all;
  }

  std::vector<std::vector<std::string>>
  rows(const std::string& file)
  {
    return parseCsv(readFile(path("results/" + file)));
  }
};

const std::vector<std::string> kRateColumns = {"series", "x",      "condition",   "recogniser",
                                               "tests",  "right",  "rate",        "low",
                                               "high",   "failed", "ms_per_query"};

} // namespace

TEST_F(Experiment, HelpNamesEveryExperimentAndOption)
{
  const AppRun r = run("experiment", {"-h"});
  EXPECT_TRUE(ended(r, 0, {}));
  for (const std::string word :
       {"classification", "criteria",       "noise",      "visibility", "resolution",
        "elongation",     "distortion",     "peers",      "space",      "-meshes",
        "rejection",      "-strangers",     "-skip",      "-out",       "-tests",
        "-objects",       "-normal_radius", "-intervals", "retrieval",  "-peers",
        "-saturations",   "-radii",         "-queries",   "-seed",      "-threads"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

TEST_F(Experiment, WrongUsageIsNamed)
{
  const std::string out = path("results");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "NAME"},
      {{"alchemy", "-out", out}, "classification, criteria"},
      {{"space", "classification", "-out", out}, "'classification'"},
      {{"space"}, "-out"},
      {{"classification", "-out", out}, "-meshes"},
      {{"classification", "-meshes", out}, "-out"},
      {{"space", "-out", out, "-threads", "2"}, "-threads"},
      {{"space", "-out", out, "-meshes", out}, "-meshes"},
      {{"classification", "-out", out, "-meshes", out, "-radii", "2"}, "-radii"},
      {{"noise", "-out", out, "-meshes", out, "-intervals", "2"}, "-intervals"},
      {{"visibility", "-out", out, "-meshes", out, "-normal_radius", "2"}, "-normal_radius"},
      {{"criteria", "-out", out, "-meshes", out, "-peers", "vfh"}, "-peers"},
      {{"peers", "-out", out, "-meshes", out, "-peers", "vfh,sift"}, "'sift'"},
      {{"noise", "-out", out, "-meshes", out, "-skip", "2"}, "-skip"},
      {{"peers", "-out", out, "-meshes", out, "-strangers", "box"}, "-strangers"},
      {{"retrieval", "-out", out, "-meshes", out, "-objects", "box"}, "two classes"},
      {{"retrieval", "-out", out, "-meshes", out, "-tests", "1"}, "two models"}};
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

TEST_F(Experiment, CriteriaWriteRatesConfusionsAndTheirPicture)
{
  const AppRun r = run("experiment", twoObjects({"criteria", "-tests", "2", "-seed", "3"}));
  ASSERT_TRUE(ended(r, 0, {}));
  for (const std::string word : {"Table 3.1", "2 tests per object", "seed 3", "100.0 (51.0-100.0)"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word << " in " << r.out;
  const auto rates = rows("criteria.csv");
  ASSERT_EQ(rates.size(), 15u) << "six criteria and one more by two protocols";
  EXPECT_EQ(rates[0], kRateColumns);
  std::map<std::string, int> answers;
  for (const auto& row : rows("criteria_confusion.csv"))
    if (row[6] != "count")
      answers[row[3]] += std::stoi(row[6]);
  for (std::size_t i = 1; i < rates.size(); ++i) {
    EXPECT_EQ(rates[i][4], "4");
    EXPECT_EQ(answers[rates[i][3]], 4) << rates[i][3];
  }
  EXPECT_EQ(rates[6][3], "likelihood");
  EXPECT_EQ(rates[6][5], "4") << "a sphere is not a cup";
  EXPECT_NE(fs::exists(path("results/criteria_confusion.png")),
            r.err.find("no picture") != std::string::npos);
}

TEST_F(Experiment, DistortionsGiveTheSameWhateverTheThreads)
{
  const auto arguments = twoObjects({"distortion", "-tests", "1", "-intervals", "2"});
  std::string confusions[2];
  for (const std::string threads : {"1", "2"}) {
    auto all = arguments;
    all.insert(all.end(), {"-threads", threads});
    ASSERT_TRUE(ended(run("experiment", all), 0, {}));
    confusions[threads == "2"] = readFile(path("results/distortion_confusion.csv"));
  }
  EXPECT_EQ(confusions[0], confusions[1]);
  const auto rates = rows("distortion.csv");
  ASSERT_EQ(rates.size(), 7u) << "one, two and three axes, shrunk and stretched";
  for (std::size_t i = 1; i < rates.size(); ++i)
    EXPECT_EQ(rates[i][4], "2");
}

TEST_F(Experiment, PeersAnswerTheSameQueriesAndNameTheirMetric)
{
  const auto arguments = twoObjects({"peers", "-tests", "1", "-peers", "our-cvfh,vfh,ppf"});
  auto running = std::async(std::launch::async, [&] { return run("experiment", arguments); });
  const std::string file = path("results/peers.csv");
  std::size_t early = 0; // rows while it runs
  while (running.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
    if (early == 0 && fs::exists(file))
      early = rows("peers.csv").size();
  ASSERT_TRUE(ended(running.get(), 0, {}));
  const auto rates = rows("peers.csv");
  std::map<std::string, std::map<std::string, std::vector<std::string>>> table;
  for (std::size_t i = 1; i < rates.size(); ++i)
    table[rates[i][3].substr(0, rates[i][3].find(','))][rates[i][2]] = rates[i];
  for (const std::string name : {"our-cvfh", "vfh", "ppf", "likelihood", "bank"})
    ASSERT_EQ(table[name].size(), 12u) << name << " under twelve conditions";
  EXPECT_GT(early, 1u) << "rows are written as they come";
  EXPECT_LT(early, rates.size());
  for (const auto& [condition, row] : table["bank"])
    EXPECT_EQ(row[5], "2") << condition;
  EXPECT_EQ(table["vfh"]["ideal"][5], "2");
  EXPECT_EQ(table["ppf"]["ideal"][5], "2");
  EXPECT_GT(std::stod(table["vfh"]["ideal"][10]), 0) << "time per query";
  const auto& name = table["vfh"]["ideal"][3];
  EXPECT_TRUE(name == "vfh, L1" || name == "vfh, L2" || name == "vfh, chi-squared") << name;
}

TEST_F(Experiment, RejectionCountsKnownAndStrangers)
{
  auto arguments = twoObjects({"rejection", "-tests", "1", "-strangers", "box"});
  ASSERT_EQ(run("generate_shape", {"box", path("box.off"), "-points", "500"}).code, 0);
  const AppRun r = run("experiment", arguments);
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_NE(r.out.find("2 known, 1 strangers"), std::string::npos) << r.out;
  const auto table = rows("rejection.csv");
  ASSERT_EQ(table.size(), 27u) << "twelve conditions and all of them, by two limits";
  const auto& all = table.back();
  EXPECT_EQ(all, (std::vector<std::string>{"95 % of the known", all[1], "all", "24", "23", "12",
                                           all[6]}));
  EXPECT_EQ(table[1][2], "ideal");
  EXPECT_EQ(table[1][4], "2") << "known objects are accepted";
  EXPECT_EQ(table[1][6], "0") << "a box is neither sphere nor cup";
}

TEST_F(Experiment, RetrievalFindsTheClass)
{
  const AppRun r = run("experiment", twoObjects({"retrieval", "-tests", "3", "-seed", "4"}));
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_NE(r.out.find("2 classes of 3 models"), std::string::npos) << r.out;
  const auto table = rows("retrieval.csv");
  ASSERT_EQ(table.size(), 40u) << "thirteen figures of three collections";
  EXPECT_EQ(table[0], (std::vector<std::string>{"variety", "figure", "value", "low", "high"}));
  EXPECT_EQ(table[1], (std::vector<std::string>{"0.1", "nearest neighbour", "1", "1", "1"}));
  for (std::size_t i = 1; i < table.size(); ++i) {
    const double value = std::stod(table[i][2]);
    EXPECT_LE(std::stod(table[i][3]), value);
    EXPECT_GE(std::stod(table[i][4]), value);
    if (table[i][0] == "0.1") {
      EXPECT_EQ(value, 1) << table[i][1] << ": a sphere is not a cup";
    }
  }
  EXPECT_NE(fs::exists(path("results/retrieval.svg")),
            r.err.find("no picture") != std::string::npos);
}
