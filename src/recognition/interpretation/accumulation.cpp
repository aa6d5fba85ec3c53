#include "steps.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/recognition/scene_accumulation.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace pcl_surflet {
namespace {

using interpretation::common;
using interpretation::Indices;
using interpretation::united;

/** \brief A detection and the run that made it. */
struct Vote {
  std::size_t run = 0;
  const Detection* detection = nullptr;
};

/** \brief Detections of one object at one place. */
struct Hypothesis {
  std::vector<Vote> votes; ///< in the order of the runs
  Indices cells;           ///< of all of them
  std::size_t runs = 0;    ///< different ones among the votes
  Detection result;

  std::size_t
  model() const
  {
    return votes.front().detection->model;
  }
};

using Hypotheses = std::vector<Hypothesis>;

void
check(const AccumulationParameters& p)
{
  const auto require = [](bool holds, const char* what) {
    if (!holds)
      throw std::invalid_argument(std::string("pcl_surflet: ") + what);
  };
  require(p.runs > 0, "runs must be positive");
  require(p.min_overlap >= 0 && p.min_overlap < 1, "min_overlap must be in [0, 1)");
  require(p.min_votes >= 0 && p.min_votes <= 1, "min_votes must be in [0, 1]");
  require(p.min_cell_share >= 0 && p.min_cell_share <= 1, "min_cell_share must be in [0, 1]");
}

void
checkCells(const SurfletSet& cells, const std::vector<SceneInterpretation>& runs)
{
  for (const auto& run : runs)
    for (const auto& d : run.detections)
      for (const auto cell : d.cells)
        if (cell >= cells.size())
          throw std::invalid_argument(
              "pcl_surflet: a detection has cells that the scene lacks: are "
              "the runs of other cells?");
}

bool
overlap(const Indices& a, const Indices& b, double least)
{
  const auto smaller = static_cast<double>(std::min(a.size(), b.size()));
  return static_cast<double>(common(a, b).size()) > least * smaller;
}

/** \brief Adds a vote; hypotheses that it connects become one. */
void
add(const Vote& vote, double min_overlap, Hypotheses& all)
{
  Hypothesis joined;
  joined.cells = vote.detection->cells;
  Hypotheses others;
  for (auto& h : all) {
    if (h.model() != vote.detection->model ||
        !overlap(h.cells, vote.detection->cells, min_overlap)) {
      others.push_back(std::move(h));
      continue;
    }
    joined.votes.insert(joined.votes.end(), h.votes.begin(), h.votes.end());
    joined.cells = united(joined.cells, h.cells);
  }
  joined.votes.push_back(vote);
  std::stable_sort(joined.votes.begin(), joined.votes.end(),
                   [](const Vote& a, const Vote& b) { return a.run < b.run; });
  others.push_back(std::move(joined));
  all = std::move(others);
}

/** \brief Sets of cells are compared in their order, which not every caller keeps. */
std::vector<SceneInterpretation>
withAscendingCells(std::vector<SceneInterpretation> runs)
{
  for (auto& run : runs)
    for (auto& d : run.detections)
      std::sort(d.cells.begin(), d.cells.end());
  return runs;
}

Hypotheses
hypothesesOf(const std::vector<SceneInterpretation>& runs, double min_overlap)
{
  Hypotheses all;
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const auto& d : runs[k].detections)
      add({k, &d}, min_overlap, all);
  return all;
}

/** \brief Counts the votes; name, score, fit and seeds follow from them. */
void
count(std::size_t runs, Hypothesis& h)
{
  Detection& d = h.result;
  d.model = h.model();
  d.label = h.votes.front().detection->label;
  d.margin = 0;
  std::vector<char> seen(runs, 0);
  for (const auto& v : h.votes) {
    seen[v.run] = 1;
    d.score += v.detection->score / static_cast<double>(h.votes.size());
    d.margin += v.detection->margin / static_cast<double>(h.votes.size());
    d.fit += v.detection->fit / static_cast<double>(h.votes.size());
    d.seeds += v.detection->seeds;
  }
  h.runs = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 1));
  d.votes = static_cast<double>(h.runs) / static_cast<double>(runs);
}

/** \brief Those of enough votes that have no stronger rival, the strongest first. */
Hypotheses
elected(Hypotheses all, const AccumulationParameters& p)
{
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return std::make_tuple(a.runs, a.result.fit, a.result.score) >
           std::make_tuple(b.runs, b.result.fit, b.result.score);
  });
  Hypotheses kept;
  for (auto& h : all) {
    const bool loses = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& k) {
      return overlap(k.cells, h.cells, p.min_overlap);
    });
    if (!loses && h.result.votes >= p.min_votes)
      kept.push_back(std::move(h));
  }
  return kept;
}

/** \brief Gives every cell to the hypothesis that most runs gave it to, if they are enough. */
void
shareCells(std::size_t cells, double min_share, Hypotheses& all)
{
  std::vector<std::uint32_t> most(cells, 0);
  std::vector<std::size_t> owner(cells, all.size());
  std::vector<std::uint32_t> tally(cells);
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const auto cell : all[k].cells)
      tally[cell] = 0;
    for (const auto& v : all[k].votes)
      for (const auto cell : v.detection->cells)
        ++tally[cell];
    for (const auto cell : all[k].cells)
      if (tally[cell] > most[cell] && tally[cell] >= min_share * static_cast<double>(all[k].runs)) {
        most[cell] = tally[cell];
        owner[cell] = k;
      }
  }
  for (std::uint32_t cell = 0; cell < cells; ++cell)
    if (owner[cell] < all.size())
      all[owner[cell]].result.cells.push_back(cell);
}

/** \brief In the order of the models, as every interpretation has them. */
std::vector<Detection>
detectionsOf(const SurfletSet& cells, Hypotheses& all)
{
  std::vector<Detection> detections;
  for (auto& h : all) {
    if (h.result.cells.empty())
      continue;
    const auto before = h.result.centroid;
    h.result.centroid = interpretation::centroidOf(cells, h.result.cells);
    for (std::size_t a = 0; a < 3; ++a)
      h.result.centre[a] += h.result.centroid[a] - before[a];
    detections.push_back(std::move(h.result));
  }
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.model < b.model; });
  return detections;
}

bool
enough(const SceneInterpretation& merged, std::size_t wanted)
{
  std::size_t cells = 0;
  for (const auto& d : merged.detections)
    cells += d.cells.size();
  return wanted > 0 && cells >= wanted;
}

} // namespace

SceneInterpretation
mergeInterpretations(const SurfletSet& cells, const std::vector<SceneInterpretation>& runs,
                     const AccumulationParameters& parameters)
{
  check(parameters);
  checkCells(cells, runs);
  if (runs.empty())
    return {};
  if (runs.size() == 1)
    return runs.front();
  SceneInterpretation merged;
  merged.diagnostics = runs.front().diagnostics;
  const auto ascending = withAscendingCells(runs);
  for (const auto& run : runs)
    merged.diagnostics.cancelled = merged.diagnostics.cancelled || run.diagnostics.cancelled;
  if (merged.diagnostics.cancelled)
    return merged;
  Hypotheses all = hypothesesOf(ascending, parameters.min_overlap);
  for (auto& h : all)
    count(runs.size(), h);
  all = elected(std::move(all), parameters);
  shareCells(cells.size(), parameters.min_cell_share, all);
  merged.detections = detectionsOf(cells, all);
  return merged;
}

std::uint64_t
seedOfRun(std::uint64_t seed, std::size_t run)
{
  constexpr std::uint64_t kRuns = 0x72756e73ULL;
  return run == 0 ? seed : CounterRandom(seed, kRuns).at(run);
}

SceneInterpretation
accumulateInterpretations(const SurfletSet& cells,
                          const std::function<SceneInterpretation(std::uint64_t seed)>& interpret,
                          std::uint64_t seed, const AccumulationParameters& parameters,
                          const std::function<bool(std::size_t runs)>& may_go_on,
                          std::size_t* runs_made)
{
  check(parameters);
  std::vector<SceneInterpretation> runs;
  SceneInterpretation merged;
  for (std::size_t k = 0; k < parameters.runs; ++k) {
    if (k > 0 && (enough(merged, parameters.cells) || (may_go_on && !may_go_on(k))))
      break;
    runs.push_back(interpret(seedOfRun(seed, k)));
    const bool cancelled = runs.back().diagnostics.cancelled;
    if (cancelled || parameters.cells > 0)
      merged = mergeInterpretations(cells, runs, parameters);
    if (cancelled)
      break;
  }
  if (runs_made)
    *runs_made = runs.size();
  return mergeInterpretations(cells, runs, parameters);
}

} // namespace pcl_surflet
