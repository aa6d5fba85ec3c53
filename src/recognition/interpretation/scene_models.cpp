#include "scene_models.h"

#include <algorithm>
#include <cmath>

namespace pcl_surflet {
namespace interpretation {
namespace {

Histogram
meanHistogram(const HistogramModel& model)
{
  Histogram mean(static_cast<std::size_t>(model.resolution.bins()), 0.0);
  for (const auto& member : model.members)
    for (std::size_t b = 0; b < mean.size(); ++b)
      mean[b] += member.histogram[b] / static_cast<double>(model.members.size());
  return mean;
}

SceneModel
sceneModel(const ModelDatabase& database, std::size_t index, double h_min, double scale)
{
  SceneModel m;
  m.index = index;
  m.model = &database[index];
  const Histogram raw = meanHistogram(*m.model);
  const Histogram penalised = penalize(raw, h_min);
  m.h.assign(raw.begin(), raw.end());
  for (const double v : penalised) {
    m.log_h.push_back(static_cast<float>(std::log(v)));
    m.expected_log += v * std::log(v);
  }
  const double delta_max = m.model->delta_max;
  for (int k = 0; k + 1 < m.model->resolution.delta; ++k)
    m.border.push_back(deltaBorder(k, m.model->resolution, delta_max, scale));
  const double width = delta_max * scale / m.model->resolution.delta;
  for (const double v : penalised)
    m.density.push_back(static_cast<float>(v / width));
  m.least_density = static_cast<float>(h_min / width);
  m.longest = static_cast<float>(delta_max * scale * delta_max * scale);
  m.angular_bins = static_cast<std::uint32_t>(m.model->resolution.angularBins());
  return m;
}

} // namespace

SceneModels
sceneModels(const ModelDatabase& database, bool with_background, double scale)
{
  SceneModels models;
  models.resolution = database.resolution();
  const double h_min = database.penaltyMinimum();
  models.log_h_min = static_cast<float>(std::log(h_min));
  for (const auto role : {ModelRole::Object, ModelRole::Background}) {
    for (std::size_t i = 0; i < database.size(); ++i)
      if (database[i].role == role && (role == ModelRole::Object || with_background))
        models.all.push_back(sceneModel(database, i, h_min, scale));
    if (role == ModelRole::Object)
      models.objects = models.all.size();
  }
  for (std::size_t i = 0; i < models.objects; ++i)
    models.largest_delta = std::max(models.largest_delta, models.all[i].model->delta_max);
  return models;
}

} // namespace interpretation
} // namespace pcl_surflet
