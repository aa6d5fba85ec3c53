#include "experiment/classification.h"

#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/sensed_surface.h"

#include <chrono>
#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Radius of the normal estimation in spacings: 2 leave 1 % noise visible in the normals, 4
 * round small details. */
constexpr double kNormalRadius = 3;

struct Answer {
  std::size_t model = 0;
  double seconds = 0;
};

Answer
timedAnswer(const HistogramClassifier& classifier, const SurfletSet& query)
{
  const auto start = std::chrono::steady_clock::now();
  const auto result = classifier.classify(query);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {result.ranking.empty() ? ~std::size_t{0} : result.ranking.front().model, taken.count()};
}

/** \brief Sums up answers that stand in the order object by object. */
ConditionResult
summarize(const Condition& condition, const std::vector<Answer>& answers, std::size_t objects)
{
  ConditionResult result;
  result.condition = condition;
  result.confusion.assign(objects, std::vector<std::uint64_t>(objects, 0));
  result.tests = answers.size();
  const std::size_t tests = answers.size() / objects;
  double seconds = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::size_t object = i / tests;
    seconds += answers[i].seconds;
    if (answers[i].model >= objects)
      continue;
    ++result.confusion[object][answers[i].model];
    result.right += answers[i].model == object;
  }
  result.seconds_per_query = seconds / static_cast<double>(answers.size());
  return result;
}

} // namespace

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

ModelDatabase
trainObjects(const std::vector<ExperimentObject>& objects, const Resolution& resolution,
             std::uint64_t seed, unsigned threads, const ProgressFunction& progress)
{
  HistogramModelTrainer trainer;
  trainer.setResolution(resolution);
  trainer.setSeed(seed);
  trainer.setNumberOfThreads(threads);
  trainer.setMeshSampling(kSamplingSize, 5);
  ModelDatabase database;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    progress(i, "training " + objects[i].label);
    database.add(trainer.train(objects[i].label, objects[i].mesh));
  }
  return database;
}

SurfletSet
makeQuery(const ExperimentObject& object, const Condition& condition, std::uint64_t seed)
{
  SurfletSet query = randomlyRotated(sampleIsoMesh(object.mesh, kSamplingSize, seed), mix64(seed));
  if (condition.noise > 0)
    query = displacedAlongNormals(query, condition.noise, mix64(seed + 1));
  if (condition.visible < 1)
    query = cutByRandomPlane(query, condition.visible, mix64(seed + 2));
  if (condition.noise > 0)
    query = withEstimatedNormals(query, kNormalRadius * object.spacing, 1).surflets;
  return query;
}

std::vector<ConditionResult>
runClassification(const std::vector<ExperimentObject>& objects,
                  const HistogramClassifier& classifier, const ClassificationPlan& plan,
                  const ProgressFunction& progress)
{
  std::vector<ConditionResult> results;
  for (std::size_t c = 0; c < plan.conditions.size(); ++c) {
    std::vector<Answer> answers(objects.size() * plan.tests);
    for (std::size_t o = 0; o < objects.size(); ++o) {
      progress(c * objects.size() + o, plan.conditions[c].name + ": " + objects[o].label);
      parallelFor(plan.tests, plan.threads, [&](std::size_t t, unsigned) {
        // Seeds of their own: no query is a sampling that a model was trained with.
        const auto seed = mix64(mix64(mix64(plan.seed) + c) + o) + t;
        answers[o * plan.tests + t] =
            timedAnswer(classifier, makeQuery(objects[o], plan.conditions[c], seed));
      });
    }
    results.push_back(summarize(plan.conditions[c], answers, objects.size()));
  }
  return results;
}

} // namespace apps
} // namespace pcl_surflet
