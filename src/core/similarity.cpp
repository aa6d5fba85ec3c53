#include "pcl_surflet/core/similarity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace {

/** \brief Sums \p term (H(b), Q(b)) over all bins. */
template <class Term>
double
sumOverBins(const Histogram& h, const Histogram& q, const Term& term)
{
  double sum = 0;
  for (std::size_t b = 0; b < h.size(); ++b)
    sum += term(h[b], q[b]);
  return sum;
}

double
square(double v)
{
  return v * v;
}

} // namespace

bool
smallerIsBetter(Criterion c)
{
  return c != Criterion::Intersection && c != Criterion::Likelihood;
}

const char*
criterionName(Criterion c)
{
  static const char* const names[] = {"euclidean", "intersection", "chi1",      "chi2",
                                      "kullback",  "likelihood",   "normalized"};
  return names[static_cast<int>(c)];
}

const std::vector<Criterion>&
allCriteria()
{
  static const std::vector<Criterion> all = {
      Criterion::SquaredEuclidean,    Criterion::Intersection,    Criterion::ChiSquared1,
      Criterion::ChiSquared2,         Criterion::KullbackLeibler, Criterion::Likelihood,
      Criterion::NormalizedLikelihood};
  return all;
}

std::optional<Criterion>
criterionByName(const std::string& name)
{
  for (const auto c : allCriteria())
    if (name == criterionName(c))
      return c;
  return std::nullopt;
}

double
squaredEuclidean(const Histogram& h, const Histogram& q)
{
  return sumOverBins(h, q, [](double hb, double qb) { return square(hb - qb); }); // Eq. 3.5
}

double
intersection(const Histogram& h, const Histogram& q)
{
  return sumOverBins(h, q, [](double hb, double qb) { return std::min(hb, qb); }); // Eq. 3.7
}

double
chiSquared1(const Histogram& h, const Histogram& q)
{
  return sumOverBins(h, q, [](double hb, double qb) { return square(hb - qb) / hb; }); // Eq. 3.9
}

double
chiSquared2(const Histogram& h, const Histogram& q)
{
  return sumOverBins(h, q, [](double hb, double qb) { // Eq. 3.10
    return hb + qb > 0 ? square(hb - qb) / (hb + qb) : 0.0;
  });
}

double
kullbackLeibler(const Histogram& h, const Histogram& q, double h_min)
{
  return sumOverBins(h, q, [h_min](double hb, double qb) { // Eq. 3.14
    return qb > 0 ? (qb - hb) * std::log(qb / hb) : hb * std::log(hb / h_min);
  });
}

double
meanLogLikelihood(const Histogram& log_h, const Histogram& q)
{
  return sumOverBins(log_h, q, [](double l, double qb) { return qb * l; }); // Eq. 3.17 / n
}

double
smallestPositive(const Histogram& h)
{
  double smallest = 0;
  for (const double v : h)
    if (v > 0 && (smallest == 0 || v < smallest))
      smallest = v;
  return smallest;
}

Histogram
penalize(const Histogram& h, double h_min)
{
  if (!(h_min > 0) || !(h_min * static_cast<double>(h.size()) < 1))
    throw std::invalid_argument("pcl_surflet: the penalty must be positive and below 1 / bins");
  double mass = 0, raised = 0;
  for (const double v : h) {
    if (v < h_min)
      raised += h_min; // Eq. 3.21
    else
      mass += v;
  }
  const double factor = mass > 0 ? (1 - raised) / mass : 0; // Eq. 3.22: 1 - eta h_min
  Histogram out(h.size());
  std::transform(h.begin(), h.end(), out.begin(),
                 [&](double v) { return v < h_min ? h_min : v * factor; });
  return out;
}

} // namespace pcl_surflet
