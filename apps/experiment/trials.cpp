#include "experiment/trials.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

bool
anyEstimates(const Recognisers& recognisers)
{
  return std::any_of(recognisers.begin(), recognisers.end(),
                     [](const auto& r) { return r->normals() == Normals::Estimated; });
}

/** \brief Answers of all recognisers to one test; empty if no condition could be drawn. */
std::vector<Answer>
answersTo(const ExperimentObject& object, const Setting& setting, std::uint64_t seed,
          const Recognisers& recognisers, bool estimate)
{
  const auto condition = setting.condition(seed);
  if (!condition)
    return {};
  const Query query = makeQuery(object, *condition, seed, estimate);
  std::vector<Answer> answers(recognisers.size());
  for (std::size_t k = 0; k < recognisers.size(); ++k) {
    // Not always the same one first: it finds the caches cold, and its time would suffer.
    const std::size_t r = (k + seed) % recognisers.size();
    answers[r] = recognisers[r]->classify(query.with(recognisers[r]->normals()));
  }
  return answers;
}

} // namespace

Setting
fixedSetting(const std::string& name, double x, const Condition& condition)
{
  return {"", x, name, [condition](std::uint64_t) { return condition; }};
}

Tally::Tally(std::size_t objects)
    : confusion(objects, std::vector<std::uint64_t>(objects, 0)), tests_of(objects, 0)
{
}

void
Tally::add(std::size_t object, const Answer& answer)
{
  ++tests;
  ++tests_of[object];
  failed += answer.failed;
  seconds += answer.seconds;
  if (answer.object >= confusion.size())
    return;
  ++confusion[object][answer.object];
  right += answer.object == object;
}

void
Tally::add(const Tally& other)
{
  for (std::size_t o = 0; o < confusion.size(); ++o) {
    tests_of[o] += other.tests_of[o];
    for (std::size_t a = 0; a < confusion.size(); ++a)
      confusion[o][a] += other.confusion[o][a];
  }
  tests += other.tests;
  right += other.right;
  failed += other.failed;
  seconds += other.seconds;
}

std::pair<double, double>
confidenceInterval(std::uint64_t right, std::uint64_t tests)
{
  if (tests == 0)
    return {0, 1};
  constexpr double z = 1.959964;
  const double n = static_cast<double>(tests), p = static_cast<double>(right) / n;
  const double centre = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Tallies
runTrials(const std::vector<ExperimentObject>& objects, const Recognisers& recognisers,
          const TrialPlan& plan, const ProgressFunction& progress,
          const std::function<void(const Tallies&)>& keep)
{
  const bool estimate = anyEstimates(recognisers);
  Tallies tallies;
  for (std::size_t s = 0; s < plan.settings.size(); ++s) {
    progress(s, plan.settings[s].name);
    std::vector<std::vector<Answer>> answers(objects.size() * plan.tests);
    parallelFor(answers.size(), plan.threads, [&](std::size_t i, unsigned) {
      const std::size_t o = i / plan.tests, t = i % plan.tests;
      answers[i] = answersTo(objects[o], plan.settings[s],
                             querySeed(plan.seed, plan.first + s, o, t), recognisers, estimate);
    });
    tallies.emplace_back(recognisers.size(), Tally(objects.size()));
    for (std::size_t i = 0; i < answers.size(); ++i)
      for (std::size_t r = 0; r < answers[i].size(); ++r)
        tallies.back()[r].add(i / plan.tests, answers[i][r]);
    if (keep)
      keep(tallies);
  }
  return tallies;
}

} // namespace apps
} // namespace pcl_surflet
