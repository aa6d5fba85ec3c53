/** \file
 * Which triangle is foremost in each pixel of a picture. */
#pragma once

#include "pcl_surflet/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {

/** \brief A z-buffer. Pixel (column, row) has its middle at these whole numbers.
 *
 * Nearness is any measure that is linear in the picture over a plane and grows towards the sensor:
 * the height under a distant sensor, the reciprocal depth before a pinhole camera. A pixel shows
 * the nearest triangle that covers its middle, the one drawn first where two are equally near.
 * Triangles that share an edge leave no gap. */
class PCL_SURFLET_API DepthBuffer {
public:
  /** \brief Corner of a triangle in the picture. */
  struct Corner {
    double column = 0;   ///< in pixels, to the right
    double row = 0;      ///< in pixels, downwards
    double nearness = 0; ///< larger: nearer
  };
  static constexpr std::uint32_t nothing = 0xffffffffu; ///< id of a pixel that shows no triangle

  /** \throws std::invalid_argument if there is no pixel, or there are more than 2^26 */
  DepthBuffer(std::size_t columns, std::size_t rows);

  /** \brief Draws a triangle of either orientation. What is outside the picture, seen from the edge
   * or not finite leaves no trace. */
  void draw(const std::array<Corner, 3>& triangle, std::uint32_t id);

  /** \brief Width of the picture in pixels. */
  std::size_t
  columns() const
  {
    return columns_;
  }
  /** \brief Height of the picture in pixels. */
  std::size_t
  rows() const
  {
    return rows_;
  }
  /** \brief Minus infinity where there is nothing. The pixel must be in the picture. */
  double
  nearness(std::size_t column, std::size_t row) const
  {
    return nearness_[row * columns_ + column];
  }
  /** \brief Of the triangle that the pixel shows, or DepthBuffer::nothing. */
  std::uint32_t
  id(std::size_t column, std::size_t row) const
  {
    return ids_[row * columns_ + column];
  }

private:
  std::size_t columns_, rows_;
  std::vector<double> nearness_;
  std::vector<std::uint32_t> ids_;
};

} // namespace pcl_surflet
