#include "division.h"

#include "pcl_surflet/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

/** \brief Explanations of one model that share this part of the smaller one's cells are one. */
constexpr double kSameExplanation = 0.6;
constexpr double kStrangers = 0.3; ///< share of other cells among which an object is alone
constexpr unsigned kPolishings = 2;
constexpr double kFirstChosen = 0.7; ///< share of the work, about

/** \brief The choice of explanations: cells explained, weighed by how much better than junk. */
class Choice {
public:
  explicit Choice(Explaining& work) : work_(work), division_(work) {}

  const std::vector<Explanation>&
  chosen() const
  {
    return chosen_;
  }
  void add(const std::vector<Explanation>& candidates);
  void polish();
  bool exchangeWeak(const std::vector<Segment>& candidates);
  void dropWorthless(double least_fit);
  std::vector<char> taken(std::size_t but = ~std::size_t{0}) const;

private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  double worth(const Explanation& e) const;
  double value() const;
  std::vector<std::size_t> meeting(const std::vector<const Explanation*>& set,
                                   std::size_t but) const;
  bool change(const Explanation* added, std::size_t removed, bool if_better);
  bool isAlone(const Explanation& e) const;
  std::vector<Segment> rivalsOf(const Explanation& e, const std::vector<Segment>& all) const;

  Explaining& work_;
  Division division_;
  std::vector<Explanation> chosen_;
};

double
Choice::worth(const Explanation& e) const
{
  return e.cells.size() < work_.parameters.steps.min_cluster
             ? 0
             : static_cast<double>(e.cells.size()) * (e.fit - work_.parameters.junk_fit);
}

double
Choice::value() const
{
  double sum = 0;
  for (const auto& e : chosen_)
    sum += worth(e);
  return sum;
}

/** \brief Numbers of the chosen that may share cells with one of \p set, ascending. */
std::vector<std::size_t>
Choice::meeting(const std::vector<const Explanation*>& set, std::size_t but) const
{
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < chosen_.size(); ++k)
    if (k != but && std::any_of(set.begin(), set.end(), [&](const Explanation* e) {
          return distance(e->centre, chosen_[k].centre) <= e->reach + chosen_[k].reach;
        }))
      found.push_back(k);
  return found;
}

/** \brief Adds an explanation, or removes one, and divides the cells anew: unless the sum of worths
 * does not grow, if that is asked. \return whether it was done
 *
 * What shares no cells with it does not change. What shares some may lose them or get them back;
 * what shares cells with these takes part in the division, but cannot change either. */
bool
Choice::change(const Explanation* added, std::size_t removed, bool if_better)
{
  const auto near = meeting({added != nullptr ? added : &chosen_[removed]}, removed);
  std::vector<const Explanation*> affected;
  std::vector<Explanation> trial;
  double gain = removed != kNone ? -worth(chosen_[removed]) : 0;
  for (const auto k : near) {
    affected.push_back(&chosen_[k]);
    trial.push_back(chosen_[k]);
    gain -= worth(chosen_[k]);
  }
  if (added != nullptr)
    trial.push_back(*added);
  const std::size_t active = trial.size();
  for (const auto k : meeting(affected, removed))
    if (!std::binary_search(near.begin(), near.end(), k))
      trial.push_back(chosen_[k]);
  division_.divide(trial, active, false);
  for (std::size_t i = 0; i < active; ++i)
    gain += worth(trial[i]);
  if (if_better && gain <= 0)
    return false;
  for (std::size_t i = 0; i < near.size(); ++i)
    chosen_[near[i]] = std::move(trial[i]);
  if (added != nullptr)
    chosen_.push_back(std::move(trial[active - 1]));
  if (removed != kNone)
    chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(removed));
  return true;
}

/** \brief Takes explanations out as long as the others do better without one. */
void
Choice::dropWorthless(double least_fit)
{
  for (std::size_t k = 0; k < chosen_.size();)
    k = change(nullptr, k, chosen_[k].fit >= least_fit) ? 0 : k + 1;
}

/** \brief Tries the candidates, best fit first; each stays if all together explain more with it. */
void
Choice::add(const std::vector<Explanation>& candidates)
{
  for (const auto& e : candidates) {
    ModelDiagnostics& d = work_.diagnosticsOf(e.model);
    ++d.explanations;
    if (e.fit < work_.parameters.junk_fit) {
      ++d.died_fit;
      continue;
    }
    change(&e, kNone, true);
  }
  dropWorthless(work_.parameters.junk_fit);
}

/** \brief Looks for supporters of what has been chosen again, now that its cells are its own. */
void
Choice::polish()
{
  const auto& p = work_.parameters;
  for (unsigned round = 0; round < kPolishings; ++round) {
    parallelFor(chosen_.size(), p.steps.threads, [&](std::size_t k, unsigned worker) {
      Explanation& e = chosen_[k];
      SupportMemory& memory = work_.memory[worker];
      e.centre = centroidOf(work_.scene.cells, e.cells);
      e.reach = work_.radiusOf(e.model);
      const Indices ball = cellsWithin(work_.open, e.centre, e.reach, memory.ranges);
      supportOf(work_.scene, work_.scene.models.all[e.model], ball, e.cells, p.probes, memory,
                e.supported);
    });
    division_.divide(chosen_, chosen_.size(), round + 1 == kPolishings);
    chosen_.erase(
        std::remove_if(chosen_.begin(), chosen_.end(),
                       [&](const Explanation& e) { return e.cells.size() < p.steps.min_cluster; }),
        chosen_.end());
  }
  dropWorthless(work_.parameters.junk_fit);
}

/** \brief Cells of all that has been chosen \p but one. */
std::vector<char>
Choice::taken(std::size_t but) const
{
  std::vector<char> taken(work_.scene.cells.size(), 0);
  for (std::size_t k = 0; k < chosen_.size(); ++k)
    if (k != but)
      for (const auto i : chosen_[k].cells)
        taken[i] = 1;
  return taken;
}

/** \brief Other models to be tried in place of \p e: those that the scan found nearby, and all
 * where \p e is and where the middle of the open cells about it is, as what the scan saw there may
 * have been hidden by neighbours that have been explained since. */
std::vector<Segment>
Choice::rivalsOf(const Explanation& e, const std::vector<Segment>& all) const
{
  std::vector<Segment> rivals;
  const double reach = work_.scene.models.all[e.model].model->r_max;
  for (const auto& s : all)
    if (s.model != e.model && distance(s.centre, e.centre) < reach)
      rivals.push_back(s);
  std::vector<PlaceRange> ranges;
  for (std::size_t k = 0; k < work_.scene.models.objects; ++k) {
    if (k == e.model)
      continue;
    Segment s;
    s.model = k;
    s.centre = e.centre;
    rivals.push_back(s);
    const Indices about = cellsWithin(work_.open, e.centre, work_.radiusOf(k), ranges);
    if (about.empty())
      continue;
    s.centre = centroidOf(work_.scene.cells, about);
    rivals.push_back(std::move(s));
  }
  return rivals;
}

/** \brief Are nearly all cells where the model is its own? Then nothing else can be there. */
bool
Choice::isAlone(const Explanation& e) const
{
  std::vector<PlaceRange> ranges;
  const Indices ball = cellsWithin(work_.open, e.centre, work_.radiusOf(e.model), ranges);
  return static_cast<double>(ball.size()) < (1 + kStrangers) * static_cast<double>(e.cells.size());
}

/** \brief Tries what else could explain the cells of a weak explanation: a large model that fits
 * two objects a little may have been there before either of them. \return whether it changed */
bool
Choice::exchangeWeak(const std::vector<Segment>& candidates)
{
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    if (chosen_[k].fit >= work_.parameters.strong_fit || isAlone(chosen_[k]))
      continue;
    work_.openExcept(taken(k));
    const auto others = lookClosely(work_, rivalsOf(chosen_[k], candidates));
    work_.openExcept(std::vector<char>(work_.scene.cells.size(), 0));
    const auto before = chosen_;
    const double value_before = value();
    change(nullptr, k, false);
    add(others);
    if (value() > value_before)
      return true;
    chosen_ = before;
  }
  return false;
}

} // namespace

/** \brief Keeps the best of explanations of one model by much the same cells. */
std::vector<Explanation>
withoutRepetitions(std::vector<Explanation> all, std::size_t cells)
{
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.fit > b.fit; });
  std::vector<char> mark(cells, 0);
  std::vector<Explanation> kept;
  for (auto& e : all) {
    if (e.cells.empty())
      continue;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Explanation& k) {
      if (k.model != e.model)
        return false;
      for (const auto i : k.cells)
        mark[i] = 1;
      std::size_t both = 0;
      for (const auto i : e.cells)
        both += mark[i];
      for (const auto i : k.cells)
        mark[i] = 0;
      return static_cast<double>(both) >
             kSameExplanation * static_cast<double>(std::min(e.cells.size(), k.cells.size()));
    });
    if (!known)
      kept.push_back(std::move(e));
  }
  return kept;
}

std::vector<Explanation>
lookClosely(Explaining& work, const std::vector<Segment>& rough)
{
  std::vector<Explanation> all(rough.size());
  parallelFor(rough.size(), work.parameters.steps.threads, [&](std::size_t i, unsigned worker) {
    all[i] = lookClosely(work, rough[i], work.memory[worker]);
    if (!all[i].cells.empty())
      judge(work, all[i]);
  });
  return withoutRepetitions(std::move(all), work.scene.cells.size());
}

std::vector<Explanation>
choose(Explaining& work, const std::vector<Segment>& candidates)
{
  Choice choice(work);
  choice.add(lookClosely(work, candidates));
  choice.polish();
  double done = kFirstChosen;
  for (unsigned round = 1; round < work.parameters.rounds && work.progress.goesOn(done); ++round) {
    done = (done + 1) / 2;
    const std::size_t before = choice.chosen().size();
    work.openExcept(choice.taken());
    // Places that two objects shared may lie between them: what is left is scanned afresh.
    auto places = candidates;
    const auto left = scan(work);
    places.insert(places.end(), left.begin(), left.end());
    const auto rest = lookClosely(work, places);
    work.openExcept(std::vector<char>(work.scene.cells.size(), 0));
    choice.add(rest);
    if (choice.chosen().size() != before)
      choice.polish();
    const bool changed = choice.exchangeWeak(candidates);
    if (changed)
      choice.polish();
    else if (choice.chosen().size() == before)
      break;
  }
  choice.dropWorthless(work.parameters.min_fit);
  return choice.chosen();
}

} // namespace interpretation
} // namespace pcl_surflet
