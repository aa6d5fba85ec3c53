#include "evaluation/scoring.h"

#include "app_common.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr double kNormal95 = 1.959964;

/** \brief Cells of a cluster per instance. */
std::map<std::uint32_t, std::size_t>
instancesOf(const CellScene& scene, const Detection& d)
{
  std::map<std::uint32_t, std::size_t> cells;
  for (const auto i : d.cells)
    ++cells[scene.instance[i]];
  return cells;
}

/** \brief Is there a detection of the item's name whose centre is within half r_mean of its? */
bool
isCentred(const PlacedItem& item, const std::vector<Detection>& detections)
{
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& d) {
    const double distance =
        std::hypot(d.centre[0] - item.centroid[0], d.centre[1] - item.centroid[1],
                   d.centre[2] - item.centroid[2]);
    return d.label == item.label && !d.cells.empty() && distance <= item.r_mean / 2;
  });
}

std::string
row(const std::string& label, const Counts& c)
{
  const Rate right = rateOf(c.right, c.clusters), strict = rateOf(c.strict, c.clusters),
             recall = rateOf(c.found, c.present), centre = rateOf(c.centred, c.present);
  char text[256];
  std::snprintf(text, sizeof(text),
                "%-12.12s %7zu %8zu   %5.1f [%5.1f,%5.1f]  %5.1f [%5.1f,%5.1f]  %5.1f  %5.1f "
                "[%5.1f,%5.1f]  %5.1f\n",
                label.c_str(), c.present, c.clusters, right.percent, right.low, right.high,
                strict.percent, strict.low, strict.high, rateOf(c.right_cells, c.cells).percent,
                recall.percent, recall.low, recall.high, centre.percent);
  return text;
}

} // namespace

CellScene
withTruth(const CellReduction& reduction, const Scene& scene)
{
  CellScene out;
  out.cells = reduction.cells;
  out.items = scene.items;
  // Instances come one after the other in a scene, so one running count a cell is enough.
  struct Tally {
    std::uint32_t instance = 0, count = 0, best = 0;
  };
  std::vector<Tally> tallies(out.cells.size());
  out.instance.resize(out.cells.size());
  for (std::size_t i = 0; i < scene.surflets.size(); ++i) {
    const auto cell = reduction.cell_of[i];
    if (cell == CellReduction::no_cell)
      continue;
    Tally& t = tallies[cell];
    if (t.instance != scene.instances[i])
      t = {scene.instances[i], 0, t.best};
    if (++t.count > t.best) {
      t.best = t.count;
      out.instance[cell] = t.instance;
    }
  }
  return out;
}

std::string
truthOf(const CellScene& scene, const Detection& d)
{
  std::size_t most = 0;
  std::uint32_t best = 0;
  for (const auto& [instance, cells] : instancesOf(scene, d))
    if (cells > most) {
      most = cells;
      best = instance;
    }
  return best == 0 ? "background" : scene.items[best - 1].label;
}

Counts&
Counts::operator+=(const Counts& o)
{
  present += o.present;
  found += o.found;
  clusters += o.clusters;
  right += o.right;
  strict += o.strict;
  doubles += o.doubles;
  centred += o.centred;
  cells += o.cells;
  right_cells += o.right_cells;
  return *this;
}

Rate
rateOf(std::size_t hits, std::size_t trials)
{
  if (trials == 0)
    return {0, 0, 100};
  const double n = static_cast<double>(trials), p = static_cast<double>(hits) / n;
  const double z2 = kNormal95 * kNormal95;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kNormal95 * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n)) / (1 + z2 / n);
  return {100 * p, 100 * std::max(0.0, centre - half), 100 * std::min(1.0, centre + half)};
}

Rate
precisionOf(const Counts& c)
{
  return rateOf(c.strict - c.doubles, c.clusters);
}

double
recallTimesPrecision(const Counts& c)
{
  return rateOf(c.found, c.present).percent * precisionOf(c).percent / 100;
}

Score::Score(std::vector<std::string> labels) : labels_(std::move(labels)), counts_(labels_.size())
{
}

void
Score::add(const CellScene& scene, const std::vector<Detection>& detections)
{
  ++scenes_;
  const auto isLabel = [&](std::uint32_t instance, const std::string& label) {
    return instance > 0 && scene.items[instance - 1].label == label;
  };
  for (const auto& item : scene.items)
    for (std::size_t m = 0; m < labels_.size(); ++m)
      if (!item.clutter && item.label == labels_[m]) {
        ++counts_[m].present;
        counts_[m].centred += isCentred(item, detections) ? 1 : 0;
      }
  std::vector<char> found(scene.items.size() + 1, 0);
  for (const auto& d : detections) {
    Counts& c = counts_[d.model];
    ++c.clusters;
    std::size_t right = 0;
    for (const auto& [instance, cells] : instancesOf(scene, d)) {
      right += isLabel(instance, d.label) ? cells : 0;
      if (2 * cells <= d.cells.size() || !isLabel(instance, d.label))
        continue;
      ++c.strict;
      ++(found[instance] ? c.doubles : c.found);
      found[instance] = 1;
    }
    c.right += right > 0 ? 1 : 0;
    c.cells += right > 0 ? d.cells.size() : 0;
    c.right_cells += right;
  }
}

Counts
Score::all() const
{
  Counts sum;
  for (const auto& c : counts_)
    sum += c;
  return sum;
}

double
Score::falsePerScene() const
{
  const Counts sum = all();
  return scenes_ == 0 ? 0
                      : static_cast<double>(sum.clusters - sum.strict + sum.doubles) /
                            static_cast<double>(scenes_);
}

std::string
Score::table() const
{
  std::string text = "object       present clusters   classification %     strict %             "
                     "acc.   recall %              centre %\n";
  for (std::size_t m = 0; m < labels_.size(); ++m)
    if (counts_[m].present + counts_[m].clusters > 0)
      text += row(labels_[m], counts_[m]);
  const Counts sum = all();
  text += row("all", sum);
  text += "precision " + number(precisionOf(sum).percent) + " %, recall times precision " +
          number(recallTimesPrecision(sum)) + " %, false clusters a scene " +
          number(falsePerScene()) + " (" + std::to_string(scenes_) +
          " scenes; in brackets: 95 % confidence)\n";
  return text;
}

std::string
Score::csvHeader()
{
  std::string text = "object,present,found,clusters,right,strict,doubles,cells,right_cells";
  for (const std::string rate : {"classification", "strict_rate", "recall", "precision"})
    text += "," + rate + "," + rate + "_low," + rate + "_high";
  return text +
         ",accuracy,recall_times_precision,false_per_scene,centred,centre,centre_low,centre_high";
}

std::string
Score::csv(const std::string& prefix) const
{
  const auto line = [&](const std::string& label, const Counts& c) {
    std::string text = prefix + csvField(label);
    for (const auto v :
         {c.present, c.found, c.clusters, c.right, c.strict, c.doubles, c.cells, c.right_cells})
      text += "," + std::to_string(v);
    for (const Rate& r : {rateOf(c.right, c.clusters), rateOf(c.strict, c.clusters),
                          rateOf(c.found, c.present), precisionOf(c)})
      text += "," + number(r.percent) + "," + number(r.low) + "," + number(r.high);
    const Rate centre = rateOf(c.centred, c.present);
    const auto wrong = static_cast<double>(c.clusters - c.strict + c.doubles);
    return text + "," + number(rateOf(c.right_cells, c.cells).percent) + "," +
           number(recallTimesPrecision(c)) + "," +
           number(scenes_ == 0 ? 0 : wrong / static_cast<double>(scenes_)) + "," +
           std::to_string(c.centred) + "," + number(centre.percent) + "," + number(centre.low) +
           "," + number(centre.high) + "\n";
  };
  std::string text;
  for (std::size_t m = 0; m < labels_.size(); ++m)
    text += line(labels_[m], counts_[m]);
  return text + line("all", all());
}

double
medianOf(std::vector<double> values)
{
  if (values.empty())
    return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace apps
} // namespace pcl_surflet
