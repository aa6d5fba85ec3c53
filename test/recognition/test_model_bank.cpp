#include "pcl_surflet/recognition/model_bank.h"
#include "recognition/histogram_clusters.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pcl_surflet;

namespace {

std::string
errorOf(const std::string& text)
{
  try {
    ModelBank::parse(text);
  }
  catch (const ModelBankError& e) {
    return e.what();
  }
  return "no error";
}

/** \brief A histogram of two bins with these counts. */
PairHistogram
twoBins(std::uint64_t first, std::uint64_t second)
{
  PairHistogram h({1, 1, 1, 2});
  h.counts = {first, second};
  h.features = first + second;
  return h;
}

} // namespace

TEST(ModelBank, TextIsReadAndWritten)
{
  const auto bank = ModelBank::parse("# what our scanner does\n"
                                     "normals 2.5\n"
                                     "\n"
                                     "noise 1.5   # percent\n"
                                     "  visible 40 members 6\n"
                                     "members 3 visible 50 noise 4\n"
                                     "view noise 0.3 members 2");
  EXPECT_EQ(bank.normal_radius, 2.5);
  ASSERT_EQ(bank.conditions.size(), 4u);
  EXPECT_EQ(bank.members(), 13u);
  EXPECT_DOUBLE_EQ(bank.conditions[0].noise, 0.015);
  EXPECT_EQ(bank.conditions[0].members, 1u);
  EXPECT_DOUBLE_EQ(bank.conditions[1].visible, 0.4);
  EXPECT_TRUE(bank.conditions[3].view);
  EXPECT_EQ(bank.conditions[0].name(0, 1), "noise 1.5 %");
  EXPECT_EQ(bank.conditions[1].name(1, 6), "visible 40 % (2 of 6)");
  EXPECT_EQ(bank.conditions[2].name(0, 1), "noise 4 %, visible 50 %");
  EXPECT_EQ(bank.conditions[3].name(0, 2), "view, noise 0.3 % (1 of 2)");
  const auto again = ModelBank::parse(bank.toText());
  EXPECT_EQ(again.toText(), bank.toText());
  EXPECT_EQ(again.members(), 13u);
}

TEST(ModelBank, TheDefaultFitsIntoAFileOfHundredKilobytesAModel)
{
  const auto bank = ModelBank::standard();
  EXPECT_LE(bank.members() * (625 * sizeof(float) + 256), 100000u);
  EXPECT_EQ(ModelBank::none().members(), 1u);
}

TEST(ModelBank, BadLinesAreNamedWithARemedy)
{
  const auto expect = [](const std::string& text, const std::vector<std::string>& words) {
    const auto error = errorOf(text);
    for (const auto& word : words)
      EXPECT_NE(error.find(word), std::string::npos) << "'" << word << "' not in: " << error;
  };
  expect("noise 1\n\nnose 2\n", {"line 3", "'nose'", "none of noise, visible"});
  expect("noise\n", {"line 1", "'noise' needs a number from 0 to 50"});
  expect("noise x", {"line 1", "not 'x'", "percent"});
  expect("noise 1%", {"line 1", "not '1%'"});
  expect("noise 51", {"line 1", "to 50"});
  expect("noise nan", {"line 1", "noise"});
  expect("noise 1\nvisible 0", {"line 2", "from 1 to 100"});
  expect("visible 40 members 0", {"line 1", "'members'", "from 1 to 64"});
  expect("visible 40 members 2.5", {"line 1", "whole number"});
  expect("members 3", {"line 1", "changes nothing", "remove the line"});
  expect("visible 100", {"line 1", "changes nothing"});
  expect("normals 0", {"line 1", "'normals'", "as in 3"});
  expect("normals 3 noise 1", {"line 1", "'noise'"});
}

TEST(HistogramClusters, LikeGoesWithLikeFullestGroupFirst)
{
  const std::vector<PairHistogram> all = {twoBins(90, 10), twoBins(10, 90), twoBins(12, 88),
                                          twoBins(0, 0),   twoBins(91, 9),  twoBins(11, 89)};
  const auto groups = groupHistograms(all, 2);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].parts, (std::vector<std::size_t>{1, 2, 5}));
  EXPECT_EQ(groups[1].parts, (std::vector<std::size_t>{0, 4}));
  EXPECT_EQ(groups[0].sum.features, 300u);
  EXPECT_EQ(groups[0].sum.counts[0], 33u);
  EXPECT_EQ(groupHistograms({twoBins(1, 1), twoBins(2, 2)}, 5).size(), 1u) << "the same shares";
  EXPECT_TRUE(groupHistograms({twoBins(0, 0)}, 2).empty());
}

TEST(HistogramClusters, SamplesAreComparedWithWhatTheyAreNoPartOf)
{
  const std::vector<PairHistogram> all = {twoBins(50, 50), twoBins(50, 50), twoBins(100, 0)};
  const auto groups = groupHistograms(all, 1);
  const auto misfits = leftOutMisfits(all, all, groups, 1e-5);
  ASSERT_EQ(misfits.size(), 3u);
  EXPECT_NEAR(misfits[0], 0.5 * std::log(0.5 / 0.75) + 0.5 * std::log(0.5 / 0.25), 1e-9);
  EXPECT_NEAR(misfits[2], std::log(2.0), 1e-9) << "left out, only halves remain";
  EXPECT_TRUE(leftOutMisfits({all[0]}, {all[0]}, groupHistograms({all[0]}, 1), 1e-5).empty());
}
