#include "pcl_surflet/view_training.h"

#include "core/number_text.h"
#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/recognition/scene_training.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace {

/** \brief What lies this flat and this low, in cells, is a foot, if it is this share of a view. */
constexpr float kFlat = 0.7f;
constexpr double kFootHeight = 2, kLeastFoot = 0.05;
/** \brief Of sensingFor(): distance and width of the picture in diameters, pixels a cell. */
constexpr double kDistance = 5, kWidth = 1.3, kPixelsPerCell = 2.5;
constexpr double kMostPixels = 4096;
constexpr double kNormalRadius = 1.2; ///< in cells
constexpr double kGrazing = 80;

/** \brief The members of one model, view by view. */
class Views {
public:
  Views(HistogramModel& model, const CentreLesson& lesson, double leaf, std::uint64_t seed,
        unsigned threads)
      : model_(model), lesson_(lesson), leaf_(leaf), seed_(seed), threads_(threads)
  {
  }

  /** \brief Adds a member for what is seen, and for the same without foot if there is one. */
  void
  add(const std::string& name, const SurfletSet& seen)
  {
    const SurfletSet above = withoutFoot(seen);
    addIfEnough(name, seen);
    if (static_cast<double>(above.size()) < (1 - kLeastFoot) * static_cast<double>(seen.size()))
      addIfEnough(name + ", no foot", above);
  }

private:
  void
  addIfEnough(const std::string& name, const SurfletSet& seen)
  {
    try {
      addView(model_, name, seen, leaf_, seed_, threads_, &lesson_);
    }
    catch (const TrainingError&) { // from here it shows next to nothing
    }
  }

  SurfletSet
  withoutFoot(const SurfletSet& seen) const
  {
    SurfletSet out;
    if (seen.empty())
      return out;
    const float bottom = *std::min_element(seen.z.begin(), seen.z.end());
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen.nz[i] < kFlat || seen.z[i] > bottom + kFootHeight * leaf_)
        out.push_back(seen[i]);
    return out;
  }

  HistogramModel& model_;
  CentreLesson lesson_;
  double leaf_;
  std::uint64_t seed_;
  unsigned threads_;
};

/** \brief Every second place; on a ring there are two sensors at each, and opposite ones. */
void
addViews(Views& views, const std::vector<OrientedScan>& scans, bool ring)
{
  const std::size_t places = scans.size() / 2;
  for (std::size_t place = 0; place < places; place += 2)
    for (const std::size_t k : {2 * place, 2 * place + 1}) {
      const std::string name = "seen from " + std::to_string(k);
      views.add(name, sensedSurflets({scans[k]}));
      if (ring && place < places / 2)
        views.add(name + " and opposite", sensedSurflets({scans[k], scans[k + places]}));
    }
}

/** \brief Of the whole surface, also of what no sensor sees. */
std::array<double, 3>
centroidOf(const SceneItem& item, std::uint64_t seed)
{
  constexpr std::size_t kSurflets = 20000;
  const Extent extent = computeExtent(item.sample(kSurflets, seed));
  return {extent.centroid[0], extent.centroid[1], extent.centroid[2]};
}

/** \brief Of the vertices' bounding box. */
double
diagonalOf(const TriangleMesh& mesh)
{
  auto low = mesh.vertices.front(), high = low;
  double squared = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const auto& v : mesh.vertices) {
      low[a] = std::min(low[a], v[a]);
      high[a] = std::max(high[a], v[a]);
    }
    const double edge = static_cast<double>(high[a]) - low[a];
    squared += edge * edge;
  }
  return std::sqrt(squared);
}

} // namespace

SceneSensing
sensingFor(const SceneItem& item, double leaf)
{
  const TriangleMesh mesh = item.mesh();
  if (const auto problem = mesh.problem(); !problem.empty())
    throw std::invalid_argument("pcl_surflet: '" + item.label + "': " + problem);
  const double diameter = diagonalOf(mesh), pixels = kPixelsPerCell * kWidth * diameter / leaf;
  if (!(leaf > 0) || !std::isfinite(leaf) || !(diameter > 0) || !(pixels <= kMostPixels))
    throw std::invalid_argument("pcl_surflet: cells of edge " + detail::numberText(leaf) +
                                " are not for an object of diameter " +
                                detail::numberText(diameter) + "; is the unit the same?");
  SceneSensing s;
  s.sensor.columns = s.sensor.rows = static_cast<std::size_t>(std::max(16.0, std::ceil(pixels)));
  s.sensor.opening = 2 * std::atan(kWidth / 2 / kDistance) * 180 / M_PI;
  s.sensor.edge = leaf;
  s.sensor.grazing = kGrazing;
  s.views.distance = kDistance * diameter;
  s.normal_radius = kNormalRadius * leaf;
  return s;
}

HistogramModel
trainForSensors(const HistogramModelTrainer& trainer, const SceneItem& item,
                const SceneSensing& sensing, double leaf, std::uint64_t seed, unsigned threads)
{
  const auto scans = scansAlone(item, sensing, seed);
  HistogramModel model =
      trainForScenes(trainer, item.label, sensedSurflets(scans), leaf, seed, threads);
  ObjectCentre centre(model.r_mean);
  Views views(model, {centroidOf(item, seed), &centre}, leaf, seed, threads);
  addViews(views, scans, sensing.views.views == ViewSet::Ring24);
  model.centre = centre.weights();
  return model;
}

} // namespace pcl_surflet
