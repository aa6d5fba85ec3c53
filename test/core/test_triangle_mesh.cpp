#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/core/triangle_mesh.h"

#include "mesh_truths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace {

/** \brief Cube [0, size]^3 of 12 triangles. */
TriangleMesh
cube(float size)
{
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i)
    mesh.vertices.push_back({i & 1 ? size : 0, i & 2 ? size : 0, i & 4 ? size : 0});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/** \brief The cube as triangles that share positions but no vertices, as STL files have it. */
TriangleMesh
soup(const TriangleMesh& mesh)
{
  TriangleMesh out;
  for (const auto& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(out.vertices.size());
    for (const auto v : t)
      out.vertices.push_back(mesh.vertices[v]);
    out.triangles.push_back({n, n + 1, n + 2});
  }
  return out;
}

/** \brief Distance of a point on the cube's surface to its nearest edge: the second-smallest of
 * its distances to the six planes. */
double
distanceToCubeEdge(const SurfletSet& s, std::size_t i, double size)
{
  std::array<double, 3> d = {std::min<double>(s.x[i], size - s.x[i]),
                             std::min<double>(s.y[i], size - s.y[i]),
                             std::min<double>(s.z[i], size - s.z[i])};
  std::sort(d.begin(), d.end());
  return d[1];
}

double
normOf(const SurfletSet& s, std::size_t i)
{
  return std::sqrt(double(s.nx[i]) * s.nx[i] + double(s.ny[i]) * s.ny[i] +
                   double(s.nz[i]) * s.nz[i]);
}

std::string
messageOf(void (*use)(const TriangleMesh&), const TriangleMesh& mesh)
{
  try {
    use(mesh);
  }
  catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "no exception";
}

} // namespace

TEST(TriangleMesh, AreaIsThatOfTheFaces)
{
  EXPECT_DOUBLE_EQ(surfaceArea(cube(2)), 24);
  EXPECT_NEAR(surfaceArea(meshOfShape(Shape::sphere(1), 0.02)), 4 * M_PI, 2e-3);
  EXPECT_EQ(surfaceArea(TriangleMesh()), 0);
}

TEST(TriangleMesh, UmbrellaNormalsOfASphereAreRadial)
{
  const TriangleMesh mesh = meshOfShape(Shape::sphere(1), 0.1);
  const auto normals = umbrellaNormals(mesh);
  ASSERT_EQ(normals.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const D3 n = {normals[i][0], normals[i][1], normals[i][2]};
    EXPECT_NEAR(dotOf(n, n), 1, 1e-6);
    EXPECT_GT(dotOf(n, vertexOf(mesh, static_cast<std::uint32_t>(i))), 0.9999);
  }
}

TEST(TriangleMesh, UmbrellaNormalsWeighByArea)
{
  // Around the corner vertex: one triangle of area 4 in z = 0, one of area 1 in x = 0.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto n = umbrellaNormals(mesh)[0];
  EXPECT_NEAR(n[0], 1 / std::sqrt(17.0), 1e-6);
  EXPECT_NEAR(n[1], 0, 1e-6);
  EXPECT_NEAR(n[2], 4 / std::sqrt(17.0), 1e-6);
}

TEST(TriangleMesh, UmbrellaNormalsAreZeroWhereThereIsNoDirection)
{
  TriangleMesh mesh; // a triangle and its reverse cancel; vertex 3 is unused
  mesh.vertices = {{0.1f, 0.2f, 0.7f}, {1.3f, 0, 0}, {0, 1.7f, 0.3f}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 2}, {3, 3, 3}};
  for (const auto& n : umbrellaNormals(mesh))
    EXPECT_EQ(n, (TriangleMesh::Point{0, 0, 0}));
}

TEST(TriangleMesh, UmbrellaNormalsAreZeroWhereOnlyRoundingIsLeft)
{
  // Two sides of a tilted sheet whose triangles are summed in different orders.
  TriangleMesh mesh;
  for (const double t : {0.3, 1.1, 2.9, 4.4})
    mesh.vertices.push_back(
        {float(std::cos(t)), float(std::sin(t)), float(0.37 * std::cos(t) - 0.71 * std::sin(t))});
  mesh.vertices.push_back({0.1f, 0.05f, float(0.37 * 0.1f - 0.71 * 0.05f)});
  mesh.triangles = {{4, 0, 1}, {4, 1, 2}, {4, 2, 3}, {4, 3, 0},
                    {4, 0, 3}, {4, 2, 1}, {4, 3, 2}, {4, 1, 0}};
  EXPECT_EQ(umbrellaNormals(mesh)[4], (TriangleMesh::Point{0, 0, 0}));
}

TEST(RefineEdges, LeavesNoLongEdgeAndKeepsTheSurface)
{
  const TriangleMesh fine = refineEdges(cube(1), 0.11);
  EXPECT_LE(longestEdgeOf(fine), 0.11);
  EXPECT_GT(longestEdgeOf(fine), 0.05); // not finer than need be
  EXPECT_EQ(openEdgesOf(fine), 0u);
  EXPECT_NEAR(surfaceArea(fine), 6, 1e-6);
  EXPECT_NEAR(volumeOf(fine), 1, 1e-6);
}

TEST(RefineEdges, KeepsNeedlesClosed)
{
  TriangleMesh needle = cube(1);
  for (auto& v : needle.vertices)
    v[2] *= 37;
  const TriangleMesh fine = refineEdges(needle, 0.3);
  EXPECT_LE(longestEdgeOf(fine), 0.3);
  EXPECT_EQ(openEdgesOf(fine), 0u);
  EXPECT_NEAR(volumeOf(fine), 37, 1e-4);
}

TEST(RefineEdges, SplitsSharedPositionsAlikeInSoups)
{
  const TriangleMesh fine = refineEdges(soup(cube(1)), 0.3);
  const TriangleMesh shared = refineEdges(cube(1), 0.3);
  EXPECT_EQ(fine.triangles.size(), shared.triangles.size());
  EXPECT_NEAR(volumeOf(fine), 1, 1e-6);
}

TEST(RefineEdges, StopsAtTheLargestNumberStillClosed)
{
  const Shape torus = Shape::torus(1, 0.3);
  const TriangleMesh coarse = meshOfShape(torus, 0.5);
  const std::size_t most = coarse.triangles.size() * 3;
  const TriangleMesh fine = refineEdges(coarse, 1e-3, most);
  EXPECT_LE(fine.triangles.size(), most);
  EXPECT_GT(fine.triangles.size(), coarse.triangles.size() * 2);
  EXPECT_EQ(openEdgesOf(fine), 0u);
  EXPECT_EQ(refineEdges(coarse, 1e-3, 1).triangles.size(), coarse.triangles.size());
}

TEST(RefineEdges, EndsWhereNoFloatLiesBetween)
{
  TriangleMesh far;
  far.vertices = {{1e8f, 0, 0}, {1e8f + 8, 0, 0}, {1e8f, 8, 0}};
  far.triangles = {{0, 1, 2}};
  EXPECT_LT(refineEdges(far, 0.5).triangles.size(), 2000000u);
}

TEST(RefineEdges, RefusesUnusableArguments)
{
  EXPECT_THROW(refineEdges(cube(1), 0), std::invalid_argument);
  EXPECT_THROW(refineEdges(cube(1), std::nan("")), std::invalid_argument);
}

TEST(SampleSurface, IsUniformByArea)
{
  // Triangles of very different size on a plane: 10 strips of equal area must get equal shares.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {10, 1, 0}, {0, 1, 0}, {0.2f, 0.5f, 0}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const SurfletSet s = sampleSurface(mesh, 40000, 11);
  ASSERT_EQ(s.size(), 40000u);
  std::vector<std::size_t> strips(40, 0);
  for (std::size_t i = 0; i < s.size(); ++i)
    ++strips[std::min<std::size_t>(9, static_cast<std::size_t>(s.x[i])) * 4 +
             std::min<std::size_t>(3, static_cast<std::size_t>(s.y[i] * 4))];
  EXPECT_LT(chiSquared(strips, std::vector<double>(40, 1.0 / 40)), chiSquaredLimit(39));
}

TEST(SampleSurface, IsUniformOverASphereMesh)
{
  const SurfletSet s = sampleSurface(meshOfShape(Shape::sphere(1), 0.03), 30000, 5);
  std::vector<std::size_t> bands(20, 0); // bands of equal height have equal area [Archimedes]
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double h = std::min(0.999999, std::max(0.0, (s.z[i] + 1.0) / 2));
    ++bands[static_cast<std::size_t>(h * 20)];
    EXPECT_GT(s.x[i] * s.nx[i] + s.y[i] * s.ny[i] + s.z[i] * s.nz[i], 0.999);
    EXPECT_NEAR(normOf(s, i), 1, 1e-6);
  }
  EXPECT_LT(chiSquared(bands, std::vector<double>(20, 0.05)), chiSquaredLimit(19));
}

TEST(SampleSurface, IsDeterminedByTheSeed)
{
  const TriangleMesh mesh = meshOfShape(Shape::torus(1, 0.3), 0.2);
  EXPECT_TRUE(sameSurflets(sampleSurface(mesh, 500, 1), sampleSurface(mesh, 500, 1)));
  EXPECT_FALSE(sameSurflets(sampleSurface(mesh, 500, 1), sampleSurface(mesh, 500, 2)));
  EXPECT_TRUE(sampleSurface(mesh, 0, 1).empty());
}

TEST(SampleSurface, TakesTheTrianglesNormalWhereUmbrellasCancel)
{
  TriangleMesh mesh; // both sides of one triangle
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 2}};
  const SurfletSet s = sampleSurface(mesh, 1000, 3);
  std::size_t up = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_EQ(std::abs(s.nz[i]), 1);
    up += s.nz[i] > 0;
  }
  EXPECT_GT(up, 400u);
  EXPECT_LT(up, 600u);
}

TEST(SampleSurface, IgnoresDegenerateTriangles)
{
  TriangleMesh mesh = cube(1);
  mesh.vertices.push_back({50, 50, 50});
  mesh.triangles.insert(mesh.triangles.begin(), {8, 8, 8});
  mesh.triangles.insert(mesh.triangles.begin() + 5, {0, 8, 8});
  mesh.triangles.push_back({8, 8, 0});
  for (const SurfletSet& s : {sampleSurface(mesh, 3000, 3), sampleIsoMesh(mesh, 500, 3)})
    for (std::size_t i = 0; i < s.size(); ++i) {
      EXPECT_LE(s.x[i], 1);
      EXPECT_NEAR(normOf(s, i), 1, 1e-6);
    }
}

TEST(SampleIsoMesh, KeepsDistanceAndCount)
{
  for (const std::size_t target : {std::size_t{60}, std::size_t{1000}, std::size_t{4500}})
    for (const auto& name : {"sphere", "torus", "cube", "tetrahedron", "bottle", "wine_glass"}) {
      SCOPED_TRACE(name + std::string(" ") + std::to_string(target));
      const TriangleMesh mesh = meshOfShape(*shapeByName(name), 0.01);
      const SurfletSet s = sampleIsoMesh(mesh, target, 7);
      EXPECT_NEAR(static_cast<double>(s.size()), static_cast<double>(target), 0.2 * target);
      // Area-uniform points come closer than a hundredth of this.
      const double spacing = std::sqrt(surfaceArea(mesh) / static_cast<double>(target));
      const double thin = std::string(name) == "wine_glass" || std::string(name) == "bottle";
      EXPECT_GT(smallestDistanceOf(s), (thin ? 0.3 : 0.6) * spacing);
    }
}

TEST(SampleIsoMesh, IsEvenAndLeavesNoHoles)
{
  const SurfletSet s = sampleIsoMesh(meshOfShape(Shape::sphere(1), 0.05), 2000, 9);
  const double spacing = std::sqrt(4 * M_PI / 2000);
  const SurfletSet probes = sampleShape(Shape::sphere(1), 3000, 1);
  for (std::size_t i = 0; i < probes.size(); ++i) {
    double nearest = 4;
    for (std::size_t k = 0; k < s.size(); ++k)
      nearest = std::min<double>(
          nearest, std::hypot(probes.x[i] - s.x[k], probes.y[i] - s.y[k], probes.z[i] - s.z[k]));
    ASSERT_LT(nearest, 1.5 * spacing);
  }
}

TEST(SampleIsoMesh, KeepsFaceNormalsOfCadMeshes)
{
  const std::size_t target = 3000;
  const SurfletSet s = sampleIsoMesh(cube(1), target, 4);
  const double spacing = std::sqrt(6.0 / target);
  std::size_t exact = 0, inner = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double largest = std::max({std::abs(s.nx[i]), std::abs(s.ny[i]), std::abs(s.nz[i])});
    if (distanceToCubeEdge(s, i, 1) > spacing) {
      ++inner;
      exact += largest == 1;
    }
  }
  EXPECT_EQ(exact, inner);
  EXPECT_GT(inner, s.size() / 2);
}

TEST(SampleIsoMesh, IsDeterminedByTheSeed)
{
  const TriangleMesh mesh = cube(1);
  EXPECT_TRUE(sameSurflets(sampleIsoMesh(mesh, 700, 1), sampleIsoMesh(mesh, 700, 1)));
  EXPECT_FALSE(sameSurflets(sampleIsoMesh(mesh, 700, 1), sampleIsoMesh(mesh, 700, 2)));
}

TEST(SampleIsoMesh, WorksAtAbsurdScales)
{
  for (const float size : {1e-20f, 1e-9f, 1e9f, 1e20f, 3e38f}) {
    SCOPED_TRACE(size);
    const TriangleMesh mesh = cube(size);
    EXPECT_NEAR(surfaceArea(mesh) / (6.0 * size * size), 1, 1e-6);
    const SurfletSet s = sampleIsoMesh(mesh, 1000, 2);
    EXPECT_NEAR(static_cast<double>(s.size()), 1000, 200);
    EXPECT_GT(smallestDistanceOf(s) / size, 0.6 * std::sqrt(6.0 / 1000));
    for (std::size_t i = 0; i < s.size(); ++i)
      ASSERT_NEAR(normOf(s, i), 1, 1e-6);
  }
}

TEST(SampleIsoMesh, CopesWithTheSmallestTargets)
{
  EXPECT_TRUE(sampleIsoMesh(cube(1), 0, 1).empty());
  EXPECT_EQ(sampleIsoMesh(cube(1), 1, 1).size(), 1u);
  EXPECT_NEAR(static_cast<double>(sampleIsoMesh(cube(1), 10, 1).size()), 10, 2);
}

TEST(SampleIsoMesh, GivesWhatThereIsWhereFloatsAreTooCoarse)
{
  // A triangle of 8 units at 1e8 has only a handful of different points.
  TriangleMesh far;
  far.vertices = {{1e8f, 0, 0}, {1e8f + 8, 0, 0}, {1e8f, 8, 0}};
  far.triangles = {{0, 1, 2}};
  const SurfletSet s = sampleIsoMesh(far, 1000, 1);
  EXPECT_FALSE(s.empty());
}

TEST(TriangleMesh, UnsoundMeshesAreRefusedWithTheReason)
{
  TriangleMesh none, index = cube(1), nan = cube(1), flat;
  none.vertices = {{0, 0, 0}};
  index.triangles[3][1] = 8;
  nan.vertices[2][1] = std::numeric_limits<float>::quiet_NaN();
  flat.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  flat.triangles = {{0, 1, 2}, {1, 1, 1}};
  const std::pair<TriangleMesh, std::string> cases[] = {
      {none, "no triangles"},
      {index, "triangle 3 refers to vertex 8"},
      {nan, "vertex 2 has a coordinate that is not finite"},
      {flat, "zero area"}};
  for (const auto& [mesh, reason] : cases) {
    EXPECT_NE(mesh.problem().find(reason), std::string::npos) << mesh.problem();
    EXPECT_NE(messageOf([](const TriangleMesh& m) { sampleSurface(m, 10, 1); }, mesh).find(reason),
              std::string::npos);
    EXPECT_NE(messageOf([](const TriangleMesh& m) { sampleIsoMesh(m, 10, 1); }, mesh).find(reason),
              std::string::npos);
  }
  EXPECT_EQ(cube(1).problem(), "");
  EXPECT_THROW(surfaceArea(index), std::invalid_argument);
  EXPECT_THROW(umbrellaNormals(index), std::invalid_argument);
  EXPECT_THROW(refineEdges(index, 1), std::invalid_argument);
}
