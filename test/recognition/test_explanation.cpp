// Interpretation by explanation as a whole.
#include "explanation_pieces.h"
#include "scene_pieces.h"

#include "pcl_surflet/core/instruction_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

bool
isFound(const PlacedItem& item, const std::vector<Detection>& detections)
{
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& d) {
    return d.label == item.label &&
           std::hypot(d.centroid[0] - item.centroid[0], d.centroid[1] - item.centroid[1],
                      d.centroid[2] - item.centroid[2]) < 0.03; // a glass loses its stem
  });
}

} // namespace

TEST(InterpretationByExplanation, TellsTouchingThingsApart)
{
  auto o = options();
  o.spacing = Spacing::Pile;
  const auto scene = generateScene({things()[0], things()[2], things()[3]}, {}, o);
  const auto found = interpretByExplanation(reduced(scene.surflets), models(4), quick());
  EXPECT_EQ(found.detections.size(), 3u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
}

TEST(InterpretationByExplanation, TheBackgroundMayBeUnknown)
{
  auto o = options(Background::Plane);
  o.size = 1.2;
  const auto scene = generateScene({things()[0], things()[2]}, {}, o);
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  EXPECT_EQ(found.detections.size(), 2u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
}

TEST(InterpretationByExplanation, CanBeCancelled)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  for (const unsigned threads : {1u, 3u}) {
    auto p = quick();
    p.steps.threads = threads;
    double last = 0;
    p.steps.progress = [&](double share) {
      EXPECT_GE(share, last);
      last = share;
      return share < 0.3;
    };
    const auto found = interpretByExplanation(reduced(scene.surflets), models(), p);
    EXPECT_TRUE(found.diagnostics.cancelled);
    EXPECT_TRUE(found.detections.empty());
    // Of several threads, the calling one may come to nothing before the scan ends.
    EXPECT_LT(last, threads == 1 ? 0.32 : 0.501) << "it stops at once";
  }
}

TEST(InterpretationByExplanation, FindsEveryThingOnce)
{
  const auto scene = generateScene({things()[0], things()[1], things()[2]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  EXPECT_EQ(found.detections.size(), 3u);
  std::vector<char> used(reduced(scene.surflets).size(), 0);
  for (const auto& d : found.detections) {
    EXPECT_GE(d.fit, quick().min_fit);
    for (const auto i : d.cells)
      EXPECT_FALSE(used[i]++) << "no cell belongs to two objects";
  }
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
}

TEST(InterpretationByExplanation, TellsWhatBecameOfEveryModel)
{
  const auto scene = generateScene({things()[0]}, {things()[3]}, [] {
    auto o = options(Background::Plane);
    o.clutter = 1;
    return o;
  }());
  auto p = quick();
  p.steps.background = BackgroundTreatment::Model;
  const auto cells = reduced(scene.surflets);
  const auto d = interpretByExplanation(cells, models(3, true), p).diagnostics;
  EXPECT_GT(d.background_cells, cells.size() / 2);
  EXPECT_LT(d.background_cells, cells.size());
  ASSERT_EQ(d.models.size(), 4u);
  std::size_t unfit = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& m = d.models[k];
    EXPECT_GT(m.places, 0u);
    EXPECT_EQ(m.explanations, m.died_fit + m.lost + m.detections) << m.label;
    EXPECT_EQ(m.detections, k == 0 ? 1u : 0u) << m.label;
    unfit += m.died_fit;
  }
  EXPECT_GT(unfit, 0u) << "the die resembles something a little";
  EXPECT_GT(d.models[0].promising, 0u);
  EXPECT_EQ(d.models[3].places, 0u) << "a background is not looked for";
}

TEST(InterpretationByExplanation, FindsTwoInstancesOfOneObject)
{
  const auto scene = generateScene({things()[0], things()[0]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  EXPECT_EQ(found.detections.size(), 2u);
  EXPECT_EQ(found.detections.size(), 2u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections));
}

TEST(InterpretationByExplanation, AnUnknownObjectStaysUnnamed)
{
  const auto scene = generateScene({things()[0]}, {things()[3]}, [] {
    auto o = options();
    o.clutter = 1;
    return o;
  }());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(), quick());
  ASSERT_EQ(found.detections.size(), 1u);
  EXPECT_TRUE(isFound(scene.items[0], found.detections));
}

TEST(InterpretationByExplanation, ModelsTheBackground)
{
  auto p = quick();
  p.steps.background = BackgroundTreatment::Model;
  const auto o = options(Background::Plane);
  const auto scene = generateScene({things()[0], things()[2]}, {}, o);
  const auto found = interpretByExplanation(reduced(scene.surflets), models(3, true), p);
  EXPECT_EQ(found.detections.size(), 2u);
  for (const auto& item : scene.items)
    EXPECT_TRUE(isFound(item, found.detections)) << item.label;
  const auto empty = interpretByExplanation(reduced(emptyBackground(o)), models(3, true), p);
  EXPECT_TRUE(empty.detections.empty());
  EXPECT_THROW(interpretByExplanation({}, models(), p), DatabaseError);
}

TEST(InterpretationByExplanation, ADatabaseOfOneModelHasNoRival)
{
  const auto scene = generateScene({things()[0]}, {}, options());
  const auto found = interpretByExplanation(reduced(scene.surflets), models(1), quick());
  ASSERT_EQ(found.detections.size(), 1u);
  EXPECT_TRUE(isFound(scene.items[0], found.detections));
}

TEST(InterpretationByExplanation, NothingIsFoundInNothingOrAtAnotherMagnitude)
{
  EXPECT_TRUE(interpretByExplanation({}, models(), quick()).detections.empty());
  const auto scene = generateScene({things()[0], things()[2]}, {}, options());
  const auto cells = reduced(scene.surflets);
  for (const float factor : {0.001f, 1000.f})
    EXPECT_TRUE(interpretByExplanation(scaled(cells, factor), models(), quick()).detections.empty())
        << factor;
}

TEST(InterpretationByExplanation, InstructionsDoNotMatter)
{
  const auto scene = generateScene({things()[0], things()[1]}, {}, options());
  const auto cells = reduced(scene.surflets);
  const auto usual = interpretByExplanation(cells, trainModels(), quick());
  ASSERT_FALSE(usual.detections.empty());
  for (const auto set : {InstructionSet::Scalar, InstructionSet::Baseline, InstructionSet::Avx2}) {
    if (!selectInstructionSet(set))
      continue;
    const auto found = interpretByExplanation(cells, trainModels(), quick());
    ASSERT_EQ(found.detections.size(), usual.detections.size());
    for (std::size_t i = 0; i < usual.detections.size(); ++i) {
      EXPECT_EQ(found.detections[i].cells, usual.detections[i].cells);
      EXPECT_EQ(found.detections[i].fit, usual.detections[i].fit);
    }
  }
  selectInstructionSet(InstructionSet::Automatic);
}

TEST(InterpretationByExplanation, ThreadsDoNotMatter)
{
  const auto scene = generateScene({things()[0], things()[1]}, {}, options());
  const auto cells = reduced(scene.surflets);
  auto p = quick();
  p.steps.threads = 1;
  const auto one = interpretByExplanation(cells, models(), p);
  p.steps.threads = 3;
  const auto three = interpretByExplanation(cells, models(), p);
  ASSERT_FALSE(one.detections.empty());
  ASSERT_EQ(one.detections.size(), three.detections.size());
  for (std::size_t i = 0; i < one.detections.size(); ++i) {
    EXPECT_EQ(one.detections[i].label, three.detections[i].label);
    EXPECT_EQ(one.detections[i].cells, three.detections[i].cells);
    EXPECT_EQ(one.detections[i].fit, three.detections[i].fit);
  }
}

TEST(InterpretationByExplanation, MisuseIsRefused)
{
  const auto refused = [](auto change) {
    ExplanationParameters bad;
    change(bad);
    EXPECT_THROW(interpretByExplanation({}, models(1), bad), std::invalid_argument);
  };
  refused([](auto& b) { b.steps.pairs = 0; });
  refused([](auto& b) { b.reach = 0.9; });
  refused([](auto& b) { b.rounds = 0; });
  refused([](auto& b) { b.settling_cells = 2; });
  refused([](auto& b) { b.scan_cells = 5000; });
  refused([](auto& b) { b.place_spacing = 0; });
  refused([](auto& b) { b.recentrings = 0; });
  refused([](auto& b) { b.probes = 0; });
  refused([](auto& b) { b.features = 0; });
  refused([](auto& b) { b.leaf = NAN; });
  refused([](auto& b) { b.junk_fit = 2; });
  refused([](auto& b) { b.strong_fit = NAN; });
  refused([](auto& b) { b.uniform_vote_share = 0; });
  refused([](auto& b) { b.uniform_vote_radius = INFINITY; });
  refused([](auto& b) { b.min_fit = -1; });
  refused([](auto& b) { b.vote_pairs = 0; });
  refused([](auto& b) { b.vote_share = 0; });
  refused([](auto& b) { b.vote_radius = 0; });
}
