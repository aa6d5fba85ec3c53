#include "evaluation/recognisers.h"

#include "evaluation/classic.h"

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/scene_interpreter.h"

#include <algorithm>
#include <functional>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr int kDissertationBins = 5, kExplanationBins = 7;
/** \brief Examples of an object for the classic: turns about the vertical, or postures as well. */
constexpr std::uint64_t kTurns = 12, kPostures = 48;
constexpr std::uint64_t kFewestSensed = 3;
constexpr unsigned kBowlPlanes = 5;
/** \brief Edge of what carries an example, in diameters of the object. */
constexpr double kExampleSize = 2;

SurfletSet
emptyCells(const SceneOptions& scene, const Sensing& sensing, double leaf)
{
  return reduceToCells(seenBackground(scene, sensing), leaf).cells;
}

/** \brief Lets \p find see only what is not background, and gives its results the scene's indices.
 */
SceneInterpretation
findAwayFrom(const SurfletSet& empty, double leaf, unsigned threads, const SurfletSet& cells,
             const std::function<SceneInterpretation(const SurfletSet&)>& find)
{
  const auto away = cellsAwayFrom(cells, empty, leaf, threads);
  SceneInterpretation found = find(cells.subset(away));
  for (auto& d : found.detections)
    for (auto& cell : d.cells)
      cell = away[cell];
  return found;
}

class HistogramRecogniser : public Recogniser {
public:
  HistogramRecogniser(const std::vector<SceneItem>& objects, const RecogniserOptions& o,
                      bool by_explanation)
      : options_(o), by_explanation_(by_explanation)
  {
    TrainingOptions t;
    t.scene = o.scene;
    t.sensing = o.sensing;
    t.bins = o.bins;
    if (t.bins == 0)
      t.bins = by_explanation ? kExplanationBins : kDissertationBins;
    t.leaf = o.leaf;
    t.for_scenes = by_explanation && !o.on_surfaces;
    t.with_background = o.dissertation.background == BackgroundTreatment::Model;
    t.threads = o.dissertation.threads;
    database_ = trainedDatabase(objects, t);
    if (o.dissertation.background == BackgroundTreatment::Exclude)
      empty_ = emptyCells(o.scene, o.sensing, o.leaf);
  }

  SceneInterpretation
  find(const SurfletSet& cells, std::uint64_t seed) const override
  {
    const auto interpret = [&](const SurfletSet& visible) {
      ExplanationParameters p = options_.explanation;
      p.steps = options_.dissertation;
      p.steps.seed = seed;
      p.leaf = options_.leaf;
      return by_explanation_ ? withoutDoubtful(interpretByExplanation(visible, database_, p))
                             : interpretByDissertation(visible, database_, p.steps);
    };
    if (options_.dissertation.background != BackgroundTreatment::Exclude)
      return interpret(cells);
    return findAwayFrom(empty_, options_.leaf, options_.dissertation.threads, cells, interpret);
  }

  double
  splitBelow() const override
  {
    return by_explanation_ ? kTwoSided : 0;
  }

private:
  SceneInterpretation
  withoutDoubtful(SceneInterpretation found) const
  {
    auto& all = found.detections;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Detection& d) {
                               return detail::confidenceOf(d, options_.dissertation.min_cluster) <
                                      options_.min_confidence;
                             }),
              all.end());
    return found;
  }

  RecogniserOptions options_;
  bool by_explanation_;
  ModelDatabase database_;
  SurfletSet empty_;
};

unsigned
planesOf(Background background)
{
  switch (background) {
  case Background::Plane:
    return 1;
  case Background::Corner:
    return 2;
  case Background::Box:
    return 5;
  case Background::Bowl: // the best that plane removal can do
    return kBowlPlanes;
  default:
    return 0;
  }
}

/** \brief Of each object. Sensed examples are expensive: few from everywhere, many from one side.
 */
std::uint64_t
examplesFor(const RecogniserOptions& o)
{
  const std::uint64_t whole = o.scene.posture == Posture::Upright ? kTurns : kPostures;
  if (!o.sensing)
    return whole;
  return std::max<std::uint64_t>(kFewestSensed, 2 * whole / sensorPoses(o.sensing->views).size());
}

class ClassicRecogniser : public Recogniser {
public:
  ClassicRecogniser(const std::vector<SceneItem>& objects, const RecogniserOptions& o,
                    Descriptor descriptor, bool exclude)
      : leaf_(o.leaf), threads_(o.dissertation.threads), sensing_(o.sensing), exclude_(exclude),
        classic_(parametersOf(o, descriptor, exclude))
  {
    for (const auto& object : objects)
      labels_.push_back(object.label);
    if (exclude)
      empty_ = emptyCells(o.scene, o.sensing, leaf_);
    const std::uint64_t examples = examplesFor(o);
    for (std::size_t i = 0; i < objects.size(); ++i)
      for (std::uint64_t k = 0; k < examples; ++k)
        learn(i, objects[i], o.scene, kTrainingSeed + k);
    classic_.finish();
  }

  SceneInterpretation
  find(const SurfletSet& cells, std::uint64_t) const override
  {
    const auto name = [&](const SurfletSet& visible) { return named(visible); };
    return exclude_ ? findAwayFrom(empty_, leaf_, threads_, cells, name) : name(cells);
  }

private:
  static ClassicParameters
  parametersOf(const RecogniserOptions& o, Descriptor descriptor, bool exclude)
  {
    ClassicParameters p;
    p.descriptor = descriptor;
    p.leaf = o.leaf;
    p.planes = exclude ? 0 : planesOf(o.scene.background);
    return p;
  }

  void
  learn(std::size_t object, const SceneItem& item, SceneOptions alone, std::uint64_t seed)
  {
    alone.seed = seed;
    alone.spacing = Spacing::Apart;
    alone.present = 1;
    alone.clutter = 0;
    // Nothing is learned from planes in a bowl: they cannot be told from the object.
    if (alone.background == Background::Bowl && !exclude_)
      alone.background = Background::Plane;
    // A smaller bowl would be another one, and to a sensor it matters where an object stands.
    if (alone.background != Background::Bowl && !sensing_)
      alone.size = std::min(alone.size, kExampleSize * farthestDistance(item.sample(1000, seed)));
    SurfletSet cells = reduceToCells(seenScene({item}, {}, alone, sensing_).surflets, leaf_).cells;
    if (exclude_)
      cells = cells.subset(cellsAwayFrom(cells, emptyCells(alone, sensing_, leaf_), leaf_));
    classic_.learn(object, cells);
  }

  SceneInterpretation
  named(const SurfletSet& cells) const
  {
    SceneInterpretation found;
    for (auto& cluster : classic_.find(cells)) {
      Detection d;
      d.model = cluster.object;
      d.label = labels_[d.model];
      d.cells = std::move(cluster.cells);
      const Extent extent = computeExtent(cells.subset(d.cells));
      std::copy(extent.centroid, extent.centroid + 3, d.centroid.begin());
      d.centre = d.centroid;
      d.score = -cluster.distance;
      found.detections.push_back(std::move(d));
    }
    return found;
  }

  double leaf_;
  unsigned threads_;
  Sensing sensing_;
  bool exclude_;
  TabletopClassic classic_;
  std::vector<std::string> labels_;
  SurfletSet empty_;
};

} // namespace

const std::vector<std::string>&
recogniserNames()
{
  static const std::vector<std::string> names = {"dissertation",      "floating",     "repeated",
                                                 "floating_repeated", "explanation",  "classic_vfh",
                                                 "classic_esf",       "exclusion_vfh"};
  return names;
}

std::unique_ptr<Recogniser>
recogniser(const std::string& name, const std::vector<SceneItem>& objects,
           const RecogniserOptions& options)
{
  if (name == "explanation")
    return std::make_unique<HistogramRecogniser>(objects, options, true);
  const bool floating = name.rfind("floating", 0) == 0;
  const bool repeated = name == "repeated" || name == "floating_repeated";
  if (floating || repeated || name == "dissertation") {
    RecogniserOptions extended = options;
    extended.dissertation.floating.on = floating;
    extended.dissertation.repetition.on = repeated;
    return std::make_unique<HistogramRecogniser>(objects, extended, false);
  }
  return std::make_unique<ClassicRecogniser>(
      objects, options, name == "classic_esf" ? Descriptor::Esf : Descriptor::Vfh,
      name == "exclusion_vfh");
}

} // namespace apps
} // namespace pcl_surflet
