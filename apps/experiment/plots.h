/** \file
 * Pictures of rates, drawn by gnuplot. */
#pragma once

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A rate and its interval, all in [0, 1]. */
struct CurvePoint {
  double x = 0, rate = 0, low = 0, high = 1;
};

struct Curve {
  std::string title;
  std::vector<CurvePoint> points;
};

/** \brief What the dissertation's text says about a place of its plot. */
struct Statement {
  double x, percent;
  std::string text;
};

/** \brief One plot of rates against x. */
struct Panel {
  std::string title, x_label;
  std::vector<Curve> curves;
  std::vector<Statement> statements;
  std::string y_label = "recognition in %";
};

/** \brief Rates of answers: [object][object answered]. */
struct ConfusionPicture {
  std::string title;
  std::vector<std::vector<double>> rates;
};

/** \brief Draws \p panels in so many \p columns into \p directory/base.svg, or
 * base.png for more than six; base.dat and
 * base.gnuplot, which made it, stay beside it.
 * \return an empty string, or why there is no picture. \throws DataError if a file cannot be
 * written
 */
std::string drawPanels(const std::string& directory, const std::string& base,
                       const std::vector<Panel>& panels, std::size_t columns);

/** \brief Draws confusion matrices into \p directory/base.png as Fig. 3.4 does: columns are test
 * objects, rows trained ones, brighter is more. Files and return value as above. */
std::string drawConfusions(const std::string& directory, const std::string& base,
                           const std::vector<ConfusionPicture>& pictures, std::size_t columns);

} // namespace apps
} // namespace pcl_surflet
