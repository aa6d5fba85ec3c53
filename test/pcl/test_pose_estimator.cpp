// Poses of detections in PCL clouds.
#include "../test_files.h"

#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/pose_estimator.h"
#include "pcl_surflet/pose_verification.h"
#include "pcl_surflet/surface_file.h"

#include <pcl/common/io.h>
#include <pcl/common/transforms.h>
#include <pcl/console/print.h>

#include <gtest/gtest.h>

#include <limits>

using namespace pcl_surflet;

namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

const std::vector<PoseModel>&
cupModel()
{
  static const std::vector<PoseModel> models = {
      PoseModel::train("cup", sampleShape(*shapeByName("cup"), 20000, 1))};
  return models;
}

/** \brief A cup, its handle towards +x, and the floor below it. */
Cloud::Ptr
scene()
{
  Cloud::Ptr cloud(new Cloud);
  for (const auto& set :
       {sampleShape(*shapeByName("cup"), 10000, 2), sampleShape(Shape::plane(0.3, 0.3), 10000, 3)})
    for (std::size_t i = 0; i < set.size(); ++i) {
      pcl::PointNormal p;
      p.getVector3fMap() << set.x[i], set.y[i], set.z[i];
      p.getNormalVector3fMap() << set.nx[i], set.ny[i], set.nz[i];
      cloud->push_back(p);
    }
  return cloud;
}

/** \brief The cup's body: what a segmentation that loses the handle finds. */
SceneDetection
body(const Cloud& cloud)
{
  SceneDetection d;
  d.label = "cup";
  for (int i = 0; i < 10000; ++i)
    if (std::hypot(cloud[static_cast<std::size_t>(i)].x, cloud[static_cast<std::size_t>(i)].y) <
        0.046F)
      d.indices.push_back(i);
  return d;
}

Eigen::Isometry3f
someMotion()
{
  Eigen::Isometry3f motion(Eigen::AngleAxisf(1.1F, Eigen::Vector3f(1, 2, 3).normalized()));
  motion.pretranslate(Eigen::Vector3f(0.5F, -1, 2));
  return motion;
}

} // namespace

TEST(PoseEstimator, FindsHowTheCloudWasMovedHandleIncluded)
{
  const Cloud::Ptr still = scene();
  const SceneDetection d = body(*still);
  Cloud::Ptr cloud(new Cloud);
  pcl::transformPointCloudWithNormals(*still, *cloud, someMotion().matrix());
  (*cloud)[static_cast<std::size_t>(d.indices[5])].x = std::numeric_limits<float>::quiet_NaN();
  PoseEstimator<pcl::PointNormal> estimator;
  estimator.setInputCloud(cloud);
  estimator.setModels(cupModel());
  const auto poses = estimator.estimate({d});
  ASSERT_EQ(poses.size(), 1U);
  ASSERT_EQ(poses[0].status, PoseStatus::Found) << poses[0].reason;
  const Eigen::Isometry3f between = toIsometry(poses[0].motion).inverse() * someMotion();
  EXPECT_LT(between.translation().norm(), 0.003F);
  EXPECT_LT(Eigen::AngleAxisf(between.linear()).angle(), 0.05F);
}

TEST(PoseEstimator, TakesNormalsOfTheirOwnAndViewpoints)
{
  const Cloud::Ptr both = scene();
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  pcl::copyPointCloud(*both, *points);
  pcl::copyPointCloud(*both, *normals);
  PoseEstimator<pcl::PointXYZ, pcl::Normal> estimator;
  estimator.setInputCloud(points);
  estimator.setInputNormals(normals);
  estimator.setModels(cupModel());
  estimator.setViewpoints({{1, 0, 0.5F}});
  EXPECT_EQ(estimator.getParameters().viewpoints.size(), 1U);
  const auto poses = estimator.estimate({body(*both)});
  ASSERT_EQ(poses.size(), 1U);
  ASSERT_EQ(poses[0].status, PoseStatus::Found) << poses[0].reason;
  EXPECT_LT(toIsometry(poses[0].motion).translation().norm(), 0.003F);
}

TEST(PoseEstimator, MisuseIsTold)
{
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  PoseEstimator<pcl::PointNormal> nothing;
  EXPECT_TRUE(nothing.estimate({}).empty());
  PoseEstimator<pcl::PointXYZ, pcl::Normal> bare;
  bare.setInputCloud(pcl::PointCloud<pcl::PointXYZ>::Ptr(new pcl::PointCloud<pcl::PointXYZ>(3, 1)));
  EXPECT_TRUE(bare.estimate({SceneDetection()}).empty());
  PoseEstimator<pcl::PointNormal> estimator;
  estimator.setInputCloud(scene());
  estimator.setModels(cupModel());
  SceneDetection stranger;
  stranger.label = "spoon";
  SceneDetection empty;
  empty.label = "cup";
  const auto poses = estimator.estimate({stranger, empty});
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].status, PoseStatus::NoModel);
  EXPECT_NE(poses[0].reason.find("spoon"), std::string::npos);
  EXPECT_EQ(poses[1].status, PoseStatus::TooFewCells);
  SceneDetection outside;
  outside.label = "cup";
  outside.indices = {1000000};
  EXPECT_TRUE(estimator.estimate({outside}).empty());
  outside.indices = {-1};
  EXPECT_TRUE(estimator.estimate({outside}).empty());
}

TEST(PoseVerification, WrongNamesAreRefuted)
{
  const Cloud::Ptr cloud = scene();
  SceneDetection right = body(*cloud), wrong = right, unknown = right, doubtful = right;
  wrong.label = "wine_glass"; // a bottle has a body like a cup's
  unknown.label = doubtful.label = "goblet";
  unknown.fit = 0.8;
  doubtful.fit = 0.6;
  std::vector<PoseModel> models = cupModel();
  models.push_back(
      PoseModel::train("wine_glass", sampleShape(*shapeByName("wine_glass"), 20000, 1)));
  PoseEstimator<pcl::PointNormal> estimator;
  estimator.setInputCloud(cloud);
  estimator.setModels(models);
  std::vector<SceneDetection> detections = {wrong, right, doubtful, unknown};
  auto poses = estimator.estimate(detections);
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_EQ(verdictOf(poses[0], 0.7), Verdict::Refuted) << poses[0].inlier_share;
  EXPECT_EQ(verdictOf(poses[1], 0.7), Verdict::Confirmed) << poses[1].inlier_share;
  EXPECT_EQ(verdictOf(poses[2], 0.7), Verdict::Open) << "there is no goblet";
  EXPECT_EQ(keepVerified(detections, poses), 2U);
  ASSERT_EQ(detections.size(), 2U);
  EXPECT_EQ(detections[0].label, "cup");
  EXPECT_EQ(detections[1].fit, 0.8) << "enough where no pose can tell";
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].status, PoseStatus::Found);
  EXPECT_EQ(poses[1].status, PoseStatus::NoModel);
}

TEST(PoseVerification, LimitsAreInclusiveAndChecked)
{
  PoseEstimate pose;
  pose.status = PoseStatus::Found;
  pose.inlier_share = 0.7;
  EXPECT_TRUE(isVerified(pose, 0));
  pose.inlier_share = 0.699;
  EXPECT_FALSE(isVerified(pose, 1));
  pose.status = PoseStatus::NoAgreement;
  EXPECT_FALSE(isVerified(pose, 1));
  pose.status = PoseStatus::Undetermined;
  EXPECT_TRUE(isVerified(pose, 0.72));
  EXPECT_FALSE(isVerified(pose, 0.719));
  std::vector<SceneDetection> one(1);
  std::vector<PoseEstimate> none, pose_of_one(1);
  EXPECT_THROW(keepVerified(one, none), std::invalid_argument);
  for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    VerificationParameters p;
    p.min_inliers = bad;
    EXPECT_THROW(keepVerified(one, pose_of_one, p), std::invalid_argument);
    p = {};
    p.min_fit = bad;
    EXPECT_THROW(keepVerified(one, pose_of_one, p), std::invalid_argument);
  }
  EXPECT_EQ(one.size(), 1U);
}

TEST(PoseModels, AreLoadedByName)
{
  const test::TemporaryDirectory directory;
  saveOff(meshOfShape(*shapeByName("cup"), 0.004), directory.path("cup.off"));
  saveOff(meshOfShape(*shapeByName("box"), 0.02), directory.path("box.OFF"));
  test::writeFile(directory.path("notes.txt"), "not a mesh");
  const auto models = loadPoseModels(directory.place().string());
  ASSERT_EQ(models.size(), 2U);
  EXPECT_EQ(models[0].label(), "box");
  EXPECT_EQ(models[1].label(), "cup");
  EXPECT_EQ(models[0].symmetry().kind, SymmetryKind::Discrete);
  EXPECT_GT(models[1].cells().size(), 200U);
}

TEST(PoseModels, WhatCannotBeLoadedIsNamed)
{
  const test::TemporaryDirectory directory;
  EXPECT_THROW(loadPoseModels(directory.path("nowhere")), SurfaceFileError);
  EXPECT_THROW(loadPoseModels(directory.place().string()), SurfaceFileError) << "empty";
  test::writeFile(directory.path("bad.ply"), "ply\nnonsense");
  EXPECT_THROW(loadPoseModels(directory.place().string()), SurfaceFileError);
}
