// Methods compared by pcl_surflet_evaluate.
#include "app_runner.h"

#include <map>

using namespace pcl_surflet::test;

namespace {

class EvaluateFiles : public Apps {};

using Line = std::map<std::string, std::string>;

/** \brief Sparse scenes, coarse cells: seconds, and enough for simple shapes. */
AppRun
evaluated(std::vector<std::string> arguments)
{
  const std::vector<std::string> coarse = {"-density", "100000", "-leaf", "0.008",
                                           "-pairs",   "50000",  "-csv"};
  arguments.insert(arguments.begin(), coarse.begin(), coarse.end());
  return run("evaluate", arguments);
}

std::vector<Line>
linesOf(const std::string& csv)
{
  const auto table = parseCsv(csv);
  std::vector<Line> lines;
  for (std::size_t i = 1; i < table.size(); ++i) {
    lines.emplace_back();
    EXPECT_EQ(table[i].size(), table[0].size());
    for (std::size_t k = 0; k < table[i].size(); ++k)
      lines.back()[table[0][k]] = table[i][k];
  }
  return lines;
}

/** \brief The lines about all objects together. */
std::vector<Line>
overall(const AppRun& r)
{
  EXPECT_TRUE(ended(r, 0, {}));
  std::vector<Line> all;
  for (auto& line : linesOf(r.out))
    if (line["object"] == "all")
      all.push_back(line);
  return all;
}

} // namespace

TEST(Evaluate, EveryMethodSeesTheSameScenes)
{
  const AppRun r =
      evaluated({"-method", "dissertation,explanation,classic_vfh,classic_esf,exclusion_vfh",
                 "-treatment", "exclude", "-scenes", "1", "-row", "easy, two", "bottle", "torus"});
  ASSERT_TRUE(ended(r, 0, {}));
  const auto lines = linesOf(r.out);
  ASSERT_EQ(lines.size(), 15u) << "two objects and all, five methods";
  for (auto line : lines) {
    EXPECT_EQ(line["row"], "easy, two");
    EXPECT_EQ(line["treatment"], "exclude");
    EXPECT_EQ(line["present"], line["object"] == "all" ? "2" : "1");
    EXPECT_EQ(std::stod(line["scene_cells"]) > std::stod(lines[0].at("scene_cells")),
              line["method"] == "explanation")
        << "it has both sides of the bottle's wall";
    EXPECT_EQ(line["normals_ratio"], "") << "was not asked for";
    if (line["method"] != "dissertation") {
      EXPECT_EQ(line["found"], line["present"]) << line["method"] << " " << line["object"];
      EXPECT_EQ(line["precision"], "100") << line["method"] << " " << line["object"];
      EXPECT_EQ(line["recall_times_precision"], "100") << line["method"] << " " << line["object"];
    }
  }
}

TEST(Evaluate, TableNamesRowAndMethods)
{
  const AppRun r = run("evaluate", {"-method", "classic_vfh", "-density", "50000", "-leaf", "0.01",
                                    "-row", "easy", "-scenes", "1", "bottle", "torus"});
  ASSERT_TRUE(ended(r, 0, {}));
  for (const char* word : {"easy, classic_vfh", "torus", "precision 100 %", "seconds a scene"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

TEST(Evaluate, ClassicLeavesUnknownThingsAlone)
{
  for (auto line :
       overall(evaluated({"-method", "classic_vfh,exclusion_vfh", "-treatment", "exclude",
                          "-scenes", "2", "-clutter", "cone,cube", "bottle", "torus"}))) {
    EXPECT_EQ(line["found"], "4") << line["method"];
    EXPECT_EQ(line["false_per_scene"], "0") << line["method"];
  }
}

TEST(Evaluate, ClassicRemovesAllPlanesOfABox)
{
  for (auto line : overall(evaluated(
           {"-method", "classic_vfh", "-background", "box", "-scenes", "1", "bottle", "torus"}))) {
    EXPECT_EQ(line["found"], "2");
    EXPECT_EQ(line["clusters"], "2") << "walls are no objects";
  }
}

TEST(Evaluate, SensedScenesAreLearnedFromTheSameSensor)
{
  const auto lines = overall(evaluated({"-method",       "explanation,classic_vfh",
                                        "-treatment",    "model",
                                        "-views",        "ring24",
                                        "-pixels",       "320x240",
                                        "-sensor_noise", "0.0003",
                                        "-grazing",      "80",
                                        "-distance",     "0.9",
                                        "-size",         "0.6",
                                        "-scenes",       "1",
                                        "bottle",        "torus"}));
  ASSERT_EQ(lines.size(), 2u);
  for (auto line : lines) {
    EXPECT_EQ(line["found"], "2") << line["method"];
    EXPECT_EQ(line["centred"], "2") << line["method"];
    EXPECT_EQ(line["false_per_scene"], "0") << line["method"];
  }
}

TEST(Evaluate, ThingsMayBeAbsent)
{
  std::size_t present = 0;
  for (auto& line : overall(evaluated({"-method", "exclusion_vfh", "-treatment", "exclude",
                                       "-presence", "0.5", "-scenes", "6", "bottle", "torus"})))
    present = std::stoul(line["present"]);
  EXPECT_GT(present, 1u); // of 12; all or none is a matter of 1 in 2,000
  EXPECT_LT(present, 12u);
  EXPECT_TRUE(ended(evaluated({"-presence", "0.5", "-present", "1", "bottle"}), 1, {"-presence"}));
  EXPECT_TRUE(ended(evaluated({"-views", "one", "-noise", "0.1", "bottle"}), 1, {"-noise"}));
}

TEST(Evaluate, CriticalDistanceTellsTouchingFromApart)
{
  const auto lines = overall(evaluated({"-method", "classic_vfh", "-critical", "0.3,2.5", "-scenes",
                                        "2", "-row", "pair", "bottle", "torus"}));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].at("row"), "pair 0.3");
  EXPECT_EQ(lines[1].at("row"), "pair 2.5");
  EXPECT_EQ(lines[0].at("present"), "4") << "two instances a scene";
  EXPECT_EQ(lines[1].at("recall"), "100");
  EXPECT_LT(std::stod(lines[0].at("recall")), 60) << "one cluster, at most one name";
}

TEST(Evaluate, ScalingMultipliesObjectsOrModels)
{
  const auto area =
      overall(evaluated({"-method", "exclusion_vfh", "-treatment", "exclude", "-scaling", "area",
                         "-times", "1,3", "-scenes", "1", "-peers", "-memory", "torus"}));
  ASSERT_EQ(area.size(), 2u);
  EXPECT_EQ(area[0].at("present") + area[1].at("present"), "13");
  EXPECT_EQ(area[0].at("found") + area[1].at("found"), "13") << "all of the table is left out";
  EXPECT_NEAR(std::stod(area[1].at("scene_cells")), 3 * std::stod(area[0].at("scene_cells")),
              0.3 * std::stod(area[0].at("scene_cells")));
  for (const auto* measured : {"normals_ratio", "voxelgrid_ratio", "seconds"})
    EXPECT_GT(std::stod(area[0].at(measured)), 0) << measured;
  const auto models = overall(evaluated({"-method", "classic_vfh", "-scaling", "models", "-times",
                                         "1,3", "-extra", "cone,cube", "-scenes", "1", "torus"}));
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].at("models") + models[1].at("models"), "13");
  EXPECT_EQ(models[0].at("present") + models[1].at("present"), "11");
}

TEST_F(EvaluateFiles, ClassicPassesOverWhatIsTooSmallForItsCells)
{
  makeShapes();
  const std::vector<std::string> coarse = {"-method",  "classic_vfh", "-leaf",   "0.03", "-csv",
                                           "-density", "50000",       "-scenes", "1"};
  auto small = coarse;
  small.push_back(path("cup.off") + ":0.04");
  EXPECT_TRUE(ended(run("evaluate", small), 2, {"-leaf"}));
  small.push_back("torus");
  const auto all = overall(run("evaluate", small));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].at("found"), "1") << "the torus";
}

TEST(Evaluate, WhatDoesNotFitIsSaid)
{
  EXPECT_TRUE(ended(run("evaluate", {"-size", "0.05", "bottle"}), 2, {"do not fit"}));
}

TEST(Evaluate, StudiesOfTheExtensions)
{
  const auto study = [](const std::string& name, const std::string& methods) {
    const AppRun r = evaluated({"-study", name, "-method", methods, "-treatment", "exclude",
                                "-scenes", "1", "-runs", "3", "bottle", "torus"});
    EXPECT_TRUE(ended(r, 0, {}));
    return linesOf(r.out);
  };
  auto border = study("border", "dissertation,repeated");
  ASSERT_EQ(border.size(), 2u);
  EXPECT_EQ(border[1]["method"], "repeated");
  EXPECT_GT(std::stod(border[1]["cells_each"]), std::stod(border[0]["cells_each"]));
  for (auto line : border)
    EXPECT_LE(std::stod(line["border_percent"]), 100);

  auto runs = study("runs", "dissertation");
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_GT(std::stod(runs[2]["seconds"]), std::stod(runs[0]["seconds"]));

  auto paths = study("paths", "floating");
  ASSERT_FALSE(paths.empty());
  EXPECT_EQ(paths[0]["step"], "0");
}
