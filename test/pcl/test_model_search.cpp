#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/model_search.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/recognition/retrieval_figures.h"

#include <gtest/gtest.h>

using namespace pcl_surflet;

namespace {

/** \brief Cylinders, boxes and ellipsoids of many proportions: neighbours differ by little. */
SurfletSet
shapeNumber(int i, std::uint64_t seed)
{
  const double f = 0.05 + 0.01 * (i / 3);
  const auto shape = i % 3 == 0   ? Shape::cylinder(f, 0.3)
                     : i % 3 == 1 ? Shape::box(f, 0.1, 0.3)
                                  : Shape::ellipsoid(f, 0.1, 0.25);
  return sampleShape(shape, 600, seed);
}

HistogramModel
modelNumber(int i)
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(20000);
  return trainer.train("shape " + std::to_string(i), shapeNumber(i, 1));
}

constexpr int kModels = 90;

ModelSearch
filledSearch()
{
  ModelSearch search{Resolution{}};
  for (int i = 0; i < kModels; ++i)
    search.add(modelNumber(i));
  return search;
}

} // namespace

TEST(ModelSearch, TheShortlistHoldsWhatTheWholeCollectionHas)
{
  auto search = filledSearch();
  ASSERT_EQ(search.size(), std::size_t{kModels});
  search.setShortlist(20);
  int near = 0;
  for (int i = 0; i < kModels; i += 2) {
    const auto query = shapeNumber(i, 99);
    const auto some = search.search(query, 3), all = search.searchAll(query, 3);
    ASSERT_EQ(some.size(), 3u);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(some[0].label, all[0].label);
    EXPECT_EQ(some[0].score, all[0].score);
    EXPECT_GE(all[0].score, all[1].score);
    near +=
        std::abs(static_cast<int>(all[0].model) - i) <= 3 && all[0].model % 3 == std::size_t(i % 3);
  }
  EXPECT_GE(near, 43) << "the shape itself or the next of its kind, for 45 queries";
  EXPECT_EQ(search.searchAll(shapeNumber(0, 99), 1000).size(), std::size_t{kModels});
  EXPECT_EQ(search.search(shapeNumber(0, 99), 1000).size(), 20u);
}

TEST(ModelSearch, AddedModelsAreFoundAtAnySizeOfTheQuery)
{
  auto search = filledSearch();
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(20000);
  const auto cup = *shapeByName("cup");
  EXPECT_NE(search.search(sampleShape(cup, 900, 3), 1)[0].label, "cup");
  search.add(trainer.train("cup", sampleShape(cup, 900, 1)));
  auto query = sampleShape(cup, 900, 3);
  for (auto* column : {&query.x, &query.y, &query.z})
    for (float& c : *column)
      c *= 37;
  const auto hits = search.search(query, 2);
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0].label, "cup");
  EXPECT_EQ(hits[0].model, std::size_t{kModels});
}

TEST(ModelSearch, ModelsAnswerWithTheirBestMemberOnce)
{
  auto thing = modelNumber(0);
  thing.members.push_back(modelNumber(2).members.front());
  ModelSearch search{Resolution{}};
  search.add(thing);
  search.add(modelNumber(1));
  const auto hits = search.search(modelNumber(2).members.front().histogram, 5);
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0].model, 0u);
  EXPECT_EQ(hits[1].model, 1u);
}

TEST(ModelSearch, SameModelsSameAnswers)
{
  const auto a = filledSearch(), b = filledSearch();
  for (int i = 0; i < kModels; i += 7) {
    const auto x = a.search(shapeNumber(i, 5), 4), y = b.search(shapeNumber(i, 5), 4);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_EQ(x[k].model, y[k].model);
      EXPECT_EQ(x[k].score, y[k].score);
    }
  }
}

TEST(ModelSearch, MisuseAndEmptyQueries)
{
  ModelSearch search{Resolution{}};
  EXPECT_TRUE(search.search(shapeNumber(0, 1), 3).empty()) << "no models";
  search.add(modelNumber(0));
  EXPECT_TRUE(search.search(SurfletSet{}, 3).empty());
  EXPECT_TRUE(search.searchAll(SurfletSet{}, 3).empty());
  EXPECT_TRUE(search.search(std::vector<float>(625, 0), 3).empty());
  EXPECT_THROW(search.search(std::vector<float>(3, 0), 3), std::invalid_argument);
  EXPECT_THROW(search.setShortlist(0), std::invalid_argument);
  EXPECT_THROW(search.setChecks(0), std::invalid_argument);
  EXPECT_THROW(ModelSearch({0, 1, 1, 1}), std::invalid_argument);
  HistogramModelTrainer other;
  other.setResolution({3, 3, 3, 3});
  EXPECT_THROW(search.add(other.train("x", shapeNumber(0, 1))), DatabaseError);
  EXPECT_THROW(search.add(HistogramModel{}), DatabaseError);
}

TEST(RetrievalFigures, AreThoseOfAHandMadeRanking)
{
  // Two of class a and two others; the class has 3 members, so the first tier is two hits long.
  const auto figures = retrievalFigures(
      {"a", "b", "c"}, {{"a", "b", "x", "a"}, {"a", "b", "a", "x"}, {"a"}}, {3, 2, 1});
  EXPECT_EQ(figures.queries, 2u) << "c is alone";
  EXPECT_DOUBLE_EQ(figures.nearest_neighbour, 0.5);
  EXPECT_DOUBLE_EQ(figures.first_tier, (0.5 + 0) / 2);
  EXPECT_DOUBLE_EQ(figures.second_tier, (1.0 + 1.0) / 2);
  EXPECT_DOUBLE_EQ(figures.precision[0], (1.0 + 0.5) / 2);
  EXPECT_DOUBLE_EQ(figures.precision[4], (1.0 + 0.5) / 2) << "half of class a: its first hit";
  EXPECT_DOUBLE_EQ(figures.precision[9], (0.5 + 0.5) / 2);
  EXPECT_THROW(retrievalFigures({"a"}, {}, {1}), std::invalid_argument);
  EXPECT_EQ(retrievalFigures({}, {}, {}).queries, 0u);
}
