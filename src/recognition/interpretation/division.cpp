#include "division.h"

#include "pcl_surflet/core/parallel.h"

#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

constexpr std::uint64_t kFitStream = std::uint64_t{3} << 40;
/** \brief An explanation that gained or lost less than this share of its cells keeps its fit. */
constexpr double kSameCells = 0.02;

} // namespace

void
judge(const Explaining& work, Explanation& e)
{
  const auto& p = work.parameters;
  Overlap overlap;
  if (e.cells.size() >= p.steps.min_cluster)
    overlap = fitOf(work.scene, work.scene.models.all[e.model], e.cells, p.features,
                    p.steps.seed ^ kFitStream);
  e.fit = overlap.share;
  e.member = overlap.member;
}

void
Division::divide(std::vector<Explanation>& set, std::size_t active, bool all)
{
  for (std::uint32_t k = 0; k < set.size(); ++k)
    for (const auto& s : set[k].supported)
      if (s.support > best_[s.cell]) {
        best_[s.cell] = s.support;
        owner_[s.cell] = k;
      }
  std::vector<std::size_t> changed;
  for (std::uint32_t k = 0; k < active; ++k) {
    Indices own;
    for (const auto& s : set[k].supported)
      if (owner_[s.cell] == k)
        own.push_back(s.cell);
    const double before = static_cast<double>(set[k].cells.size());
    if (all || std::abs(static_cast<double>(own.size()) - before) > kSameCells * before)
      changed.push_back(k);
    set[k].cells = std::move(own);
  }
  for (const auto& e : set)
    for (const auto& s : e.supported) {
      best_[s.cell] = 0;
      owner_[s.cell] = kNobody;
    }
  parallelFor(changed.size(), work_.parameters.steps.threads,
              [&](std::size_t i, unsigned) { judge(work_, set[changed[i]]); });
}

} // namespace interpretation
} // namespace pcl_surflet
