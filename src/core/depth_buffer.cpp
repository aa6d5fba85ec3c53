#include "pcl_surflet/core/depth_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using Corner = DepthBuffer::Corner;

constexpr std::size_t kMaxPixels = std::size_t{1} << 26;
constexpr double kFromTheEdge = 1e-12; ///< squared pixels
/** \brief Both triangles at a shared edge take a pixel that lies on it, whatever rounding says. */
constexpr double kOnEdge = 1e-9;

double
twiceArea(const Corner& a, const Corner& b, const Corner& c)
{
  return (b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row);
}

/** \brief Whole numbers from \p low to \p high that are pixels: first and one past the last. */
std::pair<std::size_t, std::size_t>
pixelsBetween(double low, double high, std::size_t pixels)
{
  const double end = static_cast<double>(pixels);
  return {static_cast<std::size_t>(std::clamp(std::ceil(low), 0.0, end)),
          static_cast<std::size_t>(std::clamp(std::floor(high) + 1, 0.0, end))};
}

} // namespace

DepthBuffer::DepthBuffer(std::size_t columns, std::size_t rows) : columns_(columns), rows_(rows)
{
  if (columns == 0 || rows == 0 || columns > kMaxPixels / rows)
    throw std::invalid_argument("pcl_surflet: a depth picture needs 1 to 2^26 pixels, not " +
                                std::to_string(columns) + " x " + std::to_string(rows));
  nearness_.assign(columns * rows, -std::numeric_limits<double>::infinity());
  ids_.assign(columns * rows, nothing);
}

void
DepthBuffer::draw(const std::array<Corner, 3>& t, std::uint32_t id)
{
  const double area = twiceArea(t[0], t[1], t[2]);
  if (!std::isfinite(area) || std::abs(area) < kFromTheEdge)
    return;
  const auto [left, right] = std::minmax({t[0].column, t[1].column, t[2].column});
  const auto [low, high] = std::minmax({t[0].row, t[1].row, t[2].row});
  const auto [first_column, end_column] = pixelsBetween(left, right, columns_);
  const auto [first_row, end_row] = pixelsBetween(low, high, rows_);
  for (std::size_t row = first_row; row < end_row; ++row)
    for (std::size_t column = first_column; column < end_column; ++column) {
      const Corner at = {static_cast<double>(column), static_cast<double>(row), 0};
      const double u = twiceArea(at, t[1], t[2]) / area, v = twiceArea(t[0], at, t[2]) / area,
                   w = 1 - u - v;
      if (std::min({u, v, w}) < -kOnEdge)
        continue;
      const double nearness = u * t[0].nearness + v * t[1].nearness + w * t[2].nearness;
      double& foremost = nearness_[row * columns_ + column];
      if (!(nearness > foremost))
        continue;
      foremost = nearness;
      ids_[row * columns_ + column] = id;
    }
}

} // namespace pcl_surflet
