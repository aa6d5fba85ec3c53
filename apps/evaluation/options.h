/** \file
 * Options of pcl_surflet_evaluate. */
#pragma once

#include "evaluation/comparison.h"

#include "pcl_surflet/recognition/scene_accumulation.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What grows from row to row. */
enum class Scaling { None, Area, Models };
/** \brief Which extension is studied. */
enum class Study { None, Paths, Border, Runs };

/** \brief What is evaluated, and how. */
struct EvaluateOptions {
  RecogniserOptions recogniser;
  ComparisonOptions comparison;
  std::vector<std::string> methods = {"dissertation"};
  std::string row = "scenes";
  std::vector<double> critical; ///< distance factors
  Scaling scaling = Scaling::None;
  Study study = Study::None;
  AccumulationParameters accumulation;
  std::vector<double> factors = {1, 2, 5, 10};
  double presence = 1;   ///< probability that an item is present
  std::size_t items = 0; ///< that scenes choose from
  std::uint64_t scenes = 10, seed = 1001, threads = 0, bins = 0;
  bool csv = false;
};

/** \brief The things of an evaluation. */
struct Things {
  std::vector<SceneItem> objects; ///< what is looked for
  std::vector<SceneItem> clutter; ///< in scenes, but unknown to the methods
  std::vector<SceneItem> extra;   ///< known, but in no scene
};

/** \brief Reads the command line of \p program. \return false if help was asked for
 * \throws UsageError, DataError */
bool readEvaluateOptions(const std::string& program, int argc, char** argv,
                         EvaluateOptions& options, Things& things);

} // namespace apps
} // namespace pcl_surflet
