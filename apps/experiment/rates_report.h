/** \file
 * Runs an experiment on recognition rates and says what came out. */
#pragma once

#include "experiment/trials.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Results with what they are results of. */
struct Rates {
  const std::vector<ExperimentObject>& objects;
  const Recognisers& recognisers;
  const std::vector<Setting>& settings;
  Tallies tallies; ///< of the settings that are done
};

/** \brief An experiment as data: what is tried on what, and how it is drawn. */
struct RatesExperiment {
  std::string name;  ///< of its files
  std::string title; ///< what of the dissertation it repeats
  std::vector<Setting> settings;
  std::function<Recognisers(const Training&)> recognisers;
  /** \brief Draws into a directory. \return empty, or why there is no picture */
  std::function<std::string(const Rates&, const std::string& directory)> draw;
};

struct RatesOptions {
  std::string meshes;              ///< directory of the objects' meshes
  std::string out;                 ///< directory of the results, made if missing
  std::vector<std::string> labels; ///< the objects
  std::uint64_t tests = 100;       ///< per object and setting
  std::uint64_t seed = 1, threads = 0;
  std::uint64_t skip = 0; ///< settings left out at the start: a run that was ended goes on
};

/** \brief Trains, tries, prints the rates with their 95 % intervals, writes NAME.csv and
 * NAME_confusion.csv (anew after every setting: what is done stays, should the run be ended) and
 * draws. \return the exit code
 * \throws DataError, MeshFileError, std::invalid_argument */
int reportRates(const RatesExperiment& experiment, const RatesOptions& options);

} // namespace apps
} // namespace pcl_surflet
