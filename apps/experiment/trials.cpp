#include "experiment/trials.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/depth_buffer.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/sensed_surface.h"

#include <algorithm>
#include <cmath>

#include <time.h>

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

/** \brief A mesh as a sensor far up the z axis sees it: the foremost height in every pixel. */
class DepthPicture {
public:
  DepthPicture(const SurfletSet& vertices, const std::vector<TriangleMesh::Triangle>& triangles)
      : heights_(kPixels, kPixels)
  {
    const auto [left, right] = std::minmax_element(vertices.x.begin(), vertices.x.end());
    const auto [low, high] = std::minmax_element(vertices.y.begin(), vertices.y.end());
    left_ = *left;
    low_ = *low;
    pixel_ = std::max<double>(*right - *left, *high - *low) / (kPixels - 2);
    for (const auto& t : triangles)
      heights_.draw({inPixels(vertices[t[0]]), inPixels(vertices[t[1]]), inPixels(vertices[t[2]])},
                    0);
  }

  bool
  shows(const Surflet& s) const
  {
    constexpr double kGrazing = 0.05, kSteepest = 0.15;
    if (s.nz < kGrazing)
      return false;
    const auto [x, y, height] = inPixels(s);
    const auto column = std::clamp(std::lround(x), 0L, kPixels - 1L);
    const auto row = std::clamp(std::lround(y), 0L, kPixels - 1L);
    // The pixel's middle may lie higher up the slope than the surflet.
    return heights_.nearness(static_cast<std::size_t>(column), static_cast<std::size_t>(row)) -
               height <=
           2 * pixel_ / std::max<double>(s.nz, kSteepest);
  }

private:
  static constexpr long kPixels = 512;

  DepthBuffer::Corner
  inPixels(const Surflet& s) const
  {
    return {(s.x - left_) / pixel_, (s.y - low_) / pixel_, s.z};
  }

  double left_ = 0, low_ = 0, pixel_ = 1;
  DepthBuffer heights_;
};

/** \brief What a sensor on the z axis sees of \p sample, a sample of \p mesh before it was turned
 * with \p turn_seed. Normals point to the sensor: it knows no others, and its noise lies there. */
SurfletSet
seenFromAbove(const SurfletSet& sample, const TriangleMesh& mesh, std::uint64_t turn_seed)
{
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  const DepthPicture picture(randomlyRotated(vertices, turn_seed), mesh.triangles);
  SurfletSet seen;
  for (std::size_t i = 0; i < sample.size(); ++i)
    if (const Surflet s = sample[i]; picture.shows(s))
      seen.push_back({s.x, s.y, s.z, 0, 0, 1});
  return seen;
}

} // namespace

double
threadSeconds()
{
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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

Query
makeQuery(const ExperimentObject& object, const Condition& condition, std::uint64_t seed,
          bool estimate)
{
  const bool whole = condition.stretch == std::array<double, 3>{1, 1, 1};
  const TriangleMesh other =
      whole ? TriangleMesh() : stretched(object.mesh, object.axes, condition.stretch);
  const TriangleMesh& mesh = whole ? object.mesh : other;
  const auto target = static_cast<std::size_t>(std::lround(
      static_cast<double>(kSamplingSize) * condition.resolution * condition.resolution));
  const bool sensed = condition.noise > 0 || condition.view;
  Query query;
  query.sampled = randomlyRotated(sampleIsoMesh(mesh, target, seed), mix64(seed));
  if (condition.view)
    query.sampled = seenFromAbove(query.sampled, mesh, mix64(seed));
  if (condition.noise > 0)
    query.sampled = displacedAlongNormals(query.sampled, condition.noise, mix64(seed + 1));
  if (condition.visible < 1)
    query.sampled = cutByRandomPlane(query.sampled, condition.visible, mix64(seed + 2));
  if (!estimate && !sensed)
    return query;
  query.estimated =
      withEstimatedNormals(query.sampled, condition.normal_radius * object.spacing, 1).surflets;
  if (sensed)
    query.sampled = query.estimated;
  return query;
}

std::uint64_t
querySeed(std::uint64_t seed, std::size_t setting, std::size_t object, std::size_t test)
{
  // Seeds of their own: no query is a sampling that a model was trained with.
  return mix64(mix64(mix64(seed) + setting) + object) + test;
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
