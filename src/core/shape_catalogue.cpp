#include "shape_bodies.h"

#include "pcl_surflet/core/shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace pcl_surflet {

namespace {

using Profile = std::vector<Shape::ProfilePoint>;

constexpr int kStepsPerInterval = 8; ///< about a millimetre or two on the ready-made vessels

/** \brief Slopes of the monotone cubic interpolation of r over z [Fritsch and Carlson 1980, with
 * Brodlie's weighted harmonic mean]: no bulges beyond the given points, so walls cannot cross. */
std::vector<double>
monotoneSlopes(const Profile& points)
{
  const std::size_t n = points.size();
  std::vector<double> secants(n - 1), slopes(n);
  for (std::size_t i = 0; i + 1 < n; ++i)
    secants[i] = (points[i + 1][0] - points[i][0]) / (points[i + 1][1] - points[i][1]);
  slopes.front() = secants.front();
  slopes.back() = secants.back();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = points[i][1] - points[i - 1][1], after = points[i + 1][1] - points[i][1];
    const double w1 = 2 * after + before, w2 = after + 2 * before;
    slopes[i] =
        secants[i - 1] * secants[i] > 0 ? (w1 + w2) / (w1 / secants[i - 1] + w2 / secants[i]) : 0.0;
  }
  return slopes;
}

Profile
smoothCurve(const Profile& points)
{
  const auto slopes = monotoneSlopes(points);
  Profile curve = {points.front()};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double h = points[i + 1][1] - points[i][1];
    for (int k = 1; k <= kStepsPerInterval; ++k) {
      const double t = static_cast<double>(k) / kStepsPerInterval;
      const double r = (1 + 2 * t) * (1 - t) * (1 - t) * points[i][0] +
                       t * (1 - t) * (1 - t) * h * slopes[i] +
                       t * t * (3 - 2 * t) * points[i + 1][0] - t * t * (1 - t) * h * slopes[i + 1];
      curve.push_back({r, points[i][1] + t * h});
    }
  }
  return curve;
}

Shape
vessel(const Profile& outer, double wall, double inner_bottom)
{
  return Shape::revolution(detail::vesselProfile(outer, wall, inner_bottom));
}

const std::vector<std::pair<std::string, std::function<Shape()>>>&
catalogue()
{
  static const std::vector<std::pair<std::string, std::function<Shape()>>> shapes = {
      {"plane", [] { return Shape::plane(0.3, 0.2); }},
      {"box", [] { return Shape::box(0.2, 0.12, 0.08); }},
      {"cube", [] { return Shape::box(0.12, 0.12, 0.12); }},
      {"tetrahedron", [] { return Shape::tetrahedron(0.18); }},
      {"sphere", [] { return Shape::sphere(0.1); }},
      {"ellipsoid", [] { return Shape::ellipsoid(0.12, 0.08, 0.05); }},
      {"torus", [] { return Shape::torus(0.09, 0.035); }},
      {"cylinder", [] { return Shape::cylinder(0.06, 0.18); }},
      {"cone", [] { return Shape::cone(0.08, 0.2); }},
      {"bottle",
       [] {
         return vessel({{0.034, 0},
                        {0.037, 0.006},
                        {0.037, 0.15},
                        {0.034, 0.175},
                        {0.018, 0.21},
                        {0.0145, 0.23},
                        {0.0135, 0.285},
                        {0.0155, 0.29},
                        {0.0155, 0.3}},
                       0.004, 0.008);
       }},
      {"carafe",
       [] {
         return vessel({{0.045, 0},
                        {0.06, 0.02},
                        {0.066, 0.05},
                        {0.055, 0.1},
                        {0.032, 0.15},
                        {0.026, 0.18},
                        {0.03, 0.21},
                        {0.042, 0.24}},
                       0.004, 0.006);
       }},
      {"wine_glass",
       [] {
         return vessel({{0.036, 0},
                        {0.034, 0.002},
                        {0.012, 0.006},
                        {0.0045, 0.015},
                        {0.004, 0.07},
                        {0.007, 0.083},
                        {0.028, 0.1},
                        {0.038, 0.125},
                        {0.037, 0.155},
                        {0.031, 0.2}},
                       0.002, 0.085);
       }},
      {"cup", [] { return Shape::cup(0.042, 0.1, 0.005, 0.03, 0.006); }},
  };
  return shapes;
}

} // namespace

std::vector<Shape::ProfilePoint>
detail::vesselProfile(const Profile& outer, double wall, double inner_bottom)
{
  const Profile wall_curve = smoothCurve(outer);
  Profile profile = {{0, outer.front()[1]}};
  profile.insert(profile.end(), wall_curve.begin(), wall_curve.end());
  std::size_t i = wall_curve.size();
  while (i > 0 && wall_curve[i - 1][1] > inner_bottom) {
    --i;
    profile.push_back({wall_curve[i][0] - wall, wall_curve[i][1]});
  }
  // The bottom corner lies on the outer curve's interval that the bottom's height cuts.
  const auto &low = wall_curve[i - 1], &high = wall_curve[i];
  const double t = (inner_bottom - low[1]) / (high[1] - low[1]);
  profile.push_back({low[0] + t * (high[0] - low[0]) - wall, inner_bottom});
  profile.push_back({0, inner_bottom});
  return profile;
}

std::vector<std::string>
shapeNames()
{
  std::vector<std::string> names;
  for (const auto& [name, make] : catalogue())
    names.push_back(name);
  return names;
}

std::optional<Shape>
shapeByName(const std::string& name)
{
  for (const auto& [known, make] : catalogue())
    if (known == name)
      return make();
  return std::nullopt;
}

} // namespace pcl_surflet
