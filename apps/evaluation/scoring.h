/** \file
 * Compares what was found in a scene with the truth. */
#pragma once

#include "pcl_surflet/core/cell_reduction.h"
#include "pcl_surflet/core/scene_generator.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A reduced scene with the truth about its cells. */
struct CellScene {
  SurfletSet cells;
  std::vector<std::uint32_t> instance; ///< that most surflets of the cell come from; 0 background
  std::vector<PlacedItem> items;       ///< items[k] is instance k + 1
};

CellScene withTruth(const CellReduction& reduction, const Scene& scene);

/** \brief Label of what most cells of \p d come from: an item, or "background". */
std::string truthOf(const CellScene& scene, const Detection& d);

/** \brief Counts over all scenes, for one object or for all. */
struct Counts {
  std::size_t present = 0;  ///< instances in the scenes
  std::size_t found = 0;    ///< instances that a cluster of their label lies on
  std::size_t clusters = 0; ///< detections of this label
  std::size_t right = 0;    ///< with at least one cell of an object of that label, Eq. 5.9
  std::size_t strict = 0;   ///< with most of their cells on one instance of that label
  std::size_t doubles = 0;  ///< strict, but of an instance found before
  /** \brief Instances for which a cluster of their label has its centre within half r_mean of
   * theirs: Detection::centre. */
  std::size_t centred = 0;
  std::size_t cells = 0;       ///< in clusters that are right
  std::size_t right_cells = 0; ///< of these, from objects of that label, Eq. 5.10

  Counts& operator+=(const Counts& other);
};

/** \brief Share and its 95 % confidence interval (Wilson), in percent. */
struct Rate {
  double percent = 0, low = 0, high = 0;
};

Rate rateOf(std::size_t hits, std::size_t trials);

/** \brief How many clusters are strict and not doubles. */
Rate precisionOf(const Counts& counts);

/** \brief Share of the instances found times share of the clusters that are right, in percent. */
double recallTimesPrecision(const Counts& counts);

/** \brief Score of one method over many scenes. */
class Score {
public:
  /** \param labels of the objects, in the order in which detections count them */
  explicit Score(std::vector<std::string> labels);

  void add(const CellScene& scene, const std::vector<Detection>& detections);
  /** \brief A line for each object and one for all. */
  std::string table() const;
  /** \brief Names of the columns of csv(), but for its prefix. */
  static std::string csvHeader();
  /** \brief A line for each object and one for "all"; each begins with \p prefix. */
  std::string csv(const std::string& prefix) const;
  Counts all() const;
  std::size_t
  scenes() const
  {
    return scenes_;
  }
  /** \brief Detections that are not strictly right, and doubles, per scene. */
  double falsePerScene() const;

private:
  std::vector<std::string> labels_;
  std::vector<Counts> counts_;
  std::size_t scenes_ = 0;
};

/** \brief 0 if there are none. */
double medianOf(std::vector<double> values);

} // namespace apps
} // namespace pcl_surflet
