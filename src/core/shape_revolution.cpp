#include "draw_interval.h"
#include "shape_bodies.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace detail {

namespace {

constexpr double kSqrt2 = 1.41421356237309504880;

/** \brief Slices around a circle: their chord is a leg, the edge between triangles a diagonal. */
std::uint32_t
slicesAround(double radius, double longest_edge)
{
  const double slices = std::max(3.0, std::ceil(2 * M_PI * radius * kSqrt2 / longest_edge));
  checkMeshSize(slices);
  return static_cast<std::uint32_t>(slices);
}

/** \brief Steps not longer than \p longest_edge / sqrt 2 between two profile points. */
double
stepsBetween(const Shape::ProfilePoint& a, const Shape::ProfilePoint& b, double longest_edge)
{
  return std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) * kSqrt2 / longest_edge);
}

/** \brief The profile with points added so that stepsBetween() holds. */
std::vector<Shape::ProfilePoint>
subdivided(const std::vector<Shape::ProfilePoint>& profile, double longest_edge)
{
  std::vector<Shape::ProfilePoint> out = {profile.front()};
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[i + 1];
    const double steps = stepsBetween(a, b, longest_edge);
    for (double k = 1; k < steps; ++k)
      out.push_back({a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps});
    out.push_back(b);
  }
  return out;
}

/** \brief Rings of vertices about the z axis, joined by quadrangles or, at the axis, triangles. */
class RingMesh {
public:
  explicit RingMesh(std::uint32_t slices) : slices_(slices) {}

  /** \brief Adds the ring of \p at; returns its first vertex. */
  std::uint32_t
  addRing(const Shape::ProfilePoint& at)
  {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t k = 0; k < (at[0] > 0 ? slices_ : 1); ++k) {
      const double phi = 2 * M_PI * k / slices_;
      mesh_.vertices.push_back(toFloat3({at[0] * std::cos(phi), at[0] * std::sin(phi), at[1]}));
    }
    return first;
  }

  /** \brief Joins two rings; outward is to the right of the way from the first to the second. */
  void
  join(std::uint32_t low, bool low_is_point, std::uint32_t high, bool high_is_point)
  {
    for (std::uint32_t k = 0; k < slices_; ++k) {
      const std::uint32_t next = (k + 1) % slices_;
      const std::uint32_t a = low + (low_is_point ? 0 : k), b = low + (low_is_point ? 0 : next);
      const std::uint32_t c = high + (high_is_point ? 0 : next), d = high + (high_is_point ? 0 : k);
      if (!low_is_point)
        mesh_.triangles.push_back({a, b, c});
      if (!high_is_point)
        mesh_.triangles.push_back({a, c, d});
    }
  }

  TriangleMesh&
  mesh()
  {
    return mesh_;
  }

private:
  std::uint32_t slices_;
  TriangleMesh mesh_;
};

} // namespace

RevolutionBody::RevolutionBody(std::vector<Shape::ProfilePoint> profile)
    : profile_(std::move(profile))
{
  double sum = 0;
  for (std::size_t i = 0; i + 1 < profile_.size(); ++i) {
    const auto &a = profile_[i], &b = profile_[i + 1];
    cumulative_.push_back(sum += M_PI * (a[0] + b[0]) * std::hypot(b[0] - a[0], b[1] - a[1]));
  }
}

double
RevolutionBody::area() const
{
  return cumulative_.back();
}

ExactSurflet
RevolutionBody::sample(CounterRandom& random) const
{
  const std::size_t i = drawInterval(cumulative_, random.uniform());
  const auto &a = profile_[i], &b = profile_[i + 1];
  // On a frustum the area below radius r goes with r^2 - a^2. Solved for the share t of the way
  // from a to b in the form that also holds for cylinders.
  const double u = random.uniform();
  const double r = std::sqrt(a[0] * a[0] + u * (b[0] * b[0] - a[0] * a[0]));
  const double t = r + a[0] > 0 ? u * (a[0] + b[0]) / (r + a[0]) : 0;
  const double z = a[1] + t * (b[1] - a[1]);
  const double phi = random.uniform(-M_PI, M_PI);
  const double c = std::cos(phi), s = std::sin(phi);
  const double outward = b[1] - a[1], up = a[0] - b[0];
  return {{r * c, r * s, z}, {outward * c, outward * s, up}};
}

TriangleMesh
RevolutionBody::mesh(double longest_edge) const
{
  double widest = 0, steps = 0;
  for (std::size_t i = 0; i < profile_.size(); ++i) {
    widest = std::max(widest, profile_[i][0]);
    steps += i > 0 ? stepsBetween(profile_[i - 1], profile_[i], longest_edge) : 0;
  }
  const std::uint32_t slices = slicesAround(widest, longest_edge);
  checkMeshSize(2.0 * slices * steps); // before anything of that size is made
  const auto points = subdivided(profile_, longest_edge);
  const bool ring = points.front() == points.back();
  RingMesh rings(slices);
  const std::uint32_t first = rings.addRing(points.front());
  std::uint32_t low = first;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool closes = ring && i + 1 == points.size();
    const std::uint32_t high = closes ? first : rings.addRing(points[i]);
    rings.join(low, !(points[i - 1][0] > 0), high, !(points[i][0] > 0));
    low = high;
  }
  return std::move(rings.mesh());
}

TorusBody::TorusBody(double major_radius, double minor_radius, double wall_radius)
    : major_(major_radius), minor_(minor_radius), wall_(wall_radius), area_(0), largest_weight_(0)
{
  // The trapezoidal rule converges exponentially: the integrand is smooth and periodic.
  constexpr int kSteps = 4096;
  for (int i = 0; i < kSteps; ++i) {
    const double theta = 2 * M_PI * i / kSteps;
    area_ += minor_ * 2 * weight(theta) * (2 * M_PI / kSteps);
    largest_weight_ = std::max(largest_weight_, weight(theta));
  }
  largest_weight_ *= 1 + 1e-4; // the maximum may lie between two steps
}

/** \brief End of the arc outside of the wall, in (0, pi]. */
double
TorusBody::phiEnd(double theta) const
{
  if (!(wall_ > 0))
    return M_PI;
  // (wall + rho cos phi)^2 + (minor sin theta)^2 = wall^2, with rho the distance to the ring's
  // axis.
  const double rho = major_ + minor_ * std::cos(theta), side = minor_ * std::sin(theta);
  return std::acos((std::sqrt(wall_ * wall_ - side * side) - wall_) / rho);
}

/** \brief Proportional to the area per minor angle. */
double
TorusBody::weight(double theta) const
{
  return (major_ + minor_ * std::cos(theta)) * phiEnd(theta);
}

ExactSurflet
TorusBody::at(double phi, double theta) const
{
  const Vector3 n = {std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi),
                     std::sin(theta)};
  const Vector3 centre = {major_ * std::cos(phi), major_ * std::sin(phi), 0};
  return {add(centre, scaled(n, minor_)), n};
}

double
TorusBody::area() const
{
  return area_;
}

bool
TorusBody::contains(const Vector3& p) const
{
  return std::hypot(std::hypot(p[0], p[1]) - major_, p[2]) < minor_;
}

ExactSurflet
TorusBody::sample(CounterRandom& random) const
{
  while (true) {
    const double theta = random.uniform(-M_PI, M_PI);
    if (random.uniform() * largest_weight_ > weight(theta))
      continue;
    const double end = phiEnd(theta);
    return at(random.uniform(-end, end), theta);
  }
}

TriangleMesh
TorusBody::mesh(double longest_edge) const
{
  const std::uint32_t around = slicesAround(minor_, longest_edge);
  const std::uint32_t along = slicesAround(major_ + minor_, longest_edge);
  checkMeshSize(2.0 * around * along);
  const bool whole = !(wall_ > 0);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < (whole ? along : along + 1); ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double theta = 2 * M_PI * k / around;
      mesh.vertices.push_back(toFloat3(at((2.0 * i / along - 1) * phiEnd(theta), theta).p));
    }
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t next = whole ? (i + 1) % along : i + 1, k2 = (k + 1) % around;
      const std::uint32_t a = i * around + k, b = next * around + k;
      const std::uint32_t c = next * around + k2, d = i * around + k2;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  return mesh;
}

} // namespace detail
} // namespace pcl_surflet
