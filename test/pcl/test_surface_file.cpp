#include "../test_files.h"

#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/surface_file.h"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include <sys/stat.h>
#include <unistd.h>

using namespace pcl_surflet;

namespace fs = std::filesystem;

namespace {

const std::string kPlyPoint = "property float x\nproperty float y\nproperty float z\n";
const std::string kPlyNormal = "property float nx\nproperty float ny\nproperty float nz\n";

class SurfaceFiles : public test::FileTest {
protected:
  void
  SetUp() override
  {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); // PCL's own words are not the point
  }
  std::string
  write(const std::string& name, const std::string& content) const
  {
    test::writeFile(path(name), content);
    return path(name);
  }
  SurfaceFile
  load(const std::string& name, const std::string& content) const
  {
    return loadSurface(write(name, content));
  }
  /** \brief The message about \p file, "no error" if there was none. */
  static std::string
  errorOf(const std::string& file, const SurfaceFileOptions& options = {})
  {
    try {
      loadSurface(file, options);
    }
    catch (const SurfaceFileError& e) {
      return e.what();
    }
    return "no error";
  }
  /** \brief \p content is refused with a message that names the file, \p cause and a remedy. */
  void
  expectRefused(const std::string& name, const std::string& content, const std::string& cause) const
  {
    const std::string error = errorOf(write(name, content));
    EXPECT_NE(error.find(path(name)), std::string::npos) << error;
    EXPECT_NE(error.find(cause), std::string::npos) << cause << " not in: " << error;
    EXPECT_NE(error.find(';'), std::string::npos) << "no remedy in: " << error;
  }
};

template <typename T>
void
append(std::string& out, T value, bool reversed = false)
{
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (reversed)
    std::reverse(bytes, bytes + sizeof value);
  out.append(bytes, sizeof value);
}

std::string
plyHeader(const std::string& format, const std::string& elements)
{
  return "ply\nformat " + format + " 1.0\ncomment made by a test\n" + elements + "end_header\n";
}

/** \brief A tetrahedron as binary PLY with coordinates in double precision and a colour. */
std::string
binaryPly(bool big_endian)
{
  std::string out = plyHeader(big_endian ? "binary_big_endian" : "binary_little_endian",
                              "element vertex 4\nproperty double x\nproperty double y\n"
                              "property double z\nproperty uchar red\nelement face 4\n"
                              "property list uchar int vertex_indices\n");
  const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::int32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& c : corners) {
    for (const double v : c)
      append(out, v, big_endian);
    out += '\xff';
  }
  for (const auto& f : faces) {
    out += '\x03';
    for (const auto v : f)
      append(out, v, big_endian);
  }
  return out;
}

std::string
binaryStl(std::uint32_t claimed)
{
  std::string out = "solid in name only";
  out.resize(80, ' ');
  append(out, claimed);
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& f : faces) {
    out.append(12, '\0');
    for (const int v : f)
      for (const float c : corners[v])
        append(out, c);
    out.append(2, '\0');
  }
  return out;
}

std::string
pcdHeader(const std::string& points, const std::string& data)
{
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\n"
         "TYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

pcl::PointCloud<pcl::PointNormal>
someCloud()
{
  pcl::PointCloud<pcl::PointNormal> cloud;
  const SurfletSet set = sampleShape(Shape::sphere(1), 100, 1);
  for (std::size_t i = 0; i < set.size(); ++i)
    cloud.push_back({set.x[i], set.y[i], set.z[i], 2 * set.nx[i], 2 * set.ny[i], 2 * set.nz[i]});
  cloud[3].x = std::nanf("");
  cloud[4].normal_x = cloud[4].normal_y = cloud[4].normal_z = 0;
  return cloud;
}

void
expectTetrahedron(const SurfaceFile& file)
{
  ASSERT_TRUE(file.mesh.has_value());
  EXPECT_EQ(file.mesh->vertices.size(), 4u);
  EXPECT_EQ(file.mesh->triangles.size(), 4u);
  EXPECT_NEAR(surfaceArea(*file.mesh), 1.5 + std::sqrt(3.0) / 2, 1e-6);
}

} // namespace

TEST_F(SurfaceFiles, PcdOfEveryKindGivesTheSamePoints)
{
  const auto cloud = someCloud();
  pcl::PCDWriter().writeASCII(path("a.pcd"), cloud, 9);
  pcl::PCDWriter().writeBinary(path("b.PCD"), cloud);
  pcl::PCDWriter().writeBinaryCompressed(path("c.Pcd"), cloud);
  for (const std::string name : {"a.pcd", "b.PCD", "c.Pcd"}) {
    const SurfaceFile file = loadSurface(path(name));
    EXPECT_FALSE(file.mesh) << name;
    EXPECT_EQ(file.rejected, 2u) << name;
    ASSERT_EQ(file.surflets.size(), 98u) << name;
    EXPECT_FLOAT_EQ(file.surflets.y[0], cloud[0].y) << name;
    EXPECT_NEAR(file.surflets.nx[0], cloud[0].normal_x / 2, 1e-6) << "unit length, " << name;
  }
}

TEST_F(SurfaceFiles, PcdInDoublePrecision)
{
  std::string pcd = pcdHeader("2", "ascii");
  pcd.replace(pcd.find("SIZE 4 4 4"), 10, "SIZE 8 8 8");
  const SurfaceFile file = load("d.pcd", pcd + "1 2 3 0 0 1\n4 5 6 0 1 0\n");
  ASSERT_EQ(file.surflets.size(), 2u);
  EXPECT_EQ(file.surflets.z[1], 6);
  EXPECT_EQ(file.surflets.ny[1], 1);
}

TEST_F(SurfaceFiles, NormalsAreEstimatedTowardsTheFilesViewpoint)
{
  for (const float side : {5.f, -5.f}) {
    pcl::PointCloud<pcl::PointXYZ> plane;
    for (int i = 0; i < 400; ++i)
      plane.push_back({static_cast<float>(i % 20) / 20, static_cast<float>(i / 20) / 20, 0});
    plane.sensor_origin_ = Eigen::Vector4f(0, 0, side, 0);
    pcl::PCDWriter().writeBinary(path("plane.pcd"), plane);
    EXPECT_NE(errorOf(path("plane.pcd")).find("-k"), std::string::npos);
    SurfaceFileOptions options;
    options.estimate_normals = 8;
    const SurfaceFile file = loadSurface(path("plane.pcd"), options);
    ASSERT_EQ(file.surflets.size(), 400u);
    EXPECT_NEAR(file.surflets.nz[210], side > 0 ? 1 : -1, 1e-5);
    options.estimate_normals = 2;
    EXPECT_NE(errorOf(path("plane.pcd"), options).find("3 neighbours"), std::string::npos);
  }
}

TEST_F(SurfaceFiles, TheSensorsPlaceCanBeGiven)
{
  pcl::PointCloud<pcl::PointXYZ> plane;
  for (int i = 0; i < 400; ++i)
    plane.push_back({static_cast<float>(i % 20) / 20, static_cast<float>(i / 20) / 20, 2});
  plane.sensor_origin_ = Eigen::Vector4f(0, 0, 5, 0); // its pose in a world, not where it was here
  pcl::PCDWriter().writeBinary(path("plane.pcd"), plane);
  SurfaceFileOptions options;
  options.estimate_normals = 8;
  EXPECT_NEAR(loadSurface(path("plane.pcd"), options).surflets.nz[210], 1, 1e-5);
  options.sensor = {0, 0, 0};
  EXPECT_NEAR(loadSurface(path("plane.pcd"), options).surflets.nz[210], -1, 1e-5);
}

TEST_F(SurfaceFiles, NormalsThatNobodyFilledAreEstimated)
{
  pcl::PointCloud<pcl::PointNormal> plane;
  for (int i = 0; i < 400; ++i)
    plane.push_back({static_cast<float>(i % 20) / 20, static_cast<float>(i / 20) / 20, 2, 0, 0, 0});
  pcl::PCDWriter().writeBinary(path("plane.pcd"), plane);
  const std::string ply = plyHeader("ascii", "element vertex 4\n" + kPlyPoint + kPlyNormal) +
                          "0 0 2 0 0 0\n1 0 2 0 0 0\n1 1 2 0 0 0\n0 1 2 0 0 0\n";
  test::writeFile(path("plane.ply"), ply);
  for (const std::string name : {"plane.pcd", "plane.ply"}) {
    EXPECT_NE(errorOf(path(name)).find("-k"), std::string::npos) << name;
    SurfaceFileOptions options;
    options.estimate_normals = 4;
    const SurfaceFile file = loadSurface(path(name), options);
    ASSERT_GE(file.surflets.size(), 4u) << name;
    EXPECT_NEAR(file.surflets.nz[1], -1, 1e-5) << name;
  }
}

TEST_F(SurfaceFiles, OrganisedDepthNeedsNoNormals)
{
  pcl::PointCloud<pcl::PointXYZ> depth(40, 30);
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = {(static_cast<float>(i % 40) - 20) / 40, (static_cast<float>(i / 40) - 15) / 40, 2};
  pcl::PCDWriter().writeBinary(path("depth.pcd"), depth);
  const SurfaceFile file = loadSurface(path("depth.pcd"));
  ASSERT_GT(file.surflets.size(), 150u) << "all but the borders";
  EXPECT_EQ(file.surflets.size() + file.rejected, 1200u);
  EXPECT_NEAR(file.surflets.nz[100], -1, 1e-4) << "towards the sensor at the origin";
}

TEST_F(SurfaceFiles, PlyPointsWithNormals)
{
  const std::string header = plyHeader("ascii", "element vertex 3\n" + kPlyPoint + kPlyNormal);
  const SurfaceFile file =
      load("p.ply", header + "1 2 3 0 0 2\r\n4 5 6 0 1 0\r\nnan 0 0 0 1 0\r\n");
  ASSERT_EQ(file.surflets.size(), 2u);
  EXPECT_EQ(file.rejected, 1u);
  EXPECT_EQ(file.surflets.z[0], 3);
  EXPECT_EQ(file.surflets.nz[0], 1);
  EXPECT_EQ(surfletsOf(file, 10, 1).size(), 2u);
}

TEST_F(SurfaceFiles, SurfletsKnowTheirPoint)
{
  const auto cloud = someCloud();
  pcl::PCDWriter().writeBinary(path("normals.pcd"), cloud);
  pcl::PointCloud<pcl::PointXYZ> depth(40, 30);
  for (std::size_t i = 0; i < depth.size(); ++i)
    depth[i] = {(static_cast<float>(i % 40) - 20) / 40, (static_cast<float>(i / 40) - 15) / 40, 2};
  depth[615].x = NAN;
  depth.is_dense = false;
  pcl::PCDWriter().writeBinary(path("depth.pcd"), depth);
  test::writeFile(path("points.ply"),
                  plyHeader("ascii", "element vertex 3\n" + kPlyPoint + kPlyNormal) +
                      "nan 0 0 0 1 0\n1 2 3 0 0 2\n4 5 6 0 1 0\n");
  SurfaceFileOptions with_points, estimated;
  with_points.keep_points = estimated.keep_points = true;
  estimated.estimate_normals = 8;
  for (const auto& [name, options] :
       {std::pair{"normals.pcd", with_points}, std::pair{"depth.pcd", with_points},
        std::pair{"depth.pcd", estimated}, std::pair{"points.ply", with_points}}) {
    const SurfaceFile file = loadSurface(path(name), options);
    EXPECT_EQ(loadSurface(path(name)).points, nullptr);
    ASSERT_NE(file.points, nullptr) << name;
    pcl::PointCloud<pcl::PointXYZ> points;
    pcl::fromPCLPointCloud2(file.points->cloud, points);
    EXPECT_EQ(points.size(), file.surflets.size() + file.rejected) << name;
    ASSERT_EQ(file.indices.size(), file.surflets.size()) << name;
    EXPECT_GT(file.rejected, 0u) << name;
    for (std::size_t k = 0; k < file.surflets.size(); ++k) {
      const auto& p = points[static_cast<std::size_t>(file.indices[k])];
      ASSERT_EQ(p.x, file.surflets.x[k]) << name;
      ASSERT_EQ(p.y, file.surflets.y[k]) << name;
      ASSERT_EQ(p.z, file.surflets.z[k]) << name;
    }
  }
}

TEST_F(SurfaceFiles, MeshesOfEveryKind)
{
  expectTetrahedron(load("le.ply", binaryPly(false)));
  expectTetrahedron(load("be.ply", binaryPly(true)));
  expectTetrahedron(load("t.ply", plyHeader("ascii", "element vertex 4\n" + kPlyPoint +
                                                         "element face 4\n"
                                                         "property list uchar int vertex_index\n") +
                                      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
  expectTetrahedron(load("t.stl", binaryStl(4)));
  expectTetrahedron(load("t.off", "OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                  "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
  // More normals than vertices, as exporters write them: PCL's own reader overruns its buffer.
  expectTetrahedron(load("t.obj", "# four faces\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n"
                                  "vn 0 1 0\nvn 1 0 0\nvn 1 1 1\nvn 0 0 -1\nvn 0 -1 0\n"
                                  "f 1//1 3//1 2//1\nf 1 2 4\nf 1/1 4/1 3/1\nf -3 -2 -1\n"));
  const SurfaceFile file = loadSurface(path("t.obj"));
  EXPECT_NEAR(static_cast<double>(surfletsOf(file, 1000, 1).size()), 1000, 200);
}

TEST_F(SurfaceFiles, StlAsText)
{
  const std::string facet = "facet normal 0 0 0\n outer loop\n  vertex 0 0 0\n  vertex 1e0 0 0\n"
                            "  vertex 0 +1 0\n endloop\nendfacet\n";
  const SurfaceFile file = load("t.stl", "solid a name\n" + facet + facet + "endsolid a name\n");
  ASSERT_TRUE(file.mesh.has_value());
  EXPECT_EQ(file.mesh->vertices.size(), 3u) << "equal corners are one vertex";
  EXPECT_EQ(file.mesh->triangles.size(), 2u);
  expectRefused("cut.stl", "solid a name\n" + facet, "ends before");
  expectRefused("odd.stl", "solid\nfacet\nvertex 0 0\nendsolid\n", "vertex");
}

TEST_F(SurfaceFiles, PolygonsAreSplitIntoFans)
{
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_EQ(load("q.obj", corners + "f 1 2 3 4\n").mesh->triangles.size(), 2u);
}

TEST_F(SurfaceFiles, WhatIsNoFileIsRefusedWithoutWaiting)
{
  EXPECT_NE(errorOf(path("missing.pcd")).find("no such file"), std::string::npos);
  for (const std::string ending : {".pcd", ".ply", ".obj", ".stl"}) {
    fs::create_directory(path("d" + ending));
    EXPECT_NE(errorOf(path("d" + ending)).find("directory"), std::string::npos) << ending;
    ASSERT_EQ(::mkfifo(path("pipe" + ending).c_str(), 0600), 0);
    EXPECT_NE(errorOf(path("pipe" + ending)).find("no regular file"), std::string::npos) << ending;
    expectRefused("empty" + ending, "", "empty");
    expectRefused("garbage" + ending, std::string(3000, '\x9c'), "cannot use");
  }
  expectRefused("cloud.xyz", "1 2 3\n", ".pcd, .ply, .obj, .stl or .off");
  expectRefused("noending", "1 2 3\n", ".pcd, .ply, .obj, .stl or .off");
}

TEST_F(SurfaceFiles, AbsurdCountsAllocateNothing)
{
  for (const std::string data : {"ascii", "binary", "binary_compressed"})
    expectRefused("big.pcd", pcdHeader("4000000000", data) + "0 0 0 0 0 1\n", "header is wrong");
  const std::string vertices = "element vertex 4000000000\n" + kPlyPoint;
  expectRefused("big.ply", plyHeader("ascii", vertices) + "1 2 3\n", "after 1 of the 4000000000");
  expectRefused("big.ply", plyHeader("binary_little_endian", vertices) + std::string(24, '\0'),
                "after 2 of the 4000000000");
  expectRefused("none.ply", plyHeader("ascii", "element vertex 4000000000\n"), "no properties");
  // PCL's reader would allocate width times height of these.
  expectRefused("grid.ply",
                plyHeader("ascii", "obj_info num_cols 4000000000\nobj_info num_rows 4000000000\n"
                                   "element vertex 1\n" +
                                       kPlyPoint) +
                    "1 2 3\n",
                "no normals");
  const std::string list =
      "element vertex 1\n" + kPlyPoint + "element face 1\nproperty list uint int vertex_indices\n";
  expectRefused("list.ply", plyHeader("ascii", list) + "1 2 3\n4000000000 0 0 0\n", "ends after");
  expectRefused("list.ply", plyHeader("ascii", list) + "1 2 3\n-1 0 0 0\n", "impossible length");
  expectRefused("big.stl", binaryStl(4000000000u), "4000000000");
  expectRefused("big.off", "OFF 4000000000 1 0\n0 0 0\n", "");
}

TEST_F(SurfaceFiles, EveryTruncationIsRefusedOrHarmless)
{
  pcl::PCDWriter().writeBinary(path("a.pcd"), someCloud());
  const std::string pcd = test::readFile(path("a.pcd"));
  const std::vector<std::pair<std::string, std::string>> files = {
      {"cut.pcd", pcd}, {"cut.ply", binaryPly(false)}, {"cut.stl", binaryStl(4)}};
  for (const auto& [name, content] : files)
    for (std::size_t length = 0; length < content.size(); length += 7)
      expectRefused(name, content.substr(0, length), "");
}

TEST_F(SurfaceFiles, FlippedBytesNeverCrash)
{
  pcl::PCDWriter().writeBinaryCompressed(path("a.pcd"), someCloud());
  const std::string pcd = test::readFile(path("a.pcd"));
  const std::vector<std::pair<std::string, std::string>> files = {
      {"flip.pcd", pcd},
      {"flip.ply", binaryPly(true)},
      {"flip.stl", binaryStl(4)},
      {"flip.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"}};
  for (const auto& [name, content] : files)
    for (std::size_t at = 0; at < content.size(); at += 1 + content.size() / 300)
      for (const char with : {'\0', '\xff', '9', '-', '\n'}) {
        std::string bad = content;
        bad[at] = with;
        errorOf(write(name, bad)); // any answer will do
      }
}

TEST_F(SurfaceFiles, DamagedPlyHeadersAreExplained)
{
  expectRefused("x.ply", "plz\n", "begin with 'ply'");
  expectRefused("x.ply", "ply\nformat text 1.0\n", "format");
  expectRefused("x.ply", "ply\nelement vertex 1\n" + kPlyPoint + "end_header\n1 2 3\n",
                "'end_header'");
  expectRefused("x.ply", plyHeader("ascii", "element vertex -3\n"), "count");
  expectRefused("x.ply", plyHeader("ascii", "element vertex 1\nproperty quad x\n"), "no type");
  expectRefused("x.ply", plyHeader("ascii", "property float x\n"), "does not belong");
  expectRefused("x.ply", "ply\nformat ascii 1.0\nelement vertex 1\n", "within its header");
  expectRefused("x.ply", plyHeader("ascii", "element vertex 1\nproperty float x\n") + "1\n",
                "no x, y and z");
  expectRefused("x.ply", plyHeader("ascii", "element vertex 1\n" + kPlyPoint) + "1 2 three\n",
                "line");
  expectRefused("x.ply", plyHeader("ascii", ""), "no vertices");
}

TEST_F(SurfaceFiles, FacesMustBeSound)
{
  const std::string ply = plyHeader("ascii", "element vertex 3\n" + kPlyPoint +
                                                 "element face 1\n"
                                                 "property list uchar int vertex_indices\n");
  expectRefused("x.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "out of range");
  expectRefused("x.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "out of range");
  expectRefused("x.ply", ply + "0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n", "finite");
  expectRefused("x.ply", ply + "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", "area");
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string face : {"f 1 2 4\n", "f 0 1 2\n", "f -4 1 2\n", "f a b c\n", "f / / /\n"})
    expectRefused("x.obj", obj + face, "line 4");
  expectRefused("x.obj", "v 1 2\n", "three coordinates");
  expectRefused("x.obj", obj, "no faces");
  expectRefused("x.obj", "f 1 2 3\n", "0 before it");
}

TEST_F(SurfaceFiles, PointsMustBeUsable)
{
  expectRefused("x.pcd", pcdHeader("2", "ascii") + "nan nan nan 0 0 1\n1 2 3 0 0 0\n",
                "none of its 2 points");
  expectRefused("x.pcd", pcdHeader("0", "ascii"), "no points");
  // PCL would take the entry behind DATA for one of the header; found by fuzzing.
  expectRefused("x.pcd", pcdHeader("2", "binary") + "\nCOLUMNS a b" + std::string(48, '\0'),
                "header entry COLUMNS");
  // A line of blanks ends the header for PCL, which then crashed; found by fuzzing.
  expectRefused("x.pcd", " \n" + pcdHeader("1", "binary") + std::string(24, '\0'),
                "not understood");
  // PCL would write beyond its memory; found by fuzzing.
  const std::string once = pcdHeader("1", "ascii");
  expectRefused("x.pcd", std::string(once).insert(once.find("WIDTH"), "FIELDS a b c d e f g h i\n"),
                "FIELDS comes twice");
  expectRefused("x.pcd", std::string(once).replace(once.find("TYPE F F F"), 10, "TYPE F F"),
                "types");
  // A message ends at a zero; found by fuzzing.
  expectRefused("x.pcd", std::string("VERSION 0.7\n\0\0ODD", 17) + pcdHeader("1", "ascii"),
                "unknown header entry '??ODD");
  std::string strange = pcdHeader("1", "ascii") + "1 2 3 0 0 1\n";
  strange.replace(strange.find("FIELDS x y z"), 12, "FIELDS a b c");
  expectRefused("x.pcd", strange, "x, y, z");
  std::string integers = pcdHeader("1", "ascii") + "1 2 3 0 0 1\n";
  integers.replace(integers.find("TYPE F F F"), 10, "TYPE I I I");
  expectRefused("x.pcd", integers, "type F");
  expectRefused("x.ply", plyHeader("ascii", "element vertex 1\n" + kPlyPoint) + "1 2 3\n",
                "no normals");
}
