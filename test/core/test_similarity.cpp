#include "pcl_surflet/core/similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace pcl_surflet;

namespace {
const Histogram kH = {0.5, 0.25, 0.25}, kQ = {0.25, 0.75, 0};
} // namespace

TEST(Similarity, HandComputedValues)
{
  EXPECT_DOUBLE_EQ(squaredEuclidean(kH, kQ), 0.0625 + 0.25 + 0.0625);
  EXPECT_DOUBLE_EQ(intersection(kH, kQ), 0.25 + 0.25);
  EXPECT_DOUBLE_EQ(chiSquared1(kH, kQ), 0.0625 / 0.5 + 0.25 / 0.25 + 0.0625 / 0.25);
  EXPECT_DOUBLE_EQ(chiSquared2(kH, kQ), 0.0625 / 0.75 + 0.25 / 1.0 + 0.0625 / 0.25);
  EXPECT_DOUBLE_EQ(kullbackLeibler(kH, kQ, 0.01),
                   -0.25 * std::log(0.5) + 0.5 * std::log(3.0) + 0.25 * std::log(25.0));
  EXPECT_DOUBLE_EQ(meanLogLikelihood({std::log(0.5), std::log(0.25), std::log(0.25)}, kQ),
                   0.25 * std::log(0.5) + 0.75 * std::log(0.25));
}

TEST(Similarity, BestWhereHistogramsAreEqual)
{
  EXPECT_EQ(squaredEuclidean(kH, kH), 0);
  EXPECT_EQ(chiSquared1(kH, kH), 0);
  EXPECT_EQ(chiSquared2(kH, kH), 0);
  EXPECT_EQ(kullbackLeibler(kH, kH, 0.01), 0);
  EXPECT_EQ(intersection(kH, kH), 1);
  EXPECT_EQ(chiSquared2({0, 1}, {0, 1}), 0); // 0/0 := 0
}

TEST(Similarity, NamesGoBothWays)
{
  EXPECT_EQ(allCriteria().size(), 7u);
  for (const auto c : allCriteria())
    EXPECT_EQ(criterionByName(criterionName(c)), c);
  EXPECT_FALSE(criterionByName("euclid"));
  EXPECT_FALSE(smallerIsBetter(Criterion::Likelihood));
  EXPECT_FALSE(smallerIsBetter(Criterion::Intersection));
  EXPECT_TRUE(smallerIsBetter(Criterion::NormalizedLikelihood));
}

TEST(Penalty, ZeroBinsBecomeTheMinimumAndTheSumStaysOne)
{
  const Histogram h = {0, 0.25, 0, 0.75};
  const auto p = penalize(h, 0.01);
  EXPECT_DOUBLE_EQ(p[0], 0.01);
  EXPECT_DOUBLE_EQ(p[1], 0.25 * (1 - 2 * 0.01)); // Eq. 3.22, eta = 2
  EXPECT_DOUBLE_EQ(p[3], 0.75 * (1 - 2 * 0.01));
  EXPECT_DOUBLE_EQ(std::accumulate(p.begin(), p.end(), 0.0), 1);
}

TEST(Penalty, AbsoluteFloorRaisesRareBinsToo)
{
  const auto p = penalize({0, 0.001, 0.999}, 0.01);
  EXPECT_DOUBLE_EQ(p[0], 0.01);
  EXPECT_DOUBLE_EQ(p[1], 0.01);
  EXPECT_DOUBLE_EQ(std::accumulate(p.begin(), p.end(), 0.0), 1);
}

TEST(Penalty, RefusesValuesThatLeaveNothing)
{
  EXPECT_THROW(penalize(kH, 0), std::invalid_argument);
  EXPECT_THROW(penalize(kH, -1), std::invalid_argument);
  EXPECT_THROW(penalize(kH, 0.34), std::invalid_argument);
  EXPECT_THROW(penalize(kH, std::nan("")), std::invalid_argument);
}

TEST(Penalty, SmallestPositiveBin)
{
  EXPECT_EQ(smallestPositive({0, 0.2, 0.1}), 0.1);
  EXPECT_EQ(smallestPositive({0, 0}), 0);
}
