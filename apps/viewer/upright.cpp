#include "upright.h"

#include "app_common.h"
#include "up_axis.h"

#include <cmath>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief How well one number follows another along a line. */
class Correlation {
public:
  void
  add(double x, double y)
  {
    ++n_;
    const double dx = x - mean_x_, dy = y - mean_y_;
    mean_x_ += dx / n_;
    mean_y_ += dy / n_;
    xx_ += dx * (x - mean_x_);
    yy_ += dy * (y - mean_y_);
    xy_ += dx * (y - mean_y_);
  }
  double
  value() const
  {
    return xx_ > 0 && yy_ > 0 ? xy_ / std::sqrt(xx_ * yy_) : 0;
  }

private:
  double n_ = 0, mean_x_ = 0, mean_y_ = 0, xx_ = 0, yy_ = 0, xy_ = 0;
};

} // namespace

bool
isCapture(const LabelledScene& scene)
{
  constexpr double kFollows = 0.95; // lenses bend straight lines, but not much
  if (scene.width == 0)
    return false;
  Correlation columns, rows;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const auto& p = scene.points[i];
    if (!(p.z > 0))
      return false;
    const std::size_t row = scene.places[i] / scene.width, column = scene.places[i] % scene.width;
    columns.add(static_cast<double>(column), p.x / p.z);
    rows.add(static_cast<double>(row), p.y / p.z);
  }
  return columns.value() > kFollows && rows.value() > kFollows;
}

void
turnUpright(const std::string& up, pcl::PointCloud<pcl::PointXYZLNormal>& points)
{
  const UpAxis* axis = upAxis(up);
  if (axis == nullptr)
    throw UsageError("option -up is x, y, z, -x, -y or -z, not '" + up + "'");
  for (auto& p : points) {
    const auto at = axis->turned({p.x, p.y, p.z});
    const auto n = axis->turned({p.normal_x, p.normal_y, p.normal_z});
    p.getVector3fMap() = Eigen::Map<const Eigen::Vector3f>(at.data());
    p.getNormalVector3fMap() = Eigen::Map<const Eigen::Vector3f>(n.data());
  }
}

} // namespace apps
} // namespace pcl_surflet
