// Makes test shapes, so that examples need no data.

#include "app_common.h"
#include "scene_items.h"

#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/shapes.h"

#include <algorithm>
#include <charconv>
#include <cmath>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_generate_shape";

/** Keeps the noise apart from the draw of the points. */
constexpr std::uint64_t kNoiseStream = 0x6e6f697365ULL;

struct Options {
  std::uint64_t points = 10000, seed = 1;
  double noise = 0;
};

std::string
names()
{
  std::string out;
  for (const auto& name : shapeNames())
    out += (out.empty() ? "" : ", ") + name;
  return out;
}

/** \brief Moves a point along its normal by a uniform amount in [-noise, noise]. */
TriangleMesh::Point
moved(const TriangleMesh::Point& p, const TriangleMesh::Point& n, double noise,
      CounterRandom& random)
{
  const double step = random.uniform(-noise, noise);
  TriangleMesh::Point out{};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = static_cast<float>(p[k] + step * n[k]);
  return out;
}

SurfletSet
noisySample(const Shape& shape, const Options& o)
{
  SurfletSet set = sampleShape(shape, o.points, o.seed);
  CounterRandom random(o.seed, kNoiseStream);
  for (std::size_t i = 0; o.noise > 0 && i < set.size(); ++i) {
    const Surflet s = set[i];
    const auto p = moved({s.x, s.y, s.z}, {s.nx, s.ny, s.nz}, o.noise, random);
    set.x[i] = p[0];
    set.y[i] = p[1];
    set.z[i] = p[2];
  }
  return set;
}

/** \brief A mesh with roughly as many vertices as points were asked for. */
TriangleMesh
noisyMesh(const Shape& shape, const Options& o)
{
  TriangleMesh mesh = meshOf(shape, static_cast<double>(o.points));
  if (o.noise == 0)
    return mesh;
  const auto normals = umbrellaNormals(mesh);
  CounterRandom random(o.seed, kNoiseStream);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = moved(mesh.vertices[i], normals[i], o.noise, random);
  return mesh;
}

/** \brief Lines of numbers, each the shortest that reads back as the same value. */
template <typename Number>
void
appendNumbers(std::string& text, std::initializer_list<Number> values)
{
  char digits[32];
  for (const Number v : values) {
    text.append(digits, std::to_chars(digits, digits + sizeof digits, v).ptr);
    text += ' ';
  }
  text.back() = '\n';
}

std::string
withHeader(std::string text, const SurfletSet& set)
{
  for (std::size_t i = 0; i < set.size(); ++i)
    appendNumbers(text, {set.x[i], set.y[i], set.z[i], set.nx[i], set.ny[i], set.nz[i]});
  return text;
}

std::string
asPcd(const SurfletSet& set)
{
  const std::string n = std::to_string(set.size());
  return withHeader("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
                    "FIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\n"
                    "TYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH " +
                        n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA ascii\n",
                    set);
}

std::string
asPly(const SurfletSet& set)
{
  std::string header = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(set.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    header += std::string("property float ") + name + "\n";
  return withHeader(header + "end_header\n", set);
}

std::string
asOff(const TriangleMesh& mesh)
{
  std::string text = "OFF\n";
  appendNumbers(text, {mesh.vertices.size(), mesh.triangles.size(), std::size_t{0}});
  for (const auto& p : mesh.vertices)
    appendNumbers(text, {p[0], p[1], p[2]});
  for (const auto& t : mesh.triangles)
    appendNumbers(text, {3u, t[0], t[1], t[2]});
  return text;
}

bool
endsWith(const std::string& text, const std::string& ending)
{
  return text.size() > ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::string
contentFor(const Shape& shape, const std::string& path, const Options& o)
{
  if (endsWith(path, ".pcd"))
    return asPcd(noisySample(shape, o));
  if (endsWith(path, ".ply"))
    return asPly(noisySample(shape, o));
  if (endsWith(path, ".off"))
    return asOff(noisyMesh(shape, o));
  throw UsageError("'" + path + "' ends in none of .pcd, .ply, .off");
}

int
generate(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "NAME OUT.(pcd|ply|off)",
                   "Makes a test shape of 0.1 to 0.3 m: oriented points as PCD or PLY, a mesh as "
                   "OFF.\nNames: " +
                       names() + ".");
  line.count("-points", "N", "points, or vertices that a mesh has at least, default 10000",
             o.points, 3, 20000000);
  line.real("-noise", "S", "moves points along their normals by up to S metres, default 0", o.noise,
            0, 1e6);
  addSeed(line, o.seed);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(2, 2);
  const auto shape = shapeByName(line.files()[0]);
  if (!shape)
    throw UsageError("there is no shape '" + line.files()[0] + "'; the names are " + names());
  writeFile(line.files()[1], contentFor(*shape, line.files()[1], o));
  note("wrote '" + line.files()[1] + "'");
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return generate(argc, argv); });
}
