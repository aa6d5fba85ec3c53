// Which triangle a pixel shows.
#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/depth_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

using namespace pcl_surflet;

TEST(DepthBuffer, SharedEdgesLeaveNoGapAndNothingLeaksOut)
{
  // A fan around an odd place, out to the corners of the picture and beyond.
  const DepthBuffer::Corner middle{13.3, 7.7, 1};
  const std::array<DepthBuffer::Corner, 4> rim = {
      {{-2, -3, 1}, {45, -1, 1}, {43, 31, 1}, {-7, 33, 1}}};
  DepthBuffer buffer(40, 30);
  for (std::uint32_t k = 0; k < 4; ++k)
    buffer.draw({middle, rim[k], rim[(k + 1) % 4]}, k);
  for (std::size_t r = 0; r < 30; ++r)
    for (std::size_t c = 0; c < 40; ++c) {
      EXPECT_NE(buffer.id(c, r), DepthBuffer::nothing) << c << " " << r;
      EXPECT_NEAR(buffer.nearness(c, r), 1, 1e-12);
    }
}

TEST(DepthBuffer, WhatHasNoAreaOrIsElsewhereLeavesNoTrace)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DepthBuffer buffer(8, 8);
  buffer.draw({{{0, 0, 1}, {7, 7, 1}, {3, 3, 1}}}, 1);
  buffer.draw({{{20, 0, 1}, {27, 0, 1}, {20, 7, 1}}}, 2);
  buffer.draw({{{0, -30, 1}, {7, -30, 1}, {0, -20, 1}}}, 3);
  buffer.draw({{{0, nan, 1}, {7, 0, 1}, {0, 7, 1}}}, 4);
  buffer.draw({{{0.1, 0.1, 1}, {0.9, 0.1, 1}, {0.1, 0.9, 1}}}, 5); // between the pixels
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_EQ(buffer.id(i % 8, i / 8), DepthBuffer::nothing);
  EXPECT_THROW(DepthBuffer(0, 5), std::invalid_argument);
  EXPECT_THROW(DepthBuffer(1u << 20, 1u << 20), std::invalid_argument);
}
