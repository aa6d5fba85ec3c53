#include "experiment/chapter3.h"
#include "experiment/chapter3/curves.h"
#include "experiment/output.h"
#include "experiment/surflet_recognisers.h"
#include "pcl_surflet/core/conditions.h"
#include "pcl_surflet/core/counter_random.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

Recognisers
likelihoodOnly(const Training& training)
{
  Recognisers all;
  all.push_back(likelihoodRecogniser("likelihood", trainObjects(training)));
  return all;
}

const char* const kAxisNames[] = {"1st axis", "2nd axis", "3rd axis"};

} // namespace

std::vector<Setting>
elongationSettings(std::uint64_t intervals)
{
  std::vector<Setting> all;
  const double step = (2.0 - 0.4) / static_cast<double>(intervals);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::uint64_t i = 0; i < intervals; ++i) {
      const double low = 0.4 + step * static_cast<double>(i), x = low + step / 2;
      const auto condition = [=](std::uint64_t seed) {
        Condition c;
        c.stretch[axis] = CounterRandom(seed, 1).uniform(low, low + step);
        return c;
      };
      all.push_back(
          {kAxisNames[axis], x, formatted("%s times %.3f", kAxisNames[axis], x), condition});
    }
  return all;
}

namespace {

std::string
drawElongation(const Rates& rates, const std::string& directory)
{
  std::vector<Panel> panels;
  for (const char* axis : kAxisNames)
    panels.push_back({std::string("elongation of the ") + axis,
                      "factor",
                      {seriesCurve(rates, axis, "likelihood")},
                      {{0.5, 40, "below 40 %"}, {1.5, 70, "above 70 %"}}});
  return drawPanels(directory, "elongation", panels, 3);
}

/** \brief Least and largest factor of an axis in the multi-axial experiment. */
constexpr double kShortest = 0.2, kLongest = 2.3;

/** \brief Draws \p axes random axes' factors until the measure lies in [low, high); none if that
 * does not succeed. */
std::optional<Condition>
drawDistortion(std::size_t axes, double low, double high, std::uint64_t seed)
{
  constexpr int kDraws = 1000000; // the rarest interval, all axes at their longest, takes 1e5
  CounterRandom random(seed, 1);
  for (int draw = 0; draw < kDraws; ++draw) {
    Condition c;
    const auto odd_one = random.below(3);
    for (std::uint32_t a = 0; a < 3; ++a)
      if (axes == 3 || (axes == 1) == (a == odd_one))
        c.stretch[a] = random.uniform(kShortest, kLongest);
    const double measure = distortionMeasure(c.stretch);
    if (measure >= low && measure < high)
      return c;
  }
  return std::nullopt;
}

} // namespace

std::vector<Setting>
distortionSettings(std::uint64_t intervals)
{
  std::vector<Setting> all;
  const double low = std::sqrt(3.0) * (kShortest - 1), high = std::sqrt(3.0) * (kLongest - 1);
  const double step = (high - low) / static_cast<double>(intervals);
  for (std::size_t axes = 1; axes <= 3; ++axes)
    for (std::uint64_t i = 0; i < intervals; ++i) {
      const double from = low + step * static_cast<double>(i), to = from + step;
      const double reach = std::sqrt(static_cast<double>(axes));
      if (to <= reach * (kShortest - 1) || from >= reach * (kLongest - 1))
        continue; // so few axes cannot be distorted so much
      const std::string series = formatted("%zu ax%cs", axes, axes == 1 ? 'i' : 'e');
      all.push_back({series, from + step / 2, series + formatted(" by %+.3f", from + step / 2),
                     [=](std::uint64_t seed) { return drawDistortion(axes, from, to, seed); }});
    }
  return all;
}

namespace {

std::string
drawDistortions(const Rates& rates, const std::string& directory)
{
  const std::string label = "distortion";
  Panel mean{"Fig. 3.8: all objects", label, {seriesCurve(rates, "", "mean")}, {}};
  for (const std::string series : {"1 axis", "2 axes", "3 axes"})
    mean.curves.push_back(seriesCurve(rates, series, series));
  std::string no_picture = drawPanels(directory, "distortion", {mean}, 1);
  std::vector<Panel> panels;
  for (std::size_t o = 0; o < rates.objects.size(); ++o)
    panels.push_back({rates.objects[o].label, "", {seriesCurve(rates, "", "", o)}, {}});
  drawPanels(directory, "distortion_objects", panels, 5);
  return no_picture;
}

} // namespace

int
runElongation(const ChapterOptions& options)
{
  return reportRates({"elongation", "Fig. 3.9: elongation of one principal axis",
                      elongationSettings(options.intervals), likelihoodOnly, drawElongation},
                     options.rates);
}

int
runDistortion(const ChapterOptions& options)
{
  return reportRates({"distortion", "Fig. 3.8, 3.10-3.14: distortion of several principal axes",
                      distortionSettings(options.intervals), likelihoodOnly, drawDistortions},
                     options.rates);
}

} // namespace apps
} // namespace pcl_surflet
