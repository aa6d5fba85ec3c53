#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/sensed_surface.h"

#include <pcl/conversions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace pcl_surflet;

namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();

/** \brief Organised depth image of a sphere of radius 0.5 at (0, 0, 2) seen from the origin. */
pcl::PointCloud<pcl::PointXYZ>
depthImage(int width, int height)
{
  pcl::PointCloud<pcl::PointXYZ> cloud(static_cast<std::uint32_t>(width),
                                       static_cast<std::uint32_t>(height));
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double x = 0.8 * (u / (width - 1.0) - 0.5), y = 0.8 * (v / (height - 1.0) - 0.5);
      const double a = x * x + y * y + 1, b = -2 * 2.0, c = 4 - 0.25; // |t(x,y,1) - (0,0,2)| = 0.5
      const double root = b * b - 4 * a * c;
      const double t = (-b - std::sqrt(root)) / (2 * a);
      auto& p = cloud(u, v);
      if (root > 0)
        p = {float(t * x), float(t * y), float(t)};
      else
        p = {kNan, kNan, kNan};
    }
  cloud.is_dense = false;
  return cloud;
}

/** \brief Mean cosine between the normals and those of the sphere around (0, 0, \p z). */
double
agreement(const SurfletSet& s, double z)
{
  double sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double x = s.x[i], y = s.y[i], w = s.z[i] - z;
    sum += (x * s.nx[i] + y * s.ny[i] + w * s.nz[i]) / std::sqrt(x * x + y * y + w * w);
  }
  return sum / double(s.size());
}

} // namespace

TEST(SensedSurface, DepthImageGivesOutwardNormals)
{
  const auto found = surfletsFromDepth(depthImage(160, 120), Eigen::Vector3f::Zero());
  EXPECT_GT(found.surflets.size(), 4000u);
  EXPECT_EQ(found.surflets.size() + found.rejected, 160u * 120);
  EXPECT_GT(agreement(found.surflets, 2), 0.98);
}

TEST(SensedSurface, PointsSeenFromOnePlace)
{
  auto cloud = depthImage(160, 120);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(cloud.size());
  const auto found = surfletsFromPoints(cloud, Eigen::Vector3f::Zero(), 20, 2);
  EXPECT_GT(found.surflets.size(), 4000u);
  EXPECT_GT(agreement(found.surflets, 2), 0.98);
  EXPECT_THROW(surfletsFromPoints(cloud, Eigen::Vector3f::Zero(), 2), std::invalid_argument);
}

TEST(SensedSurface, DirectionsOrientNormalsAllAround)
{
  // A whole sphere: no single viewpoint could orient it.
  const auto sphere = sampleShape(Shape::sphere(0.5), 5000, 1);
  pcl::PointCloud<pcl::PointNormal> seen;
  for (std::size_t i = 0; i < sphere.size(); ++i) {
    pcl::PointNormal p;
    p.x = sphere.x[i];
    p.y = sphere.y[i];
    p.z = sphere.z[i];
    p.normal_x = -3 * sphere.nx[i]; // from the sensor towards the point, any length
    p.normal_y = -3 * sphere.ny[i];
    p.normal_z = -3 * sphere.nz[i];
    seen.push_back(p);
  }
  seen[10].normal_x = seen[10].normal_y = seen[10].normal_z = 0;
  seen[11].normal_x = kNan;
  seen[12].x = kNan;
  const auto found = surfletsFromDirections(seen, 15);
  EXPECT_EQ(found.surflets.size(), sphere.size() - 3);
  EXPECT_EQ(found.rejected, 3u);
  EXPECT_GT(agreement(found.surflets, 0), 0.98);
  EXPECT_EQ(found.indices[10], 13);
}

TEST(SensedSurface, HopelessInput)
{
  pcl::PointCloud<pcl::PointXYZ> cloud;
  EXPECT_THROW(surfletsFromDepth(cloud, Eigen::Vector3f::Zero()), std::invalid_argument);
  EXPECT_EQ(surfletsFromPoints(cloud, Eigen::Vector3f::Zero()).surflets.size(), 0u);
  for (int i = 0; i < 10; ++i)
    cloud.push_back({kNan, kNan, kNan});
  for (const bool claims_to_be_dense : {false, true}) { // PCL itself aborts on the latter
    cloud.is_dense = claims_to_be_dense;
    EXPECT_EQ(surfletsFromPoints(cloud, Eigen::Vector3f::Zero()).rejected, 10u);
  }
  SurfletSet poisoned = sampleShape(Shape::sphere(1), 500, 1);
  poisoned.push_back({kNan, 0, 0, 0, 0, 1});
  EXPECT_EQ(withEstimatedNormals(poisoned, 0.3).surflets.size(), 500u);
  EXPECT_EQ(surfletsFromDirections({}).surflets.size(), 0u);
}

TEST(Conversions, MeshesFromPcl)
{
  pcl::PointCloud<pcl::PointXYZ> vertices;
  vertices.push_back({0, 0, 0});
  vertices.push_back({1, 0, 0});
  vertices.push_back({1, 1, 0});
  vertices.push_back({0, 1, 0});
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(vertices, mesh.cloud);
  mesh.polygons.resize(2);
  mesh.polygons[0].vertices = {0, 1, 2, 3};
  mesh.polygons[1].vertices = {0, 1}; // skipped
  const auto out = toTriangleMesh(mesh);
  EXPECT_EQ(out.vertices.size(), 4u);
  EXPECT_EQ(out.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(surfaceArea(out), 1);
  mesh.polygons[0].vertices[3] = 4;
  EXPECT_THROW(toTriangleMesh(mesh), std::invalid_argument);
  EXPECT_THROW(toTriangleMesh(pcl::PolygonMesh{}), std::invalid_argument);
}
