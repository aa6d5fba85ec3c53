/** \file
 * The command line of pcl_surflet_train. */
#pragma once

#include "app_common.h"

#include "pcl_surflet/recognition/model_bank.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

struct TrainOptions {
  std::string database, label;
  bool background = false;
  Resolution resolution;
  ModelBank bank = ModelBank::none();
  double leaf = 0; ///< 0: not for scenes
  bool views = false;
  std::uint64_t pairs = 10000000, seed = 1, threads = 0;
  MissingNormals normals;
  std::vector<std::string> files;
};

/** \brief Reads and checks the command line.
 * \return false if help was asked for \throws UsageError, DataError */
bool readTrainOptions(const std::string& program, int argc, char** argv, TrainOptions& o);

} // namespace apps
} // namespace pcl_surflet
