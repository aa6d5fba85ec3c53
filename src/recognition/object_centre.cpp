#include "pcl_surflet/recognition/object_centre.h"

#include "core/cholesky.h"
#include "core/vector3.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_surflet {
namespace {

constexpr std::size_t kTerms = std::tuple_size<CentreWeights>::value;
/** \brief Damping as a share of the mean of the diagonal: no weight grows for a vector that hardly
 * varies. */
constexpr double kDamping = 1e-4;
constexpr double kFarthest = 2; ///< from the middle, in r_mean

using detail::Vector3;
using Indices = std::vector<std::uint32_t>;

struct Terms {
  Vector3 middle{};
  std::array<Vector3, kTerms> vectors{}; ///< in r_mean
};

void
accumulate(Vector3& sum, const Vector3& v, double weight)
{
  for (std::size_t a = 0; a < 3; ++a)
    sum[a] += weight * v[a];
}

/** \brief Means of positions and normals. */
void
addMeans(const SurfletSet& cells, const Indices& of, Vector3& place, Vector3& normal)
{
  const double share = 1.0 / static_cast<double>(of.size());
  for (const auto i : of) {
    accumulate(place, {cells.x[i], cells.y[i], cells.z[i]}, share);
    accumulate(normal, {cells.nx[i], cells.ny[i], cells.nz[i]}, share);
  }
}

Terms
termsOf(const SurfletSet& cells, const Indices& of, double r_mean)
{
  Terms t;
  Vector3 normal{};
  addMeans(cells, of, t.middle, normal);
  const double share = 1.0 / static_cast<double>(of.size());
  for (const auto i : of) {
    const Vector3 n = {cells.nx[i], cells.ny[i], cells.nz[i]};
    const Vector3 d = {(cells.x[i] - t.middle[0]) / r_mean, (cells.y[i] - t.middle[1]) / r_mean,
                       (cells.z[i] - t.middle[2]) / r_mean};
    const double length = std::sqrt(detail::dot(d, d)), along = detail::dot(n, d);
    accumulate(t.vectors[0], n, share);
    accumulate(t.vectors[1], n, share * length);
    accumulate(t.vectors[2], d, share * length * length);
    accumulate(t.vectors[3], n, share * along);
    accumulate(t.vectors[4], d, share * along);
    accumulate(t.vectors[5], d, share * along * along);
    accumulate(t.vectors[6], d, share * detail::dot(n, normal));
  }
  return t;
}

} // namespace

void
ObjectCentre::learn(const SurfletSet& seen, const std::array<double, 3>& centre)
{
  Indices all(seen.size());
  std::iota(all.begin(), all.end(), 0U);
  const Terms t = termsOf(seen, all, r_mean_);
  Vector3 wanted{};
  for (std::size_t a = 0; a < 3; ++a)
    wanted[a] = (centre[a] - t.middle[a]) / r_mean_;
  for (std::size_t i = 0; i < kTerms; ++i) {
    right_[i] += detail::dot(t.vectors[i], wanted);
    for (std::size_t j = 0; j <= i; ++j)
      matrix_[i][j] += detail::dot(t.vectors[i], t.vectors[j]);
  }
}

CentreWeights
ObjectCentre::weights() const
{
  double trace = 0;
  for (std::size_t i = 0; i < kTerms; ++i)
    trace += matrix_[i][i];
  return solvedByCholesky<kTerms>(matrix_, right_, kDamping * trace / kTerms);
}

std::array<double, 3>
ObjectCentre::guess(const SurfletSet& cells, const Indices& of, double r_mean,
                    const CentreWeights& weights)
{
  if (of.empty())
    return {};
  const Terms t = termsOf(cells, of, r_mean);
  if (!(r_mean > 0))
    return t.middle;
  Vector3 offset{};
  for (std::size_t i = 0; i < kTerms; ++i)
    accumulate(offset, t.vectors[i], weights[i]);
  const double length = std::hypot(offset[0], offset[1], offset[2]);
  if (!std::isfinite(length)) // weights near the largest number
    return t.middle;
  Vector3 centre = t.middle;
  accumulate(centre, offset, r_mean * kFarthest / std::max(length, kFarthest));
  return centre;
}

} // namespace pcl_surflet
