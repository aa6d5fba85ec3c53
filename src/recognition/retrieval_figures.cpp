#include "pcl_surflet/recognition/retrieval_figures.h"

#include <cmath>
#include <stdexcept>

namespace pcl_surflet {
namespace {

/** \brief Adds the figures of one query with \p wanted others in its class. */
void
addQuery(RetrievalFigures& sum, const std::string& own, const std::vector<std::string>& ranked,
         std::size_t wanted)
{
  const auto all = static_cast<double>(wanted);
  std::size_t found = 0, level = 0;
  for (std::size_t place = 1; place <= ranked.size() && found < wanted; ++place) {
    if (ranked[place - 1] != own)
      continue;
    ++found;
    sum.nearest_neighbour += place == 1;
    sum.first_tier += place <= wanted ? 1 / all : 0;
    sum.second_tier += place <= 2 * wanted ? 1 / all : 0;
    const double precision = static_cast<double>(found) / static_cast<double>(place);
    for (; level < sum.precision.size() && found * sum.precision.size() >= (level + 1) * wanted;
         ++level)
      sum.precision[level] += precision;
  }
  ++sum.queries;
}

} // namespace

RetrievalFigures
retrievalFigures(const std::vector<std::string>& classes,
                 const std::vector<std::vector<std::string>>& ranked,
                 const std::vector<std::size_t>& class_sizes)
{
  if (classes.size() != ranked.size() || classes.size() != class_sizes.size())
    throw std::invalid_argument("pcl_surflet: every query needs a class, its size and a ranking");
  RetrievalFigures figures;
  for (std::size_t q = 0; q < classes.size(); ++q)
    if (class_sizes[q] > 1)
      addQuery(figures, classes[q], ranked[q], class_sizes[q] - 1);
  if (figures.queries == 0)
    return figures;
  const auto n = static_cast<double>(figures.queries);
  for (double* f : {&figures.nearest_neighbour, &figures.first_tier, &figures.second_tier})
    *f /= n;
  for (double& p : figures.precision)
    p /= n;
  return figures;
}

} // namespace pcl_surflet
