/** \file
 * Rates as curves with intervals. */
#pragma once

#include "experiment/plots.h"
#include "experiment/rates_report.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A rate with its 95 % interval. */
CurvePoint pointOf(double x, std::uint64_t right, std::uint64_t tests);

/** \brief One curve a recogniser. */
std::vector<Curve> curvesOf(const Rates& rates);

/** \brief The first recogniser's curve over the settings of \p series ("" for all of them, those at
 * one x pooled) for \p object, or for all objects. */
Curve seriesCurve(const Rates& rates, const std::string& series, const std::string& title,
                  std::size_t object = Answer::kNone);

} // namespace apps
} // namespace pcl_surflet
