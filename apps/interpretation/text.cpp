#include "interpretation/text.h"

#include "app_common.h"
#include "poses.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief What printf() would print. */
[[gnu::format(printf, 1, 2)]] std::string
formatted(const char* format, ...)
{
  std::va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, arguments)), ' ');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return text;
}

/** \brief Empty for what is unknown: NaN is no number of a table. */
std::string
numberOrNothing(double value)
{
  return std::isnan(value) ? "" : number(value);
}

/** \brief Of what the viewpoints should see, where that is known; else of what the model's view
 * shows. */
double
coverageOf(const SceneDetection& d, const PoseEstimate* pose)
{
  return pose != nullptr && !std::isnan(pose->coverage) ? pose->coverage : d.coverage;
}

std::string
csvLine(const std::string& path, const SceneDetection& d, const PoseEstimate* pose)
{
  std::string line =
      csvField(path) + "," + csvField(d.label) + "," + std::to_string(d.indices.size());
  for (const double v :
       {d.centre[0], d.centre[1], d.centre[2], d.score, d.fit, d.confidence, coverageOf(d, pose)})
    line += "," + numberOrNothing(v);
  return line + (pose != nullptr ? poseCsv(*pose) : "") + "\n";
}

std::string
textLines(const std::string& path, const SceneDetection& d, const PoseEstimate* pose)
{
  const auto& c = d.centre;
  std::string text =
      formatted("%s: %-16s at %8.4f %8.4f %8.4f, %7zu points, confidence %4.2f", path.c_str(),
                d.label.c_str(), c[0], c[1], c[2], d.indices.size(), d.confidence);
  const double coverage = coverageOf(d, pose);
  text += std::isnan(coverage) ? "\n" : formatted(", coverage %4.2f\n", coverage);
  if (pose != nullptr)
    text += formatted("%s: %-16s %s\n", path.c_str(), d.label.c_str(), poseText(*pose).c_str());
  return text;
}

using Count = unsigned long long;

std::string
sceneText(const SceneDiagnostics& d)
{
  return formatted(
      "points %zu, background %zu (planes %zu), cells %zu of %g, extent %g, largest model %g\n",
      d.points, d.background_points, d.planes, d.cells, d.leaf, d.extent, d.largest_model);
}

/** \brief What Method::Explanation did. */
std::string
explanationsText(const SceneDiagnostics& d)
{
  std::string text =
      formatted("background cells %zu\n"
                "                 |       scan        |            choice           |\n"
                "model            |  places promising | explained  no fit      lost | found\n",
                d.background_cells);
  for (const auto& m : d.models)
    text += formatted("%-16.16s | %7zu %9zu | %9zu %7zu %9zu | %5zu\n", m.label.c_str(), m.places,
                      m.promising, m.explanations, m.died_fit, m.lost, m.detections);
  return text;
}

/** \brief What Method::Dissertation did. */
std::string
dissertationText(const SceneDiagnostics& d)
{
  std::string text =
      formatted("pairs drawn %llu, too long %llu, without feature %llu, background %llu\n",
                Count{d.drawn}, Count{d.too_long}, Count{d.featureless}, Count{d.background});
  text += "                 |  1 selected       |  2 seeds  3 cleared | 4 lone  clusters |"
          " 5 distr. | 6 small relative | 7 merged  lost |\n"
          "model            |   pairs  surflets |                    |                  |"
          "          |                  |                | found\n";
  for (const auto& m : d.models)
    text += formatted("%-16.16s | %7llu %9zu | %8zu %9zu | %6zu %9zu | %8zu | %7zu %8zu | %8zu "
                      "%5zu | %5zu\n",
                      m.label.c_str(), Count{m.pairs}, m.surflets, m.seeds, m.seeds_cleared,
                      m.seeds_lone, m.clusters, m.died_distribution, m.died_small, m.died_relative,
                      m.merged, m.lost, m.detections);
  return text;
}

} // namespace

std::string
csvHeader(bool with_poses)
{
  return "file,label,points,x,y,z,score,fit,confidence,coverage" +
         (with_poses ? poseCsvHeader() : "") + "\n";
}

std::string
foundText(const std::string& path, const std::vector<SceneDetection>& detections,
          const std::vector<PoseEstimate>& poses, const SceneDiagnostics& diagnostics, bool csv)
{
  if (detections.empty() && !csv)
    return path + ": nothing found: " +
           (diagnostics.reason.empty() ? "nothing is sure enough, see -min_confidence"
                                       : diagnostics.reason) +
           "\n";
  std::string text;
  for (std::size_t k = 0; k < detections.size(); ++k)
    text +=
        (csv ? csvLine : textLines)(path, detections[k], k < poses.size() ? &poses[k] : nullptr);
  return text;
}

std::string
stepsText(Method method, const SceneDiagnostics& d)
{
  return sceneText(d) + (method == Method::Explanation ? explanationsText(d) : dissertationText(d));
}

} // namespace apps
} // namespace pcl_surflet
