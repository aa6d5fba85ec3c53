#include "pcl_surflet/core/depth_sensor.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/depth_buffer.h"
#include "require.h"
#include "vector3.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace pcl_surflet {
namespace {

using namespace detail;

constexpr double kDegree = M_PI / 180;
constexpr const char* kSensorNeeds = "pcl_surflet: a depth sensor needs ";
/** \brief What is nearer than this share of a triangle's farthest corner is cut off: it would be
 * endlessly large in the picture. */
constexpr double kNear = 1e-6;
/** \brief A surface hides itself from the projector by up to this many pixels of its slope. */
constexpr double kShadowPixels = 2, kShadowSlope = 5;
constexpr std::uint64_t kNoiseStream = 0x6e6f697365ULL, kFlyingStream = 0x666c79ULL;

void
check(const DepthSensor& s)
{
  const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
  require(s.opening > 0 && s.opening <= 170, "an opening angle above 0 and up to 170 degrees",
          kSensorNeeds);
  require(s.noise >= 0 && std::isfinite(s.noise), "a noise that is finite and not negative",
          kSensorNeeds);
  require(within(s.noise_power, 0, 4), "a noise power from 0 to 4", kSensorNeeds);
  require(s.quantum >= 0 && std::isfinite(s.quantum), "a quantum that is finite and not negative",
          kSensorNeeds);
  require(within(s.flying, 0, 1), "a share of flying points from 0 to 1", kSensorNeeds);
  require(s.edge > 0, "a positive depth difference for edges", kSensorNeeds);
  require(s.grazing > 0 && s.grazing <= 90, "a grazing angle above 0 and up to 90 degrees",
          kSensorNeeds);
  require(std::isfinite(s.baseline), "a finite baseline", kSensorNeeds);
}

/** \brief A triangle in the sensor's frame. */
struct Facet {
  std::array<Vector3, 3> corners;
  std::size_t body = 0;
};

std::vector<Facet>
facetsOf(const std::vector<SensedBody>& bodies, const SensorFrame& frame)
{
  std::vector<Facet> facets;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const TriangleMesh& mesh = bodies[b].mesh;
    if (const auto problem = mesh.problem(); !problem.empty())
      throw std::invalid_argument("pcl_surflet: body " + std::to_string(b) +
                                  " cannot be sensed: " + problem);
    std::vector<Vector3> vertices;
    for (const auto& v : mesh.vertices)
      vertices.push_back(frame.toSensor(toVector3(v)));
    for (const auto& t : mesh.triangles)
      facets.push_back({{vertices[t[0]], vertices[t[1]], vertices[t[2]]}, b});
  }
  return facets;
}

/** \brief The part of a triangle before the sensor: nothing, a triangle or a quadrangle. */
std::vector<Vector3>
partInFront(const std::array<Vector3, 3>& t)
{
  const double near = kNear * std::max({norm(t[0]), norm(t[1]), norm(t[2])});
  std::vector<Vector3> part;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &a = t[k], &b = t[(k + 1) % 3];
    if (a[2] >= near)
      part.push_back(a);
    if ((a[2] >= near) != (b[2] >= near))
      part.push_back(add(a, scaled(subtract(b, a), (near - a[2]) / (b[2] - a[2]))));
  }
  return part;
}

/** \brief A pinhole, as far to the right of the sensor as its offset, and what it sees. */
class Pinhole {
public:
  Pinhole(const DepthSensor& s, double offset, const std::vector<Facet>& facets)
      : buffer_(s.columns, s.rows), offset_{offset, 0, 0},
        focal_(0.5 * static_cast<double>(s.columns) / std::tan(0.5 * s.opening * kDegree)),
        middle_{0.5 * static_cast<double>(s.columns - 1), 0.5 * static_cast<double>(s.rows - 1)}
  {
    require(facets.size() < DepthBuffer::nothing, "fewer than 2^32 triangles", kSensorNeeds);
    for (std::size_t i = 0; i < facets.size(); ++i)
      draw(facets[i].corners, static_cast<std::uint32_t>(i));
  }

  const DepthBuffer&
  buffer() const
  {
    return buffer_;
  }
  double
  focal() const
  {
    return focal_;
  }
  /** \brief Direction of a pixel's line of sight, of depth 1. */
  Vector3
  ray(std::size_t column, std::size_t row) const
  {
    return {(static_cast<double>(column) - middle_[0]) / focal_,
            (static_cast<double>(row) - middle_[1]) / focal_, 1};
  }
  DepthBuffer::Corner
  project(const Vector3& p) const
  {
    const Vector3 q = subtract(p, offset_);
    return {middle_[0] + focal_ * q[0] / q[2], middle_[1] + focal_ * q[1] / q[2], 1 / q[2]};
  }
  Vector3
  lineTo(const Vector3& p) const
  {
    return subtract(p, offset_);
  }

private:
  void
  draw(const std::array<Vector3, 3>& triangle, std::uint32_t id)
  {
    const auto part = partInFront(triangle);
    for (std::size_t k = 2; k < part.size(); ++k)
      buffer_.draw({project(part[0]), project(part[k - 1]), project(part[k])}, id);
  }

  DepthBuffer buffer_;
  Vector3 offset_;
  double focal_;
  std::array<double, 2> middle_;
};

/** \brief Cosine of the angle between a facet's normal, of either side, and a line. */
double
cosineTo(const Facet& f, const Vector3& line)
{
  const Vector3 n = doubledAreaNormal(f.corners[0], f.corners[1], f.corners[2]);
  return std::abs(dot(n, line)) / (norm(n) * norm(line));
}

/** \brief Does \p projector reach the point \p p of \p facet, on the side that the camera sees? */
bool
isLit(const Pinhole& projector, const Vector3& p, const Facet& facet)
{
  const Vector3 n = doubledAreaNormal(facet.corners[0], facet.corners[1], facet.corners[2]);
  if ((dot(n, p) > 0) != (dot(n, projector.lineTo(p)) > 0))
    return false;
  const auto at = projector.project(p);
  const double last_column = static_cast<double>(projector.buffer().columns() - 1),
               last_row = static_cast<double>(projector.buffer().rows() - 1);
  if (!(std::abs(2 * at.column - last_column) <= last_column + 1 &&
        std::abs(2 * at.row - last_row) <= last_row + 1))
    return false;
  const double cosine = std::min(1.0, cosineTo(facet, projector.lineTo(p)));
  const double slope = std::sqrt(1 - cosine * cosine) / std::max(cosine, 1 / kShadowSlope);
  const double allowance = kShadowPixels * p[2] / projector.focal() * (slope + 0.1);
  const auto neighbours = [](double v, double last) {
    return std::array<std::size_t, 2>{
        static_cast<std::size_t>(std::clamp(std::floor(v), 0.0, last)),
        static_cast<std::size_t>(std::clamp(std::floor(v) + 1, 0.0, last))};
  };
  for (const std::size_t c : neighbours(at.column, last_column))
    for (const std::size_t r : neighbours(at.row, last_row))
      if (1 / projector.buffer().nearness(c, r) >= p[2] - allowance)
        return true;
  return false;
}

/** \brief Twelve uniform numbers' sum: normal to within one's eyesight, and the same bits wherever
 * it is computed, which no library's logarithm grants. */
double
standardNormal(const CounterRandom& random, std::uint64_t item)
{
  double sum = -6;
  for (std::uint64_t k = 0; k < 12; ++k)
    sum += static_cast<double>(random.at(12 * item + k) >> 11) * 0x1.0p-53;
  return sum;
}

/** \brief What becomes of the depths of one picture. 0 stands for no return. */
class Measurement {
public:
  Measurement(const DepthSensor& sensor, const Pinhole& camera, const std::vector<Facet>& facets,
              std::uint64_t seed)
      : sensor_(sensor), camera_(camera), facets_(facets), noise_(seed, kNoiseStream),
        flying_(seed, kFlyingStream), true_(sensor.columns * sensor.rows, 0)
  {
    for (std::size_t i = 0; i < true_.size(); ++i)
      if (facetAt(i))
        true_[i] = 1 / camera.buffer().nearness(i % sensor.columns, i / sensor.columns);
  }

  const Facet*
  facetAt(std::size_t i) const
  {
    const auto id = camera_.buffer().id(i % sensor_.columns, i / sensor_.columns);
    return id == DepthBuffer::nothing ? nullptr : &facets_[id];
  }
  Vector3
  rayOf(std::size_t i) const
  {
    return camera_.ray(i % sensor_.columns, i / sensor_.columns);
  }

  /** \brief Does the surface at pixel \p i send anything back? */
  bool
  returns(std::size_t i, const Pinhole* projector) const
  {
    const Facet* facet = facetAt(i);
    if (!facet || cosineTo(*facet, rayOf(i)) < std::cos(sensor_.grazing * kDegree))
      return false;
    return !projector || isLit(*projector, scaled(rayOf(i), true_[i]), *facet);
  }

  /** \brief True depth of pixel \p i, or one between both sides of an edge: then it is flying. */
  double
  depth(std::size_t i, bool& is_flying) const
  {
    const auto other = sensor_.flying > 0 ? acrossEdge(i) : i;
    is_flying = other != i && share(2 * i) < sensor_.flying;
    if (!is_flying)
      return true_[i];
    return true_[i] + share(2 * i + 1) * (true_[other] - true_[i]);
  }

  double
  disturbed(double depth, std::size_t i) const
  {
    if (sensor_.noise > 0)
      depth += sensor_.noise * std::pow(depth, sensor_.noise_power) * standardNormal(noise_, i);
    if (sensor_.quantum > 0)
      depth = std::round(depth / sensor_.quantum) * sensor_.quantum;
    return depth;
  }

private:
  double
  share(std::uint64_t k) const
  {
    return static_cast<double>(flying_.at(k) >> 11) * 0x1.0p-53;
  }

  /** \brief A neighbour of pixel \p i beyond a depth edge, or \p i itself. */
  std::size_t
  acrossEdge(std::size_t i) const
  {
    const std::size_t column = i % sensor_.columns, row = i / sensor_.columns;
    const auto isAcross = [&](bool inside, std::size_t k) {
      return inside && true_[k] > 0 && std::abs(true_[k] - true_[i]) > sensor_.edge;
    };
    if (isAcross(column > 0, i - 1))
      return i - 1;
    if (isAcross(column + 1 < sensor_.columns, i + 1))
      return i + 1;
    if (isAcross(row > 0, i - sensor_.columns))
      return i - sensor_.columns;
    return isAcross(row + 1 < sensor_.rows, i + sensor_.columns) ? i + sensor_.columns : i;
  }

  const DepthSensor& sensor_;
  const Pinhole& camera_;
  const std::vector<Facet>& facets_;
  CounterRandom noise_, flying_;
  std::vector<double> true_;
};

DepthScan
emptyScan(const DepthSensor& sensor, const SensorFrame& frame)
{
  DepthScan scan;
  scan.frame = frame;
  scan.columns = sensor.columns;
  scan.rows = sensor.rows;
  const std::size_t pixels = sensor.columns * sensor.rows;
  for (auto* v : {&scan.x, &scan.y, &scan.z})
    v->assign(pixels, std::numeric_limits<float>::quiet_NaN());
  for (auto* v : {&scan.labels, &scan.instances})
    v->assign(pixels, 0);
  return scan;
}

} // namespace

DepthScan
sense(const std::vector<SensedBody>& bodies, const DepthSensor& sensor, const SensorPose& pose,
      std::uint64_t seed)
{
  check(sensor);
  const SensorFrame frame(pose);
  const auto facets = facetsOf(bodies, frame);
  const Pinhole camera(sensor, 0, facets);
  std::vector<Pinhole> projector;
  if (sensor.baseline != 0)
    projector.emplace_back(sensor, sensor.baseline, facets);
  const Measurement measurement(sensor, camera, facets, seed);

  DepthScan scan = emptyScan(sensor, frame);
  for (std::size_t i = 0; i < scan.z.size(); ++i) {
    if (!measurement.returns(i, projector.empty() ? nullptr : projector.data()))
      continue;
    bool is_flying = false;
    const double depth = measurement.disturbed(measurement.depth(i, is_flying), i);
    if (!(depth > 0))
      continue;
    const auto p = toFloat3(scaled(measurement.rayOf(i), depth));
    scan.x[i] = p[0];
    scan.y[i] = p[1];
    scan.z[i] = p[2];
    if (is_flying)
      continue;
    const SensedBody& body = bodies[measurement.facetAt(i)->body];
    scan.labels[i] = body.label;
    scan.instances[i] = body.instance;
  }
  return scan;
}

} // namespace pcl_surflet
