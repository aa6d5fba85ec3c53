#include "pcl_surflet/recognition/scene_training.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/parallel.h"

#include "interpretation/support.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace {

using interpretation::Indices;

constexpr std::size_t kOrientations = 4;
constexpr unsigned kRounds = 2;      ///< of histogram and support, each of which needs the other
constexpr unsigned kRegroupings = 4; ///< until the support of a histogram has settled
constexpr unsigned kProbes = 128;
constexpr std::size_t kFewestCells = 30; ///< as an interpretation asks for
constexpr std::uint64_t kMostPairs = 4000000;
constexpr double kLeastProbability = 1e-5; ///< the default penalty of a ModelDatabase

/** \brief Cells of one orientation and those of them that support the model. */
struct Orientation {
  SurfletSet cells;
  Indices support;
};

/** \brief Mean histogram of the supporting cells of all orientations. */
std::vector<float>
meanHistogram(const std::vector<Orientation>& all, const HistogramModel& model, std::uint64_t seed,
              unsigned threads, std::uint64_t& features)
{
  std::vector<double> sum(static_cast<std::size_t>(model.resolution.bins()), 0.0);
  features = 0;
  for (const auto& o : all) {
    const PairSource source(o.cells.subset(o.support));
    const std::uint64_t n = source.size(), pairs = n * (n - 1) / 2;
    const auto counted =
        pairs <= kMostPairs
            ? countAllPairs(source, model.resolution, model.delta_max, threads)
            : countDrawnPairs(source, model.resolution, model.delta_max, kMostPairs, seed, threads);
    const auto h = counted.normalized();
    for (std::size_t b = 0; b < sum.size(); ++b)
      sum[b] += h[b] / static_cast<double>(all.size());
    features += counted.features;
  }
  return {sum.begin(), sum.end()};
}

/** \brief The cells that support each other under the model. */
void
settleSupport(const HistogramModel& model, Orientation& o)
{
  const PairSource source(o.cells);
  interpretation::SceneModels models;
  models.resolution = model.resolution;
  models.all.push_back(
      interpretation::sceneModel(model, std::min(kLeastProbability, 0.5 / model.resolution.bins()),
                                 source.scale(), interpretation::chanceAngles(model.resolution)));
  const interpretation::SceneData scene{o.cells, source, models};
  interpretation::SupportMemory memory;
  std::vector<interpretation::CellSupport> supported;
  Indices all(o.cells.size());
  for (std::uint32_t i = 0; i < all.size(); ++i)
    all[i] = i;
  o.support = all;
  for (unsigned k = 0; k < kRegroupings && o.support.size() >= kFewestCells; ++k) {
    supportOf(scene, models.all[0], all, o.support, kProbes, memory, supported);
    o.support.clear();
    for (const auto& s : supported)
      o.support.push_back(s.cell);
  }
}

std::vector<Orientation>
orientationsOf(const SurfletSet& surflets, double leaf, std::uint64_t seed)
{
  std::vector<Orientation> all(kOrientations);
  for (std::size_t k = 0; k < kOrientations; ++k) {
    all[k].cells = reduceToTwoSidedCells(randomlyRotated(surflets, seed + k), leaf).cells;
    for (std::uint32_t i = 0; i < all[k].cells.size(); ++i)
      all[k].support.push_back(i);
  }
  return all;
}

/** \brief Lets all settle. \return mean number of cells that support the model
 * \throws TrainingError if there are too few in any orientation */
double
settleAll(const HistogramModel& model, const std::string& label, std::vector<Orientation>& all,
          unsigned threads)
{
  parallelFor(all.size(), threads, [&](std::size_t k, unsigned) { settleSupport(model, all[k]); });
  double cells = 0;
  for (const auto& o : all) {
    if (o.support.size() < kFewestCells)
      throw TrainingError("'" + label + "': only " + std::to_string(o.support.size()) + " of " +
                          std::to_string(o.cells.size()) +
                          " cells support a model; take smaller cells");
    cells += static_cast<double>(o.support.size()) / kOrientations;
  }
  return cells;
}

/** \brief Where orientationsOf() turns the middle of the object to. */
void
teach(const CentreLesson& lesson, const std::vector<Orientation>& all, std::uint64_t seed)
{
  SurfletSet centre;
  centre.push_back({static_cast<float>(lesson.centre[0]), static_cast<float>(lesson.centre[1]),
                    static_cast<float>(lesson.centre[2]), 0, 0, 1});
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Surflet turned = randomlyRotated(centre, seed + k)[0];
    lesson.guess->learn(all[k].cells.subset(all[k].support), {turned.x, turned.y, turned.z});
  }
}

} // namespace

HistogramModel
trainForScenes(const HistogramModelTrainer& trainer, const std::string& label,
               const SurfletSet& surflets, double leaf, std::uint64_t seed, unsigned threads)
{
  auto all = orientationsOf(surflets, leaf, seed);
  HistogramModel model = trainer.train(label, all.front().cells);
  model.members.resize(1);
  ModelMember& member = model.members.front();
  member.condition = "complete, cells";
  member.histogram = meanHistogram(all, model, seed, threads, member.features);
  double cells = 0;
  for (unsigned round = 0; round < kRounds; ++round) {
    cells = settleAll(model, label, all, threads);
    member.histogram = meanHistogram(all, model, seed, threads, member.features);
  }
  model.leaf = leaf;
  model.surface_area = member.area = interpretation::areaOfCells(cells, leaf);
  return model;
}

void
addView(HistogramModel& model, const std::string& condition, const SurfletSet& seen, double leaf,
        std::uint64_t seed, unsigned threads, const CentreLesson* lesson)
{
  if (model.members.empty())
    throw std::invalid_argument("pcl_surflet: a view needs a model of the whole object");
  auto all = orientationsOf(seen, leaf, seed);
  ModelMember member;
  member.area = interpretation::areaOfCells(
      settleAll(model, model.label + "', '" + condition, all, threads), leaf);
  member.condition = condition;
  member.histogram = meanHistogram(all, model, seed, threads, member.features);
  model.members.push_back(std::move(member));
  if (lesson != nullptr)
    teach(*lesson, all, seed);
}

} // namespace pcl_surflet
