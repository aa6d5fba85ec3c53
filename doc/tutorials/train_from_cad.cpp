// Tutorial: from a CAD file to a name.

#include "tutorial_data.h"

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_classifier.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/surface_file.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

const std::vector<std::string> kNames{"cup", "bottle", "wine_glass", "carafe"};

/** \brief The files that you have already. */
std::vector<std::string>
makeCadFiles()
{
  std::vector<std::string> paths;
  for (const auto& name : kNames) {
    paths.push_back("train_from_cad_" + name + ".off");
    pcl_surflet::saveOff(meshOf(*pcl_surflet::shapeByName(name), 3000), paths.back());
  }
  return paths;
}

/** \brief Oriented points of the whole object with 1 % of noise, turned anyhow: a query. */
pcl_surflet::SurfletSet
sampled(const std::string& path, std::uint64_t seed)
{
  const auto points = pcl_surflet::surfletsOf(pcl_surflet::loadSurface(path), 3000, seed);
  return pcl_surflet::displacedAlongNormals(pcl_surflet::randomlyRotated(points, seed), 0.002,
                                            seed);
}

} // namespace

int
main()
{
  const auto paths = makeCadFiles();
  const std::string database_path = "train_from_cad.pcd";

  // train: begin
  pcl_surflet::HistogramModelTrainer trainer; // 5,5,5,5 bins, 5 samplings of 4,500 surflets
  pcl_surflet::ModelDatabase database;
  for (std::size_t i = 0; i < paths.size(); ++i) { // STL, OBJ, PLY or OFF, in metres as the clouds
    const auto file = pcl_surflet::loadSurface(paths[i]);
    database.add(trainer.train(kNames[i], *file.mesh)); // a file without faces has points instead
  }
  pcl_surflet::saveDatabase(database, database_path);
  // train: end

  // look: begin
  for (std::size_t i = 0; i < database.size(); ++i) {
    const auto& model = database[i];
    std::printf("%s: %.3f long, %.1f square decimetres, %llu features\n", model.label.c_str(),
                model.delta_max, 100 * model.surface_area,
                static_cast<unsigned long long>(model.members.front().features));
  }
  // look: end

  // classify: begin
  const pcl_surflet::HistogramClassifier classifier(pcl_surflet::loadDatabase(database_path));
  std::vector<pcl_surflet::SurfletSet> queries; // your clouds: toSurflets (cloud).surflets
  for (std::size_t i = 0; i < paths.size(); ++i)
    queries.push_back(sampled(paths[i], 100 + i));
  std::size_t right = 0;
  const auto answers = classifier.classifyBatch(queries); // in parallel
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto* best = answers[i].best();
    right += best != nullptr && best->label == kNames[i] ? 1 : 0;
    if (best != nullptr)
      std::printf("%s (posterior %.3f, margin %.2f)\n", best->label.c_str(), best->posterior,
                  answers[i].margin);
  }
  std::printf("%zu of %zu right\n", right, queries.size());
  // classify: end

  for (const auto& path : paths)
    std::remove(path.c_str());
  std::remove(database_path.c_str());
  const double bottle = pcl_surflet::areaOfShape(*pcl_surflet::shapeByName("bottle"));
  const bool measured = std::abs(database[1].surface_area / bottle - 1) < 0.02;
  return right == queries.size() && measured ? EXIT_SUCCESS : EXIT_FAILURE;
}
