#include "poses.h"

#include "scene_items.h"

#include <cstdio>

namespace pcl_surflet {
namespace apps {
namespace {

const char*
nameOf(SymmetryKind kind)
{
  switch (kind) {
  case SymmetryKind::Discrete:
    return "discrete";
  case SymmetryKind::Continuous:
    return "continuous";
  case SymmetryKind::Spherical:
    return "spherical";
  default:
    return "none";
  }
}

/** \brief X,Y,Z[:X,Y,Z...] */
std::vector<std::array<double, 3>>
viewpointsIn(const std::string& text)
{
  std::vector<std::array<double, 3>> out;
  for (const auto& place : parts(text, ':'))
    out.push_back(parsePlace("-viewpoints", place));
  return out;
}

} // namespace

void
PoseJob::addOptions(CommandLine& line)
{
  line.text("-pose", "DIR",
            "estimates poses: a mesh or complete cloud of every object, named as in the database "
            "(pcl_surflet_generate -models makes such)",
            directory);
  line.option("-viewpoints", "X,Y,Z[:X,Y,Z...]",
              "for -pose: where the sensors were, in the scene's coordinates; default unknown",
              [this](const std::string& text) { viewpoints = viewpointsIn(text); });
  line.flag("-verify",
            "for -pose: guesses names more boldly, and leaves out those that their poses refute",
            verify);
}

void
PoseJob::load()
{
  if (!directory.empty())
    try {
      models = loadPoseModels(directory);
    }
    catch (const std::runtime_error& error) {
      throw DataError(about(directory, error.what()));
    }
}

std::vector<PoseEstimate>
PoseJob::estimate(const pcl::PointCloud<pcl::PointNormal>::ConstPtr& cloud,
                  const std::vector<SceneDetection>& detections, std::uint64_t seed) const
{
  if (models.empty())
    return {};
  PoseParameters parameters;
  parameters.viewpoints = viewpoints;
  parameters.seed = seed;
  PoseEstimator<pcl::PointNormal> estimator;
  estimator.setInputCloud(cloud);
  estimator.setModels(models);
  estimator.setParameters(parameters);
  return estimator.estimate(detections);
}

SurfletSet
PoseJob::surfaces(const std::vector<SceneDetection>& detections,
                  const std::vector<PoseEstimate>& poses) const
{
  SurfletSet all;
  for (std::size_t k = 0; k < poses.size(); ++k)
    for (const auto& model : models)
      if (poses[k].status == PoseStatus::Found && model.label() == detections[k].label) {
        const SurfletSet posed = moved(model.cells(), poses[k].motion);
        for (std::size_t i = 0; i < posed.size(); ++i)
          all.push_back(posed[i]);
      }
  return all;
}

std::string
poseCsvHeader()
{
  return ",tx,ty,tz,qx,qy,qz,qw,pose_score,inliers,margin,residual,symmetry,order,axis_x,axis_y,"
         "axis_z";
}

std::string
poseCsv(const PoseEstimate& pose)
{
  if (pose.status != PoseStatus::Found)
    return std::string(16, ',');
  std::string line;
  for (const double v : pose.motion.translation)
    line += "," + number(v);
  for (const double v : pose.motion.quaternion())
    line += "," + number(v);
  for (const double v : {pose.score, pose.inlier_share, pose.margin, pose.residual})
    line += "," + number(v);
  line += std::string(",") + nameOf(pose.symmetry.kind) + "," + std::to_string(pose.symmetry.order);
  for (const double v : pose.symmetry.axis)
    line += pose.symmetry.kind == SymmetryKind::None ? "," : "," + number(v);
  return line;
}

std::string
poseText(const PoseEstimate& pose)
{
  if (pose.status != PoseStatus::Found)
    return "no pose: " + pose.reason;
  const auto& t = pose.motion.translation;
  const auto q = pose.motion.quaternion();
  char text[256];
  std::snprintf(text, sizeof(text),
                "pose t %.4f %.4f %.4f, q (x y z w) %.4f %.4f %.4f %.4f, inliers %.2f, margin %.2f",
                t[0], t[1], t[2], q[0], q[1], q[2], q[3], pose.inlier_share, pose.margin);
  std::string out = text;
  if (pose.symmetry.kind == SymmetryKind::Discrete)
    out += ", one of " + std::to_string(pose.symmetry.order) + " that look alike";
  else if (pose.symmetry.kind != SymmetryKind::None)
    out += std::string(", turns about its ") +
           (pose.symmetry.kind == SymmetryKind::Continuous ? "axis" : "centre") + " look alike";
  return out;
}

} // namespace apps
} // namespace pcl_surflet
