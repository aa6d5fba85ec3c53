#include "pcl_surflet/core/conditions.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

namespace pcl_surflet {
namespace {

using Vec3 = std::array<double, 3>;

/** \brief A direction, uniform on the unit sphere. */
Vec3
randomDirection(CounterRandom& random)
{
  const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(t), r * std::sin(t), z};
}

/** \brief Rotation of the uniformly random unit quaternion (Shoemake). */
std::array<Vec3, 3>
randomRotation(CounterRandom& random)
{
  const double u = random.uniform(), s = random.uniform(0, 2 * M_PI),
               t = random.uniform(0, 2 * M_PI);
  const double a = std::sqrt(1 - u), b = std::sqrt(u);
  const double x = a * std::sin(s), y = a * std::cos(s), z = b * std::sin(t), w = b * std::cos(t);
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

using Mat3 = std::array<Vec3, 3>;

Mat3
covariance(const SurfletSet& set)
{
  const Extent extent = computeExtent(set);
  Mat3 sum{};
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vec3 d = {set.x[i] - extent.centroid[0], set.y[i] - extent.centroid[1],
                    set.z[i] - extent.centroid[2]};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        sum[r][c] += d[r] * d[c];
  }
  return sum;
}

/** \brief One Jacobi rotation: makes m[p][q] zero and turns the rows \p axes along. */
void
rotateAway(Mat3& m, Mat3& axes, std::size_t p, std::size_t q)
{
  if (m[p][q] == 0)
    return;
  const double angle = 0.5 * std::atan2(2 * m[p][q], m[p][p] - m[q][q]);
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [c, s](double& a, double& b) {
    const double old = a;
    a = c * old + s * b;
    b = c * b - s * old;
  };
  for (std::size_t k = 0; k < 3; ++k)
    turn(m[k][p], m[k][q]);
  for (std::size_t k = 0; k < 3; ++k)
    turn(m[p][k], m[q][k]);
  for (std::size_t k = 0; k < 3; ++k)
    turn(axes[p][k], axes[q][k]);
}

double
dot(const Vec3& a, double x, double y, double z)
{
  return a[0] * x + a[1] * y + a[2] * z;
}

/** \brief A set as a sensor sees it: across the picture, and towards the sensor. */
struct PictureFrame {
  Vec3 right, up, towards;

  explicit PictureFrame(const Vec3& direction) : towards(direction)
  {
    const auto cross = [](const Vec3& a, const Vec3& b) {
      return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    right = cross(towards, std::abs(towards[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    const double length = std::sqrt(dot(right, right[0], right[1], right[2]));
    for (double& c : right)
      c /= length;
    up = cross(towards, right);
  }
};

using Pixel = std::pair<std::int64_t, std::int64_t>;

/** \brief The foremost height seen in every pixel of a set. */
class DepthBuffer {
public:
  DepthBuffer(const SurfletSet& set, const PictureFrame& frame, double pixel)
      : set_(set), frame_(frame), pixel_(pixel)
  {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto [at, is_new] = foremost_.try_emplace(pixelOf(i), height(i));
      at->second = std::max(at->second, height(i));
    }
  }

  /** \brief How far surflet \p i lies behind the foremost one of its pixel. */
  double
  behind(std::size_t i) const
  {
    return foremost_.at(pixelOf(i)) - height(i);
  }

private:
  double
  height(std::size_t i) const
  {
    return dot(frame_.towards, set_.x[i], set_.y[i], set_.z[i]);
  }
  Pixel
  pixelOf(std::size_t i) const
  {
    const auto index = [this](double v) {
      return static_cast<std::int64_t>(std::floor(std::clamp(v / pixel_, -1e15, 1e15)));
    };
    return {index(dot(frame_.right, set_.x[i], set_.y[i], set_.z[i])),
            index(dot(frame_.up, set_.x[i], set_.y[i], set_.z[i]))};
  }

  const SurfletSet& set_;
  const PictureFrame& frame_;
  double pixel_;
  std::map<Pixel, double> foremost_;
};

/** \brief How far a surface that is seen at this cosine may reach back within one pixel. */
double
slopeAllowance(double cosine, double pixel)
{
  constexpr double kSteepest = 3; // steeper surfaces would hide nothing
  return 1.5 * pixel * std::min(kSteepest, std::sqrt(1 - cosine * cosine) / cosine);
}

} // namespace

SurfletSet
randomlyRotated(const SurfletSet& set, std::uint64_t seed)
{
  CounterRandom random(seed);
  const auto r = randomRotation(random);
  SurfletSet out;
  out.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Surflet s = set[i];
    const auto turned = [&](std::size_t k, double x, double y, double z) {
      return static_cast<float>(dot(r[k], x, y, z));
    };
    out.push_back({turned(0, s.x, s.y, s.z), turned(1, s.x, s.y, s.z), turned(2, s.x, s.y, s.z),
                   turned(0, s.nx, s.ny, s.nz), turned(1, s.nx, s.ny, s.nz),
                   turned(2, s.nx, s.ny, s.nz)});
  }
  return out;
}

SurfletSet
displacedAlongNormals(const SurfletSet& set, double amplitude, std::uint64_t seed)
{
  CounterRandom random(seed);
  SurfletSet out = set;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double d = random.uniform(-amplitude, amplitude);
    out.x[i] = static_cast<float>(set.x[i] + d * set.nx[i]);
    out.y[i] = static_cast<float>(set.y[i] + d * set.ny[i]);
    out.z[i] = static_cast<float>(set.z[i] + d * set.nz[i]);
  }
  return out;
}

SurfletSet
cutByRandomPlane(const SurfletSet& set, double visible, std::uint64_t seed)
{
  if (!(visible > 0 && visible <= 1))
    throw std::invalid_argument("pcl_surflet: the visible share must be in (0, 1]");
  if (set.empty())
    return set;
  CounterRandom random(seed);
  const Vec3 normal = randomDirection(random);
  std::vector<std::pair<double, std::uint32_t>> heights(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    heights[i] = {dot(normal, set.x[i], set.y[i], set.z[i]), static_cast<std::uint32_t>(i)};
  const auto wanted =
      static_cast<std::size_t>(std::lround(visible * static_cast<double>(set.size())));
  const auto kept = std::clamp<std::size_t>(wanted, 1, set.size());
  std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(kept - 1),
                   heights.end());
  std::vector<std::uint32_t> indices;
  for (std::size_t k = 0; k < kept; ++k)
    indices.push_back(heights[k].second);
  std::sort(indices.begin(), indices.end());
  return set.subset(indices);
}

SurfletSet
singleView(const SurfletSet& set, double spacing, double noise, std::uint64_t seed)
{
  constexpr double kGrazing = 0.1;
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw std::invalid_argument("pcl_surflet: the spacing of a view must be positive");
  CounterRandom random(seed);
  const PictureFrame frame(randomDirection(random));
  const double pixel = 1.5 * spacing;
  const DepthBuffer depth(set, frame, pixel);
  SurfletSet seen;
  for (std::size_t i = 0; i < set.size(); ++i) {
    Surflet s = set[i];
    const double cosine = std::min(1.0, dot(frame.towards, s.nx, s.ny, s.nz));
    if (!(cosine > kGrazing) || !(depth.behind(i) <= slopeAllowance(cosine, pixel) + 2 * spacing))
      continue;
    const double d = random.uniform(-noise, noise);
    s.x = static_cast<float>(s.x + d * frame.towards[0]);
    s.y = static_cast<float>(s.y + d * frame.towards[1]);
    s.z = static_cast<float>(s.z + d * frame.towards[2]);
    seen.push_back(s);
  }
  return seen;
}

TriangleMesh
scaledToDiameter(const TriangleMesh& mesh, double diameter)
{
  SurfletSet vertices;
  for (const auto& v : mesh.vertices)
    vertices.push_back({v[0], v[1], v[2], 0, 0, 1});
  const double factor = diameter / farthestDistance(vertices);
  if (!std::isfinite(factor))
    throw std::invalid_argument("pcl_surflet: a mesh without extent cannot be scaled");
  TriangleMesh out = mesh;
  for (auto& v : out.vertices)
    for (float& c : v)
      c = static_cast<float>(c * factor);
  return out;
}

std::array<std::array<double, 3>, 3>
principalAxes(const SurfletSet& set)
{
  Mat3 m = covariance(set);
  Mat3 axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr int kSweeps = 12; // converges quadratically; six are enough for doubles
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    rotateAway(m, axes, 0, 1);
    rotateAway(m, axes, 0, 2);
    rotateAway(m, axes, 1, 2);
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
  return {axes[order[0]], axes[order[1]], axes[order[2]]};
}

TriangleMesh
stretched(const TriangleMesh& mesh, const std::array<std::array<double, 3>, 3>& axes,
          const std::array<double, 3>& factors)
{
  for (const double f : factors)
    if (!(f > 0) || !std::isfinite(f))
      throw std::invalid_argument("pcl_surflet: a stretch must be positive and finite");
  TriangleMesh out = mesh;
  for (auto& v : out.vertices) {
    Vec3 sum{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double along = factors[a] * dot(axes[a], v[0], v[1], v[2]);
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += along * axes[a][k];
    }
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = static_cast<float>(sum[k]);
  }
  return out;
}

double
distortionMeasure(const std::array<double, 3>& factors)
{
  double squares = 0, sum = 0;
  for (const double f : factors) {
    squares += (f - 1) * (f - 1);
    sum += f - 1;
  }
  return sum < 0 ? -std::sqrt(squares) : std::sqrt(squares);
}

} // namespace pcl_surflet
