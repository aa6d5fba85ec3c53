/** \file
 * How good a ranked list of a collection with classes is. */
#pragma once

#include "pcl_surflet/export.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief The usual figures of shape retrieval, means over the queries, in [0, 1]. */
struct RetrievalFigures {
  static constexpr std::size_t kRecallLevels = 10; ///< of \ref precision

  std::size_t queries = 0;      ///< that have others of their class
  double nearest_neighbour = 0; ///< share of queries whose first hit is of their class
  double first_tier = 0;        ///< share of the class among the first |class| - 1 hits
  double second_tier = 0;       ///< share of the class among the first 2 (|class| - 1) hits
  /** \brief Precision where 10, 20, ... 100 % of the class have been found; 0 where a list ends
   * before. */
  std::array<double, kRecallLevels> precision{};
};

/** \brief Scores ranked lists.
 *
 * \param classes of the queries, each of which is a member of the collection
 * \param ranked for each query the classes of the other members, best hit first
 * \param class_sizes for each query, how many members its class has, itself included; queries
 * that are alone in their class are left out
 * \throws std::invalid_argument if the lists differ in length */
PCL_SURFLET_API RetrievalFigures retrievalFigures(
    const std::vector<std::string>& classes, const std::vector<std::vector<std::string>>& ranked,
    const std::vector<std::size_t>& class_sizes);

} // namespace pcl_surflet
