/** \file
 * From a file to a model. */
#pragma once

#include "parallel/ranks.h"
#include "training/options.h"

#include "pcl_surflet/recognition/histogram_model.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief What became of one file. */
struct TrainedFile {
  HistogramModel model;
  std::vector<std::string> notes; ///< what of the file was not used as it is
  std::string error;              ///< empty if there is a model

  template <class Archive>
  void
  serialize(Archive& archive, unsigned)
  {
    archive& model& notes& error;
  }
};

/** \brief Trains by this process alone. Never throws because of the file. */
TrainedFile trainedFrom(const std::string& path, const TrainOptions& o);

/** \brief Do so many pairs need counting that all ranks should share those of one file? */
bool pairsAreWorthSharing(const TrainOptions& o);

/** \brief Trains by all ranks together: the first one reads the file, each counts its share of the
 * pairs, and all get the same answer. */
TrainedFile trainedTogether(const std::string& path, const TrainOptions& o, Ranks& ranks);

} // namespace apps
} // namespace pcl_surflet
