// What the programs are for, end to end and option by option.
#include "app_runner.h"

#include <algorithm>
#include <cmath>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

using Table = std::vector<std::vector<std::string>>;

class RoundTrip : public Apps {
protected:
  AppRun
  classify(std::vector<std::string> arguments)
  {
    arguments.insert(arguments.begin(), {"-database", path("db.pcd")});
    return run("classify", arguments);
  }
  AppRun
  train(std::vector<std::string> arguments)
  {
    arguments.insert(arguments.begin(), {"-database", path("db.pcd"), "-pairs", "100000"});
    return run("train", arguments);
  }
  Table
  info()
  {
    const AppRun r = run("info", {path("db.pcd"), "-csv"});
    EXPECT_TRUE(ended(r, 0, {}));
    return parseCsv(r.out);
  }
};

} // namespace

TEST_F(RoundTrip, TrainInfoClassify)
{
  makeDatabase();
  const Table table = info();
  ASSERT_EQ(table.size(), 4u);
  ASSERT_EQ(table[0].size(), 14u);
  const std::vector<std::string> begin(table[1].begin(), table[1].begin() + 5);
  EXPECT_EQ(begin, (std::vector<std::string>{"ball", "object", "0", "complete", "5,5,5,5"}));
  EXPECT_EQ(table[2][0], "die");
  EXPECT_NEAR(std::stod(table[1][5]), 0.2, 0.001) << "delta_max";
  EXPECT_EQ(table[1][9], "0") << "points have no known area";
  EXPECT_GT(std::stod(table[3][9]), 0.01) << "meshes have";

  // Other points of the same shapes, moved by noise.
  std::vector<std::string> queries = {"-csv", "-top", "1"};
  for (const std::string shape : {"sphere", "cube", "cup"}) {
    queries.push_back(path("fresh_" + shape + ".ply"));
    ASSERT_EQ(run("generate_shape",
                  {shape, queries.back(), "-points", "1500", "-noise", "0.0005", "-seed", "9"})
                  .code,
              0);
  }
  const AppRun r = classify(queries);
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_EQ(r.err, "");
  const Table answers = parseCsv(r.out);
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0], (std::vector<std::string>{"file", "answer", "rank", "label", "score",
                                                  "posterior", "surprise", "condition", "misfit"}));
  EXPECT_EQ(answers[1][7], "complete");
  EXPECT_EQ(answers[1][8], "0") << "not measured without a bank";
  EXPECT_EQ(answers[1][1], "ball");
  EXPECT_EQ(answers[2][1], "die");
  EXPECT_EQ(answers[3][1], "cup");
  EXPECT_GT(std::stod(answers[3][5]), 0.9);
}

TEST_F(RoundTrip, TextNamesFileAnswerAndRanking)
{
  makeDatabase();
  const AppRun r = classify({path("die.ply")});
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_EQ(r.out.find(path("die.ply") + ": die\n  1 die  score "), 0u) << r.out;
  for (const char* word : {"\n  2 ", "\n  3 ", "posterior", "surprise"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
  const AppRun text = run("info", {path("db.pcd")});
  for (const char* word : {"3 models", "5,5,5,5", "penalty", "ball  object", "% of the bins empty"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word;
}

TEST_F(RoundTrip, EveryCriterionKnowsTheBall)
{
  makeDatabase();
  for (const std::string name :
       {"euclidean", "intersection", "chi1", "chi2", "kullback", "likelihood", "normalized"}) {
    const AppRun r = classify({"-criterion", name, "-csv", "-top", "3", path("ball.pcd")});
    ASSERT_TRUE(ended(r, 0, {})) << name;
    const Table rows = parseCsv(r.out);
    ASSERT_EQ(rows.size(), 4u) << name;
    EXPECT_EQ(rows[1][1], "ball") << name;
  }
}

TEST_F(RoundTrip, UnknownWhereTheThresholdRejects)
{
  ASSERT_EQ(run("generate_shape", {"sphere", path("ball.pcd"), "-points", "1000"}).code, 0);
  ASSERT_EQ(run("generate_shape", {"cube", path("die.pcd"), "-points", "1000"}).code, 0);
  ASSERT_TRUE(ended(train({path("ball.pcd")}), 0, {}));
  const Table rows =
      parseCsv(classify({"-csv", "-unknown", "0.5", path("die.pcd"), path("ball.pcd")}).out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][1], "unknown");
  EXPECT_EQ(rows[1][3], "ball") << "the ranking is still told";
  EXPECT_EQ(rows[2][1], "ball");
}

TEST_F(RoundTrip, ScaleNormalizedForgetsTheSize)
{
  makeDatabase();
  // A die a hundred times as large.
  std::string off = "OFF\n8 12 0\n";
  for (int i = 0; i < 8; ++i)
    off += std::string(i & 1 ? "5 " : "-5 ") + (i & 2 ? "5 " : "-5 ") + (i & 4 ? "5\n" : "-5\n");
  off += "3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n"
         "3 0 6 2\n3 1 3 7\n3 1 7 5\n";
  writeFile(path("huge.off"), off);
  const std::vector<std::string> line = {"-csv", "-unknown", "1", path("huge.off")};
  EXPECT_EQ(parseCsv(classify(line).out)[1][1], "unknown");
  auto normalized = line;
  normalized.push_back("-scale_normalized");
  EXPECT_EQ(parseCsv(classify(normalized).out)[1][1], "die");
}

TEST_F(RoundTrip, TrainAddsReplacesAndSaysSo)
{
  makeShapes();
  EXPECT_TRUE(ended(train({path("ball.pcd")}), 0, {"added 'ball' (object"}));
  EXPECT_TRUE(ended(train({"-label", "table, \"round\"", "-background", path("die.ply")}), 0,
                    {"added 'table, \"round\"' (background"}));
  EXPECT_TRUE(
      ended(train({path("ball.pcd"), path("cup.off")}), 0, {"replaced 'ball'", "added 'cup'"}));
  const Table table = info();
  ASSERT_EQ(table.size(), 4u);
  EXPECT_EQ(table[2][0], "table, \"round\"") << "quoted in CSV";
  EXPECT_EQ(table[2][1], "background");
}

TEST_F(RoundTrip, TrainsForScenesFromMeshesAndClouds)
{
  makeShapes();
  const auto for_scenes = [&](const std::string& leaf, std::vector<std::string> files) {
    files.insert(files.begin(), {"-database", path("db.pcd"), "-leaf", leaf});
    return run("train", files);
  };
  ASSERT_TRUE(ended(for_scenes("0.01", {path("ball.pcd"), path("cup.off")}), 0, {"added 'cup'"}));
  const Table table = info();
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t row = 1; row < 3; ++row) {
    EXPECT_EQ(table[row][3], "complete, cells");
    EXPECT_GT(std::stod(table[row][9]), 0.01) << "of points the area is known, too";
  }
  EXPECT_TRUE(ended(for_scenes("1", {path("ball.pcd")}), 2, {path("ball.pcd"), "smaller cells"}));
  EXPECT_TRUE(
      ended(for_scenes("0.00001", {path("cup.off")}), 2, {path("cup.off"), "larger -leaf"}));
}

TEST_F(RoundTrip, BinsOfTheDatabaseRule)
{
  makeShapes();
  ASSERT_TRUE(ended(train({"-bins", "3,4,5,2", path("ball.pcd")}), 0, {}));
  EXPECT_EQ(info()[1][4], "3,4,5,2");
  const std::string before = readFile(path("db.pcd"));
  EXPECT_TRUE(ended(train({path("die.ply")}), 2, {path("db.pcd"), "3,4,5,2", "-bins"}));
  EXPECT_EQ(readFile(path("db.pcd")), before);
  EXPECT_TRUE(ended(train({"-bins", "3,4,5,2", path("die.ply")}), 0, {"added 'die'"}));
}

TEST_F(RoundTrip, SameSeedSameBytesWhateverTheThreads)
{
  makeShapes();
  std::string databases[2], answers[2];
  for (const int i : {0, 1}) {
    const std::string db = path("db" + std::to_string(i) + ".pcd"), threads = i == 0 ? "1" : "4";
    ASSERT_EQ(run("train", {"-database", db, "-pairs", "300000", "-threads", threads, "-seed", "5",
                            path("ball.pcd"), path("die.ply"), path("cup.off")})
                  .code,
              0);
    databases[i] = readFile(db);
    answers[i] = run("classify", {"-database", db, "-csv", "-threads", threads, "-seed", "6",
                                  path("ball.pcd"), path("die.ply"), path("cup.off")})
                     .out;
  }
  EXPECT_FALSE(databases[0].empty());
  EXPECT_TRUE(databases[0] == databases[1]);
  EXPECT_FALSE(answers[0].empty());
  EXPECT_EQ(answers[0], answers[1]);
  const AppRun other = run("classify", {"-database", path("db0.pcd"), "-csv", "-seed", "7",
                                        path("ball.pcd"), path("die.ply"), path("cup.off")});
  EXPECT_NE(other.out, answers[0]) << "the seed is used";
  // Of points everything is used: only the draw of the pairs can differ.
  const auto drawn = [&](const std::string& seed) {
    return run("classify", {"-database", path("db0.pcd"), "-seed", seed, path("die.ply")}).out;
  };
  EXPECT_NE(drawn("6"), drawn("7"));
}

TEST_F(RoundTrip, FeaturesAndTopAreUsed)
{
  makeDatabase();
  const auto few =
      parseCsv(classify({"-csv", "-top", "2", "-features", "700", path("die.ply")}).out);
  const auto more = parseCsv(classify({"-csv", "-top", "99", path("die.ply")}).out);
  EXPECT_EQ(few.size(), 3u);
  EXPECT_EQ(more.size(), 4u);
  EXPECT_NE(few[1][4], more[1][4]);
}

TEST_F(RoundTrip, DescriptorIsAPcdOfOneField)
{
  makeShapes();
  const auto descriptor = [&](std::vector<std::string> extra, const std::string& in) {
    extra.insert(extra.begin(), {path(in), path("f.pcd")});
    EXPECT_TRUE(ended(run("feature", extra), 0, {path("f.pcd")}));
    return readFile(path("f.pcd"));
  };
  const std::string ball = descriptor({}, "ball.pcd");
  for (const char* line : {"FIELDS surflet_pairs\n", "COUNT 625\n", "POINTS 1\n", "DATA binary\n"})
    EXPECT_NE(ball.find(line), std::string::npos) << line;
  EXPECT_EQ(ball, descriptor({}, "ball.pcd"));
  EXPECT_NE(ball, descriptor({"-delta_max", "1"}, "ball.pcd"));
  const std::string drawn = descriptor({"-pairs", "5000"}, "ball.pcd");
  EXPECT_NE(ball, drawn);
  EXPECT_NE(drawn, descriptor({"-pairs", "5000", "-seed", "2"}, "ball.pcd"));
  EXPECT_NE(ball, descriptor({}, "cup.off"));
}

TEST_F(RoundTrip, NormalsAreEstimatedOnRequest)
{
  // The sensor is at the origin of a PLY: the cap of a ball in front of it.
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  for (int i = 0; i < 900; ++i) {
    const double x = (i % 30 - 14.5) / 40, y = (i / 30 - 14.5) / 40;
    ply += std::to_string(x) + " " + std::to_string(y) + " " +
           std::to_string(2 - std::sqrt(1 - x * x - y * y)) + "\n";
  }
  writeFile(path("cap.ply"), ply);
  EXPECT_TRUE(ended(train({path("cap.ply")}), 2, {path("cap.ply"), "normals", "-k"}));
  EXPECT_FALSE(fs::exists(path("db.pcd")));
  EXPECT_TRUE(ended(train({"-k", "12", path("cap.ply")}), 0, {"added 'cap'"}));
  EXPECT_TRUE(ended(classify({"-k", "12", path("cap.ply")}), 0, {}));
  EXPECT_TRUE(ended(classify({path("cap.ply")}), 2, {path("cap.ply"), "-k"}));
  EXPECT_TRUE(ended(run("feature", {"-k", "12", path("cap.ply"), path("f.pcd")}), 0, {}));
  EXPECT_TRUE(ended(run("feature", {path("cap.ply"), path("f.pcd")}), 2, {path("cap.ply"), "-k"}));
}

TEST_F(RoundTrip, UnevenDensityIsEvenedOutWithANote)
{
  std::string ply = "ply\nformat ascii 1.0\nelement vertex 2600\nproperty float x\n"
                    "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
                    "property float nz\nend_header\n";
  for (int i = 0; i < 2500; ++i) // two squares side by side, one with 50 x 50, one with 10 x 10
    ply += std::to_string((i % 50) / 50.0) + " " + std::to_string((i / 50) / 50.0) + " 0 0 0 1\n";
  for (int i = 0; i < 100; ++i)
    ply +=
        std::to_string(1 + (i % 10) / 10.0) + " " + std::to_string((i / 10) / 10.0) + " 0 0 0 1\n";
  writeFile(path("uneven.ply"), ply);
  EXPECT_TRUE(ended(train({path("uneven.ply")}), 0, {"uneven density", path("uneven.ply")}));
}

TEST_F(RoundTrip, ShapesAreReproducibleAndAsLargeAsAskedFor)
{
  const auto shape = [&](const std::string& file, std::vector<std::string> extra) {
    extra.insert(extra.begin(), {"torus", path(file)});
    EXPECT_TRUE(ended(run("generate_shape", extra), 0, {path(file)}));
    return readFile(path(file));
  };
  for (const std::string ending : {"a.pcd", "a.ply", "a.off"}) {
    const std::string plain = shape(ending, {"-points", "300"});
    EXPECT_EQ(plain, shape(ending, {"-points", "300"})) << ending;
    EXPECT_NE(plain, shape(ending, {"-points", "300", "-noise", "0.001"})) << ending;
    EXPECT_NE(shape(ending, {"-points", "300", "-noise", "0.001", "-seed", "2"}),
              shape(ending, {"-points", "300", "-noise", "0.001", "-seed", "3"}))
        << ending;
  }
  const std::string ply = shape("b.ply", {"-points", "300"});
  EXPECT_EQ(std::count(ply.begin(), ply.end(), '\n'), 310);
  const std::string pcd = shape("b.pcd", {"-points", "300"});
  EXPECT_NE(pcd.find("POINTS 300\n"), std::string::npos);
}

TEST_F(RoundTrip, EveryShapeCanBeTrained)
{
  std::vector<std::string> files;
  for (const std::string name :
       {"plane", "box", "cube", "tetrahedron", "sphere", "ellipsoid", "torus", "cylinder", "cone",
        "bottle", "carafe", "wine_glass", "cup"}) {
    files.push_back(path(name + ".pcd"));
    ASSERT_EQ(run("generate_shape", {name, files.back(), "-points", "3000"}).code, 0) << name;
  }
  ASSERT_TRUE(ended(train(files), 0, {}));
  EXPECT_EQ(info().size(), 14u);
}

TEST_F(RoundTrip, BanksAreTrainedReportedAndRejectStrangers)
{
  makeShapes();
  writeFile(path("bank.txt"), "noise 3 # percent\nvisible 40 members 2\n");
  ASSERT_TRUE(ended(train({"-bank", path("bank.txt"), path("die.ply"), path("cup.off")}), 0,
                    {"4 members"}));
  const Table table = info();
  ASSERT_EQ(table.size(), 9u);
  EXPECT_EQ(table[1][3], "complete");
  EXPECT_EQ(table[2][3], "noise 3 %");
  EXPECT_EQ(table[4][3], "visible 40 % (2 of 2)");
  const Table rows = parseCsv(
      classify({"-csv", "-top", "1", "-unknown", "auto", path("cup.off"), path("ball.pcd")}).out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][1], "cup");
  EXPECT_EQ(rows[1][7], "complete");
  EXPECT_GT(std::stod(rows[1][8]), 0);
  EXPECT_EQ(rows[2][1], "unknown");
  EXPECT_NE(classify({path("cup.off")}).out.find("as complete"), std::string::npos);
}

TEST_F(RoundTrip, UnusableBanksAreTold)
{
  makeDatabase();
  writeFile(path("bank.txt"), "noise 1\nvisible much\n");
  EXPECT_TRUE(ended(train({"-bank", path("bank.txt"), path("ball.pcd")}), 2,
                    {path("bank.txt"), "line 2", "'much'"}));
  EXPECT_TRUE(ended(train({"-bank", path("no.txt"), path("ball.pcd")}), 2,
                    {path("no.txt"), "default or none"}));
  EXPECT_TRUE(ended(classify({"-unknown", "auto", path("ball.pcd")}), 2,
                    {path("db.pcd"), "-bank default"}));
}

TEST_F(RoundTrip, SearchListsTheMostSimilarOfAnySize)
{
  makeDatabase();
  const auto search = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-database", path("db.pcd")});
    return run("search", arguments);
  };
  const AppRun r = search({"-csv", "-top", "2", path("cup.off"), path("ball.pcd")});
  ASSERT_TRUE(ended(r, 0, {}));
  const Table rows = parseCsv(r.out);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"file", "rank", "label", "score"}));
  EXPECT_EQ(rows[1][2], "cup");
  EXPECT_EQ(rows[3][2], "ball");
  EXPECT_EQ(search({"-exhaustive", "-csv", "-top", "2", path("cup.off"), path("ball.pcd")}).out,
            r.out);
  writeFile(path("classes.csv"), "ball,round\ncup,round\ndie,edged\n");
  const Table figures = parseCsv(search({"-classes", path("classes.csv")}).out);
  ASSERT_EQ(figures.size(), 15u);
  EXPECT_EQ(figures[1], (std::vector<std::string>{"queries", "2"}));
  writeFile(path("classes.csv"), "ball,round\ncup\n");
  EXPECT_TRUE(ended(search({"-classes", path("classes.csv")}), 2, {"line 2", "comma"}));
  writeFile(path("classes.csv"), "ball,round\ncup,round\n");
  EXPECT_TRUE(ended(search({"-classes", path("classes.csv")}), 2, {"'die'", "add a line"}));
}
