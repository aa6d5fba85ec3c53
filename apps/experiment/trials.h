/** \file
 * The one way recognisers are tried on disturbed objects [Wahl 2007, Sec. 3.6.4-3.6.8]. */
#pragma once

#include "experiment/recogniser.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace pcl_surflet {
namespace apps {

/** \brief What is done to an object before it is to be recognised. */
struct Condition {
  double noise = 0;   ///< amplitude along the normal (of a view: along the line of sight), as a
                      ///< share of the diameter
  double visible = 1; ///< share of the surface left by a random plane
  double resolution =
      1; ///< training spacing / query spacing: half of it is a quarter of the points
  std::array<double, 3> stretch{1, 1, 1}; ///< factors along the principal axes
  double normal_radius = 3; ///< of estimated normals, in spacings of the undisturbed object: 2
                            ///< leave 1 % noise visible in the normals, 4 round small details
  bool view = false;        ///< only what a distant sensor in a random direction sees
};

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

/** \brief A disturbed object as recognisers get it. */
struct Query {
  SurfletSet sampled;   ///< with the mesh's normals, of noise and views with estimated ones
  SurfletSet estimated; ///< with estimated normals (pcl::NormalEstimation); empty unless asked for

  const SurfletSet&
  with(Normals normals) const
  {
    return normals == Normals::Sampled ? sampled : estimated;
  }
};

/** \brief A fresh even sample of the stretched object, turned at random, then disturbed.
 *
 * What a view hides is found by drawing the mesh, not by the depth buffer of surflets that models
 * are trained with: a model that fits that buffer only would be found out. The sensor of a view
 * stands on the z axis. */
Query makeQuery(const ExperimentObject& object, const Condition& condition, std::uint64_t seed,
                bool estimate);

struct TrialPlan {
  std::vector<Setting> settings;
  std::uint64_t tests = 100; ///< per object and setting
  std::uint64_t seed = 1;    ///< queries are sampled with other seeds than models
  unsigned threads = 0;
  std::size_t first = 0; ///< settings of an earlier run that came before these: seeds go on there
};

/** \brief Seed of a query. A setting's queries do not depend on the settings that follow it. */
std::uint64_t querySeed(std::uint64_t seed, std::size_t setting, std::size_t object,
                        std::size_t test);

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
