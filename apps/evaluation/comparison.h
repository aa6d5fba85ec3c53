/** \file
 * Methods side by side on the same scenes. */
#pragma once

#include "evaluation/recognisers.h"
#include "evaluation/scoring.h"

#include "pcl_surflet/core/cell_reduction.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What is measured beside the score. */
struct ComparisonOptions {
  double leaf = 0.0058;
  unsigned threads = 0;
  bool peers = false;   ///< PCL's normal estimation and voxel grid run on every scene
  bool memory = false;  ///< peak of reduction and interpretation, on the first scenes
  bool verbose = false; ///< what was found where, and what each step did, to stderr
};

/** \brief One method and what became of it. */
struct Contestant {
  std::string name;
  std::shared_ptr<const Recogniser> method;
  Score score;
  std::vector<double> cells, seconds; ///< a scene
  std::vector<double> voxel_ratio;    ///< of the reduction to pcl::VoxelGrid
  std::vector<double> normals_ratio;  ///< of this to pcl::NormalEstimationOMP on the same cells
  std::vector<double> memory_ratio;   ///< growth to the surflets of the scene
};

/** \brief A row of a table: one kind of scene, several methods. */
class Comparison {
public:
  Comparison(std::string row, const std::vector<std::string>& labels,
             const ComparisonOptions& options);

  void enter(const std::string& name, std::shared_ptr<const Recogniser> method);

  /** \brief Reduces a scene and lets every method interpret it. */
  void run(const Scene& scene, std::uint64_t seed);

  /** \brief A table for every method, and one line each to compare them. */
  std::string table() const;
  static std::string csvHeader();
  /** \param models trained objects \param treatment of the background, by name */
  std::string csv(std::size_t models, const std::string& treatment, std::uint64_t seed) const;

private:
  /** \brief A scene as some methods see it. */
  struct Prepared {
    CellScene cells;
    double normals_seconds = 0, voxel_ratio = 0; ///< 0: not measured
  };

  Prepared prepared(const Scene& scene, double split_below) const;
  CellReductionOptions reduction(double split_below) const;
  void measure(Contestant& contestant, const Scene& scene, const Prepared& seen,
               std::uint64_t seed);

  std::string row_;
  std::vector<std::string> labels_;
  ComparisonOptions options_;
  std::vector<Contestant> contestants_;
};

} // namespace apps
} // namespace pcl_surflet
