#include "scene_pieces.h"

#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl_surflet;
using pcl_surflet::test::scaled;

namespace {

const ModelDatabase&
shapes()
{
  static const ModelDatabase database = [] {
    ModelDatabase d;
    HistogramModelTrainer trainer;
    trainer.setNumberOfPairs(500000);
    for (const auto& name : shapeNames())
      d.add(trainer.train(name, sampleShape(*shapeByName(name), 10000, 1)));
    return d;
  }();
  return database;
}

} // namespace

TEST(Classifier, NamesEveryShapeByTheLikelihood)
{
  HistogramClassifier classifier(shapes());
  for (const auto& name : shapeNames())
    for (std::uint64_t seed = 10; seed < 13; ++seed) {
      const auto answer = classifier.classify(sampleShape(*shapeByName(name), 2000, seed));
      ASSERT_EQ(answer.ranking.size(), shapes().size());
      EXPECT_EQ(answer.best()->label, name);
      EXPECT_GT(answer.best()->posterior, 0.99) << name;
      EXPECT_LT(answer.best()->surprise, 0.15) << name;
      EXPECT_EQ(answer.features + answer.rejected, classifier.getNumberOfFeatures());
    }
}

TEST(Classifier, EveryCriterionRanksByItself)
{
  HistogramClassifier classifier(shapes());
  for (const auto criterion : allCriteria()) {
    classifier.setCriterion(criterion);
    int right = 0;
    for (const auto& name : shapeNames()) {
      const auto answer = classifier.classify(sampleShape(*shapeByName(name), 2000, 20));
      right += answer.ranking.front().label == name;
      double posterior = 0;
      for (std::size_t i = 0; i < answer.ranking.size(); ++i) {
        posterior += answer.ranking[i].posterior;
        const double previous = answer.ranking[i > 0 ? i - 1 : 0].score;
        EXPECT_TRUE(smallerIsBetter(criterion) ? previous <= answer.ranking[i].score
                                               : previous >= answer.ranking[i].score);
      }
      EXPECT_NEAR(posterior, 1, 1e-9);
      EXPECT_DOUBLE_EQ(answer.margin, std::abs(answer.ranking[0].score - answer.ranking[1].score));
    }
    EXPECT_GE(right, 11) << criterionName(criterion);
  }
}

TEST(Classifier, SizeTellsEqualShapesApartUnlessNormalised)
{
  ModelDatabase database;
  HistogramModelTrainer trainer;
  const auto ball = sampleShape(Shape::sphere(0.1), 3000, 1);
  const auto can = sampleShape(Shape::cylinder(0.1, 0.3), 3000, 1);
  database.add(trainer.train("small ball", ball));
  database.add(trainer.train("large ball", scaled(ball, 4)));
  database.add(trainer.train("can", can));
  HistogramClassifier classifier(database);
  EXPECT_EQ(classifier.classify(ball).best()->label, "small ball");
  EXPECT_EQ(classifier.classify(scaled(ball, 4)).best()->label, "large ball");
  classifier.setScaleNormalized(true);
  // Whatever the size of the query: a ball, and exactly as likely the one as the other.
  for (const float factor : {0.01f, 1.f, 300.f}) {
    const auto answer = classifier.classify(scaled(ball, factor));
    EXPECT_NE(answer.best()->label, "can");
    EXPECT_NEAR(answer.ranking[0].score, answer.ranking[1].score, 0.01);
    EXPECT_EQ(classifier.classify(scaled(can, factor)).best()->label, "can");
  }
}

TEST(Classifier, UnknownThreshold)
{
  ModelDatabase database;
  HistogramModelTrainer trainer;
  database.add(trainer.train("ball", sampleShape(Shape::sphere(0.1), 3000, 1)));
  database.add(trainer.train("can", sampleShape(Shape::cylinder(0.1, 0.3), 3000, 1)));
  HistogramClassifier classifier(database);
  const auto ball = sampleShape(Shape::sphere(0.1), 3000, 2);
  const auto cup = sampleShape(*shapeByName("cup"), 3000, 2);
  EXPECT_FALSE(classifier.classify(cup).unknown); // without a threshold the nearest model is named
  classifier.setUnknownThreshold(0.3);
  EXPECT_FALSE(classifier.classify(ball).unknown);
  EXPECT_TRUE(classifier.classify(cup).unknown);
  EXPECT_EQ(classifier.classify(cup).best(), nullptr);
  EXPECT_EQ(classifier.classify(cup).ranking.size(), 2u); // the ranking is still told
  // A plane's pairs all fall into a few bins that are full in a box: more typical than the box.
  ModelDatabase boxes;
  boxes.add(trainer.train("box", sampleShape(*shapeByName("box"), 3000, 1)));
  HistogramClassifier box_classifier(boxes);
  box_classifier.setUnknownThreshold(0.3);
  const auto plane = sampleShape(Shape::plane(0.1, 0.1), 3000, 2);
  EXPECT_LT(box_classifier.classify(plane).ranking[0].surprise, -0.3);
  EXPECT_TRUE(box_classifier.classify(plane).unknown);
  EXPECT_FALSE(box_classifier.classify(sampleShape(*shapeByName("box"), 3000, 2)).unknown);
  for (const auto criterion : {Criterion::Intersection, Criterion::ChiSquared2}) {
    classifier.setCriterion(criterion);
    const double good = classifier.classify(ball).ranking[0].score;
    const double bad = classifier.classify(cup).ranking[0].score;
    classifier.setUnknownThreshold((good + bad) / 2);
    EXPECT_FALSE(classifier.classify(ball).unknown);
    EXPECT_TRUE(classifier.classify(cup).unknown);
  }
}

TEST(Classifier, BestMemberAnswersForItsModel)
{
  ModelDatabase database;
  HistogramModelTrainer trainer;
  auto both = trainer.train("thing", sampleShape(Shape::sphere(0.1), 3000, 1));
  both.members.push_back(
      trainer.train("x", sampleShape(Shape::torus(0.07, 0.03), 3000, 1)).members[0]);
  database.add(both);
  database.add(trainer.train("can", sampleShape(Shape::cylinder(0.05, 0.17), 3000, 1)));
  HistogramClassifier classifier(database);
  const auto ball = classifier.classify(sampleShape(Shape::sphere(0.1), 2000, 9));
  EXPECT_EQ(ball.best()->label, "thing");
  EXPECT_EQ(ball.best()->member, 0u);
  const auto ring = classifier.classify(sampleShape(Shape::torus(0.07, 0.03), 2000, 9));
  EXPECT_EQ(ring.best()->label, "thing");
  EXPECT_EQ(ring.best()->member, 1u);
}

TEST(Classifier, SameSeedSameAnswerForAnyNumberOfThreads)
{
  std::vector<SurfletSet> queries;
  for (const auto& name : shapeNames())
    queries.push_back(sampleShape(*shapeByName(name), 700, 33));
  HistogramClassifier classifier(shapes());
  classifier.setNumberOfThreads(1);
  const auto one = classifier.classifyBatch(queries);
  classifier.setNumberOfThreads(4);
  const auto four = classifier.classifyBatch(queries);
  for (std::size_t i = 0; i < queries.size(); ++i)
    for (std::size_t k = 0; k < one[i].ranking.size(); ++k) {
      EXPECT_EQ(one[i].ranking[k].label, four[i].ranking[k].label);
      EXPECT_EQ(one[i].ranking[k].score, four[i].ranking[k].score);
    }
}

TEST(Classifier, HopelessQueriesAreUnknown)
{
  HistogramClassifier classifier(shapes());
  SurfletSet query;
  EXPECT_TRUE(classifier.classify(query).unknown);
  EXPECT_TRUE(classifier.classify(query).ranking.empty());
  query.push_back({0, 0, 0, 0, 0, 1});
  EXPECT_TRUE(classifier.classify(query).unknown);
  query.push_back({0, 0, 0, 0, 0, 1});
  const auto coincident = classifier.classify(query);
  EXPECT_TRUE(coincident.unknown);
  EXPECT_EQ(coincident.rejected, classifier.getNumberOfFeatures());
  query.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 0, 1});
  EXPECT_TRUE(classifier.classify(query).unknown);
  EXPECT_THROW(HistogramClassifier{ModelDatabase{}}, DatabaseError);
}
