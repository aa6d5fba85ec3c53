// How well are the objects of generated scenes found? Table 5.1, Fig. 5.5 and beyond.

#include "app_common.h"
#include "evaluation/extensions.h"
#include "evaluation/options.h"
#include "scene_items.h"

#include <cmath>
#include <cstdio>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_evaluate";

using Methods = std::vector<std::shared_ptr<const Recogniser>>;
using SceneMaker = std::function<Scene(std::uint64_t k)>;

std::string
treatmentName(BackgroundTreatment treatment)
{
  switch (treatment) {
  case BackgroundTreatment::Exclude:
    return "exclude";
  case BackgroundTreatment::Model:
    return "model";
  default:
    return "ignore";
  }
}

Methods
trained(const std::vector<SceneItem>& objects, const EvaluateOptions& o)
{
  Methods methods;
  for (const auto& name : o.methods)
    methods.push_back(recogniser(name, objects, o.recogniser));
  return methods;
}

/** \brief One row: every method on all scenes. \p objects are what the methods know. */
void
evaluateRow(const std::string& name, const std::vector<SceneItem>& objects, const Methods& methods,
            const SceneMaker& scene, const EvaluateOptions& o)
{
  Comparison comparison(name, labelsOf(objects), o.comparison);
  for (std::size_t m = 0; m < methods.size(); ++m)
    comparison.enter(o.methods[m], methods[m]);
  Progress progress(o.scenes);
  for (std::uint64_t k = 0; k < o.scenes; ++k) {
    progress.show(k, name);
    comparison.run(scene(k), o.seed + k);
  }
  progress.clear();
  const auto treatment = treatmentName(o.recogniser.dissertation.background);
  const std::string text =
      o.csv ? comparison.csv(objects.size(), treatment, o.seed) : comparison.table();
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout); // rows take long
}

SceneOptions
sceneOptions(const EvaluateOptions& o, std::uint64_t k)
{
  SceneOptions scene = o.recogniser.scene;
  scene.seed = o.seed + k;
  if (o.presence < 1)
    scene.present = presentOf(o.items, o.presence, scene.seed);
  return scene;
}

/** \brief Fig. 5.5: two instances of one object, which changes from scene to scene. */
void
evaluateCritical(const Things& things, const EvaluateOptions& o)
{
  const Methods methods = trained(things.objects, o);
  for (const double factor : o.critical)
    evaluateRow(
        o.row + " " + number(factor), things.objects, methods,
        [&](std::uint64_t k) {
          SceneOptions scene = sceneOptions(o, k);
          scene.spacing = Spacing::Pair;
          scene.distance_factor = factor;
          scene.present = 2;
          const auto& item = things.objects[k % things.objects.size()];
          return seenScene({item, item}, things.clutter, scene, o.recogniser.sensing);
        },
        o);
}

/** \brief Scenes of several times the area and the objects, and methods that know them: their empty
 * scene is as large. */
void
evaluateArea(const Things& things, const EvaluateOptions& base)
{
  for (const double factor : base.factors) {
    EvaluateOptions o = base;
    o.recogniser.scene.size *= std::sqrt(factor);
    o.recogniser.scene.present *= static_cast<std::size_t>(factor);
    std::vector<SceneItem> objects;
    for (int k = 0; k < factor; ++k)
      objects.insert(objects.end(), things.objects.begin(), things.objects.end());
    evaluateRow(
        o.row + " " + number(factor), things.objects, trained(things.objects, o),
        [&](std::uint64_t k) {
          return seenScene(objects, things.clutter, sceneOptions(o, k), o.recogniser.sensing);
        },
        o);
  }
}

/** \brief The same scenes with \p factor times the models. */
void
evaluateModels(const Things& things, const EvaluateOptions& o)
{
  for (const double factor : o.factors) {
    const auto more =
        static_cast<std::size_t>((factor - 1) * static_cast<double>(things.objects.size()));
    if (more > things.extra.size())
      throw UsageError("option -extra: " + std::to_string(more) + " items are needed, not " +
                       std::to_string(things.extra.size()));
    auto known = things.objects;
    known.insert(known.end(), things.extra.begin(),
                 things.extra.begin() + static_cast<std::ptrdiff_t>(more));
    evaluateRow(
        o.row + " " + number(factor), known, trained(known, o),
        [&](std::uint64_t k) {
          return seenScene(things.objects, things.clutter, sceneOptions(o, k),
                           o.recogniser.sensing);
        },
        o);
  }
}

/** \brief The extensions of chapter 6. */
void
evaluateStudy(const Things& things, const EvaluateOptions& o)
{
  ExtensionStudy study;
  study.names = o.methods;
  study.methods = trained(things.objects, o);
  study.labels = labelsOf(things.objects);
  study.scene = [&](std::uint64_t k) {
    return generateScene(things.objects, things.clutter, sceneOptions(o, k));
  };
  study.scenes = o.scenes;
  study.seed = o.seed;
  study.leaf = o.recogniser.leaf;
  study.accumulation = o.accumulation;
  const std::string csv = o.study == Study::Paths    ? studyPaths(study)
                          : o.study == Study::Border ? studyBorder(study)
                                                     : studyRuns(study);
  std::fputs(csv.c_str(), stdout);
}

void
evaluate(const Things& things, const EvaluateOptions& o)
{
  if (o.study != Study::None)
    return evaluateStudy(things, o);
  if (o.csv)
    std::fputs(Comparison::csvHeader().c_str(), stdout);
  if (!o.critical.empty())
    evaluateCritical(things, o);
  else if (o.scaling == Scaling::Area)
    evaluateArea(things, o);
  else if (o.scaling == Scaling::Models)
    evaluateModels(things, o);
  else
    evaluateRow(
        o.row, things.objects, trained(things.objects, o),
        [&](std::uint64_t k) {
          return seenScene(things.objects, things.clutter, sceneOptions(o, k),
                           o.recogniser.sensing);
        },
        o);
}

int
run(int argc, char** argv)
{
  EvaluateOptions o;
  Things things;
  if (!readEvaluateOptions(kProgram, argc, argv, o, things))
    return kOk;
  evaluate(things, o);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return run(argc, argv); });
}
