#include "floating_seeds.h"

#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

double
sigmoid(double x)
{
  return 1 / (1 + std::exp(-x));
}

/** \brief lambda / (1 + lambda)^2 for lambda = exp(-x), which does not overflow. */
double
sigmoidSlope(double x)
{
  const double value = sigmoid(x);
  return value * (1 - value);
}

Place
difference(const Place& a, const Place& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double
lengthOf(const Place& a)
{
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

} // namespace

SeedEnergy::SeedEnergy(double r_min, double r_max, double s)
    : r_min_(r_min), r_max_(r_max), s_(s), norm_(1)
{
  norm_ = potential((r_min + r_max) / 2); // Eq. 6.7
}

double
SeedEnergy::potential(double delta) const
{
  const double e_min = sigmoid(s_ * (delta - r_min_)); // Eq. 6.3
  const double e_max = sigmoid(s_ * (r_max_ - delta)); // Eq. 6.4
  return (e_min + e_max - 1) / norm_;                  // Eq. 6.5
}

double
SeedEnergy::of(const std::vector<Place>& surflets, const Place& q) const
{
  double sum = 0;
  for (const auto& p : surflets)
    sum += potential(lengthOf(difference(p, q))); // Eq. 6.2, 6.6
  return sum;
}

Place
SeedEnergy::gradient(const std::vector<Place>& surflets, const Place& q) const
{
  Place sum{};
  for (const auto& p : surflets) {
    const Place away = difference(p, q);
    const double delta = lengthOf(away); // Eq. 6.6
    if (!(delta > 0))
      continue;
    const double of_min = sigmoidSlope(s_ * (delta - r_min_)) / delta; // Lambda_min, Eq. 6.8, 6.10
    const double of_max = sigmoidSlope(s_ * (r_max_ - delta)) / delta; // Lambda_max, Eq. 6.9, 6.11
    // Eq. 6.12 prints the descent, without s: there it only scales the step.
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += s_ * (of_max - of_min) * away[axis] / norm_;
  }
  return sum;
}

double
SeedEnergy::reach() const
{
  constexpr double kNegligible = 6.9; // sigmoid(-6.9) = 0.001
  return r_max_ + kNegligible / s_;
}

std::vector<Place>
floatSeed(const SeedEnergy& energy, const SurfletsAbout& surflets, Place start, unsigned steps)
{
  std::vector<Place> path = {start};
  for (unsigned k = 0; k < steps; ++k) {
    Place q = path.back();
    const Place uphill = energy.gradient(surflets(q), q);
    const double steepness = lengthOf(uphill);
    if (!(steepness > 0))
      break;
    for (std::size_t axis = 0; axis < 3; ++axis) // Eq. 6.13, along the direction only
      q[axis] += energy.rMin() / (k + 1) * uphill[axis] / steepness;
    path.push_back(q);
  }
  return path;
}

} // namespace interpretation
} // namespace pcl_surflet
