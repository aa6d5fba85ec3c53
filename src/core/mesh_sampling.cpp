#include "vector3.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_surflet {

using detail::Vector3;

namespace {

/** \brief Keeps these draws apart from those of others that are given the same seed. */
constexpr std::uint64_t kSurfaceStream = 0x73757266616365ULL;

/** \brief Points of the dense sample per point kept. More make the thinned sample fuller and the
 * work longer; at 8 the spacing already is 95 % of that of a saturated sample. */
constexpr std::size_t kDenseFactor = 8;
constexpr std::size_t kMinDense = 512;
constexpr std::size_t kMaxTarget = std::size_t{1} << 28; ///< dense samples have 32-bit indices

/** \brief Triangles per point kept that refinement may add: a cube takes 6, needles want more. */
constexpr std::size_t kTrianglesPerPoint = 32;

constexpr int kMaxThinningSteps = 16;
constexpr double kCountTolerance = 0.05; ///< stops the search early; 20 % are promised

void
requireSound(const TriangleMesh& mesh, const char* caller)
{
  const std::string problem = mesh.problem();
  if (!problem.empty())
    throw std::invalid_argument(std::string(caller) + ": " + problem);
}

/** \brief Draws surflets of a mesh uniformly by area. */
class SurfaceSampler {
public:
  explicit SurfaceSampler(const TriangleMesh& mesh) : mesh_(mesh), normals_(umbrellaNormals(mesh))
  {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const double area = detail::norm(ownNormal(mesh.triangles[i]));
      if (!(area > 0))
        continue;
      sum += area;
      triangles_.push_back(i);
      cumulative_.push_back(sum);
    }
  }

  /** \brief The surflet at (\p a, \p b, \p c), three numbers uniform in [0, 1). */
  Surflet
  at(double a, double b, double c) const
  {
    const auto it =
        std::upper_bound(cumulative_.begin(), cumulative_.end(), a * cumulative_.back());
    const auto drawn = std::min<std::size_t>(static_cast<std::size_t>(it - cumulative_.begin()),
                                             triangles_.size() - 1);
    const auto& t = mesh_.triangles[triangles_[drawn]];
    const double s = std::sqrt(b);
    const Vector3 weights = {1 - s, s * (1 - c), s * c};
    Vector3 p = {0, 0, 0}, n = {0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      p = detail::add(p, detail::scaled(detail::toVector3(mesh_.vertices[t[k]]), weights[k]));
      n = detail::add(n, detail::scaled(detail::toVector3(normals_[t[k]]), weights[k]));
    }
    if (!(detail::norm(n) > kVanished))
      n = ownNormal(t);
    n = detail::scaled(n, 1 / detail::norm(n));
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
            static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
  }

private:
  static constexpr double kVanished = 1e-6; ///< below, a sum of unit vectors is mostly rounding

  Vector3
  ownNormal(const TriangleMesh::Triangle& t) const
  {
    return detail::doubledAreaNormal(detail::toVector3(mesh_.vertices[t[0]]),
                                     detail::toVector3(mesh_.vertices[t[1]]),
                                     detail::toVector3(mesh_.vertices[t[2]]));
  }

  const TriangleMesh& mesh_;
  std::vector<TriangleMesh::Point> normals_;
  std::vector<std::size_t> triangles_; ///< those with area
  std::vector<double> cumulative_;     ///< twice the area up to and with each of them
};

/** \brief Accepts points no two of which are closer than a radius.
 *
 * A hash grid of cells two radii wide: a ball reaches at most 8 cells (27 with cells one radius
 * wide: three times slower). Cells whose hashes collide share a bucket; the distance test sorts
 * that out, so keys are not stored. */
class DartGrid {
public:
  DartGrid(const SurfletSet& points, double radius, std::size_t expected)
      : points_(points), radius_(radius)
  {
    std::size_t buckets = 64;
    while (buckets < 2 * expected)
      buckets *= 2;
    heads_.assign(buckets, kNone);
    for (const auto* axis : {&points.x, &points.y, &points.z})
      origin_[origin_size_++] = *std::min_element(axis->begin(), axis->end());
  }

  /** \brief Keeps point \p i unless one kept before is closer than the radius. */
  void
  throwDart(std::uint32_t i)
  {
    const Vector3 p = {points_.x[i], points_.y[i], points_.z[i]};
    std::array<std::int64_t, 3> cell{}, other{};
    for (std::size_t k = 0; k < 3; ++k) {
      // A cell number that does not fit is only a slower grid, not a wrong one.
      const double g = std::min((p[k] - origin_[k]) / (2 * radius_), 1e15);
      cell[k] = static_cast<std::int64_t>(g);
      other[k] = g - static_cast<double>(cell[k]) < 0.5 ? cell[k] - 1 : cell[k] + 1;
    }
    for (unsigned corner = 0; corner < 8; ++corner)
      if (occupied(bucket((corner & 1) ? other[0] : cell[0], (corner & 2) ? other[1] : cell[1],
                          (corner & 4) ? other[2] : cell[2]),
                   p))
        return;
    auto& head = heads_[bucket(cell[0], cell[1], cell[2])];
    next_.push_back(head);
    head = static_cast<std::uint32_t>(kept_.size());
    kept_.push_back(i);
  }

  std::vector<std::uint32_t>&
  kept()
  {
    return kept_;
  }

private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::size_t
  bucket(std::int64_t a, std::int64_t b, std::int64_t c) const
  {
    const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
    return mix64(u(a) * 0x9e3779b97f4a7c15ULL ^ u(b) * 0xc2b2ae3d27d4eb4fULL ^
                 u(c) * 0x165667b19e3779f9ULL) &
           (heads_.size() - 1);
  }

  bool
  occupied(std::size_t bucket, const Vector3& p) const
  {
    for (auto k = heads_[bucket]; k != kNone; k = next_[k]) {
      const auto i = kept_[k];
      const Vector3 d = {points_.x[i] - p[0], points_.y[i] - p[1], points_.z[i] - p[2]};
      if (detail::dot(d, d) < radius_ * radius_)
        return true;
    }
    return false;
  }

  const SurfletSet& points_;
  double radius_;
  std::size_t origin_size_ = 0;
  Vector3 origin_ = {0, 0, 0};
  std::vector<std::uint32_t> heads_; ///< bucket -> position in kept_
  std::vector<std::uint32_t> next_;  ///< parallel to kept_
  std::vector<std::uint32_t> kept_;  ///< indices of the points, in the order of acceptance
};

std::vector<std::uint32_t>
thinned(const SurfletSet& dense, double radius, std::size_t expected)
{
  DartGrid grid(dense, radius, expected);
  for (std::uint32_t i = 0; i < dense.size(); ++i)
    grid.throwDart(i);
  return std::move(grid.kept());
}

/** \brief Thins \p dense to about \p target points, adjusting the radius from \p radius.
 *
 * Newton-like steps (the count of a surface goes with 1 / radius^2) inside a bracket: two or three
 * do on ordinary surfaces; bisection takes over where the law does not hold, as on needles. */
std::vector<std::uint32_t>
thinnedTo(const SurfletSet& dense, std::size_t target, double radius)
{
  const double wanted = static_cast<double>(target);
  double low = 0, high = std::numeric_limits<double>::infinity();
  double best_error = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> best;
  for (int step = 0; step < kMaxThinningSteps && best_error > kCountTolerance * wanted; ++step) {
    auto kept = thinned(dense, radius, target);
    const double count = static_cast<double>(kept.size());
    if (std::abs(count - wanted) < best_error) {
      best_error = std::abs(count - wanted);
      best = std::move(kept);
    }
    (count > wanted ? low : high) = radius;
    radius *= std::sqrt(count / wanted);
    if (!(radius > low && radius < high))
      radius = std::isinf(high) ? 2 * low : (low > 0 ? std::sqrt(low * high) : high / 2);
  }
  return best;
}

} // namespace

SurfletSet
sampleSurface(const TriangleMesh& mesh, std::size_t n, std::uint64_t seed)
{
  requireSound(mesh, "sampleSurface");
  const SurfaceSampler sampler(mesh);
  CounterRandom random(seed, kSurfaceStream);
  SurfletSet out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double a = random.uniform(), b = random.uniform(), c = random.uniform();
    out.push_back(sampler.at(a, b, c));
  }
  return out;
}

SurfletSet
sampleIsoMesh(const TriangleMesh& mesh, std::size_t target, std::uint64_t seed)
{
  requireSound(mesh, "sampleIsoMesh");
  if (target == 0)
    return {};
  if (target > kMaxTarget)
    throw std::invalid_argument("sampleIsoMesh: target " + std::to_string(target) + " exceeds " +
                                std::to_string(kMaxTarget));
  const double spacing = std::sqrt(surfaceArea(mesh) / static_cast<double>(target));
  const TriangleMesh refined =
      refineEdges(mesh, spacing, mesh.triangles.size() + kTrianglesPerPoint * target);
  const SurfletSet dense = sampleSurface(refined, std::max(kDenseFactor * target, kMinDense), seed);
  // Random disks of diameter r saturate at about half of the area; a finite dense sample fills a
  // little less: r = 0.75 spacing is the right guess on smooth surfaces.
  return dense.subset(thinnedTo(dense, target, 0.75 * spacing));
}

} // namespace pcl_surflet
