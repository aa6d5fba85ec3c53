/** \file
 * The one way recognisers are tried on disturbed objects [Wahl 2007, Sec. 3.6.4-3.6.8]. */
#pragma once

#include "experiment/query.h"
#include "experiment/recogniser.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace pcl_surflet {
namespace apps {

/** \brief One place of a plot: conditions, maybe drawn anew for every test. */
struct Setting {
  std::string series; ///< curve it belongs to, may be empty
  double x = 0;       ///< where it stands on that curve
  std::string name;
  /** \brief The condition of the test with this seed; none if none could be drawn. */
  std::function<std::optional<Condition>(std::uint64_t seed)> condition;
};

/** \brief A setting whose condition is always the same. */
Setting fixedSetting(const std::string& name, double x, const Condition& condition);

/** \brief Outcome of one recogniser under one setting. */
struct Tally {
  std::vector<std::vector<std::uint64_t>> confusion; ///< [object][object answered]
  std::vector<std::uint64_t> tests_of;               ///< [object]
  std::uint64_t tests = 0, right = 0, failed = 0;
  double seconds = 0; ///< of all tests

  explicit Tally(std::size_t objects = 0);
  void add(std::size_t object, const Answer& answer);
  void add(const Tally& other);

  double
  rate() const
  {
    return tests > 0 ? static_cast<double>(right) / static_cast<double>(tests) : 0;
  }
  double
  secondsPerQuery() const
  {
    return tests > 0 ? seconds / static_cast<double>(tests) : 0;
  }
};

/** \brief Bounds of the 95 % confidence interval of a rate (Wilson). */
std::pair<double, double> confidenceInterval(std::uint64_t right, std::uint64_t tests);

struct TrialPlan {
  std::vector<Setting> settings;
  std::uint64_t tests = 100; ///< per object and setting
  std::uint64_t seed = 1;    ///< queries are sampled with other seeds than models
  unsigned threads = 0;
  std::size_t first = 0; ///< settings of an earlier run that came before these: seeds go on there
};

/** \brief Tallies [setting][recogniser]. */
using Tallies = std::vector<std::vector<Tally>>;

/** \brief Tries all recognisers on the same queries: tests x objects under every setting.
 * \param keep is given the tallies so far after every setting, so that a long run that is ended
 * loses nothing but the setting at hand */
Tallies runTrials(const std::vector<ExperimentObject>& objects, const Recognisers& recognisers,
                  const TrialPlan& plan, const ProgressFunction& progress,
                  const std::function<void(const Tallies&)>& keep = {});

} // namespace apps
} // namespace pcl_surflet
