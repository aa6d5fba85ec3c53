#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/model_database.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace pcl_surflet;

namespace {

HistogramModel
model(const std::string& label, const Shape& shape, const Resolution& resolution = {})
{
  HistogramModelTrainer trainer;
  trainer.setResolution(resolution);
  return trainer.train(label, sampleShape(shape, 500, 1));
}

std::string
errorOf(ModelDatabase& database, const HistogramModel& m)
{
  try {
    database.add(m);
  }
  catch (const DatabaseError& e) {
    return e.what();
  }
  return "no error";
}

} // namespace

TEST(ModelDatabase, KeepsModelsInOrderByUniqueLabel)
{
  ModelDatabase database;
  database.add(model("ball", Shape::sphere(0.1)));
  database.add(model("die", Shape::box(0.1, 0.1, 0.1)));
  EXPECT_EQ(database.size(), 2u);
  EXPECT_EQ(database[1].label, "die");
  EXPECT_EQ(database.find("ball"), &database[0]);
  EXPECT_EQ(database.find("cat"), nullptr);
  EXPECT_NEAR(database.largestDelta(), 0.2, 0.01);
  EXPECT_NE(errorOf(database, model("die", Shape::sphere(1))).find("already"), std::string::npos);
  EXPECT_TRUE(database.replace(model("die", Shape::sphere(1))));
  EXPECT_NEAR(database[1].delta_max, 2, 0.1);
  EXPECT_FALSE(database.replace(model("new", Shape::sphere(1))));
  EXPECT_TRUE(database.remove("die"));
  EXPECT_FALSE(database.remove("die"));
  EXPECT_EQ(database.size(), 2u);
}

TEST(ModelDatabase, OneResolutionForAll)
{
  ModelDatabase database;
  database.add(model("ball", Shape::sphere(0.1)));
  const auto error = errorOf(database, model("die", Shape::box(1, 1, 1), {7, 7, 7, 7}));
  EXPECT_NE(error.find("7,7,7,7"), std::string::npos);
  EXPECT_NE(error.find("5,5,5,5"), std::string::npos);
  // The only model may be replaced by one of another resolution.
  EXPECT_TRUE(database.replace(model("ball", Shape::sphere(0.1), {7, 7, 7, 7})));
  EXPECT_EQ(database.resolution(), (Resolution{7, 7, 7, 7}));
}

TEST(ModelDatabase, UnusableModelIsRefused)
{
  ModelDatabase database;
  auto bad = model("ball", Shape::sphere(0.1));
  bad.members[0].histogram[0] = std::nanf("");
  EXPECT_NE(errorOf(database, bad).find("not finite"), std::string::npos);
  EXPECT_TRUE(database.empty());
}

TEST(ModelDatabase, PenaltyIsRelativeToTheRarestBinOfAllModels)
{
  ModelDatabase database;
  database.add(model("ball", Shape::sphere(0.1)));
  database.add(model("die", Shape::box(0.1, 0.1, 0.1)));
  database.setPenalty({0.5, 0});
  double smallest = 1;
  for (std::size_t i = 0; i < 2; ++i)
    for (const float v : database[i].members[0].histogram)
      if (v > 0)
        smallest = std::min<double>(smallest, v);
  EXPECT_DOUBLE_EQ(database.penaltyMinimum(), 0.5 * smallest);
  for (const auto& p : database.penalized()) {
    EXPECT_NEAR(std::accumulate(p.h.begin(), p.h.end(), 0.0), 1, 1e-9);
    for (std::size_t b = 0; b < p.h.size(); ++b) {
      EXPECT_EQ(p.empty_bin[b], database[p.model].members[0].histogram[b] == 0);
      if (p.empty_bin[b]) {
        EXPECT_DOUBLE_EQ(p.h[b], database.penaltyMinimum());
      }
      EXPECT_DOUBLE_EQ(p.log_h[b], std::log(p.h[b]));
    }
  }
  database.setPenalty({1, 1e-4});
  EXPECT_DOUBLE_EQ(database.penaltyMinimum(), 1e-4);
  database.setPenalty({1, 0.9}); // would leave nothing of 625 bins
  EXPECT_DOUBLE_EQ(database.penaltyMinimum(), 0.5 / 625);
}

TEST(ModelDatabase, MisusedPenaltyThrows)
{
  ModelDatabase database;
  EXPECT_THROW(database.setPenalty({0, 0}), DatabaseError);
  EXPECT_THROW(database.setPenalty({1.5, 0}), DatabaseError);
  EXPECT_THROW(database.setPenalty({1, -1}), DatabaseError);
  EXPECT_THROW(database.setPenalty({1, std::nan("")}), DatabaseError);
}
