#include "experiment/gallery.h"

#include "app_common.h"
#include "experiment/output.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr std::size_t kObjectsPerRow = 5;
constexpr const char* kGallery = "objects.png";
constexpr std::size_t kDots = 9000;

struct Dot {
  double x, y, depth;
  int grey;
};

/** \brief Dots of the object seen from the front, a little from above and the right, lit from the
 * left above, the nearest last. */
std::vector<Dot>
dotsOf(const TriangleMesh& mesh)
{
  const SurfletSet s = sampleIsoMesh(mesh, kDots, 5);
  const double yaw = 0.6, pitch = 0.35;
  const auto turned = [&](double x, double y, double z) {
    const double u = std::cos(yaw) * x + std::sin(yaw) * z,
                 d = -std::sin(yaw) * x + std::cos(yaw) * z;
    return std::array<double, 3>{u, std::cos(pitch) * y - std::sin(pitch) * d,
                                 std::sin(pitch) * y + std::cos(pitch) * d};
  };
  std::vector<Dot> dots;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto p = turned(s.x[i], s.y[i], s.z[i]), n = turned(s.nx[i], s.ny[i], s.nz[i]);
    const double light = std::max(0.0, (-0.45 * n[0] + 0.6 * n[1] + 0.66 * n[2]));
    dots.push_back({p[0], p[1], p[2], static_cast<int>(60 + 180 * light)});
  }
  std::sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.depth < b.depth; });
  return dots;
}

std::string
pointData(const std::vector<ExperimentObject>& objects)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  for (const auto& object : objects) {
    for (const auto& dot : dotsOf(object.mesh))
      out << dot.x << ' ' << dot.y << ' '
          << (dot.grey * 65536 + dot.grey * 256 + std::min(255, dot.grey + 15)) << '\n';
    out << "\n\n";
  }
  return out.str();
}

std::string
histogramData(const ModelDatabase& database)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  for (std::size_t m = 0; m < database.size(); ++m) {
    const auto& h = database[m].members.front().histogram;
    for (std::size_t b = 0; b < h.size(); ++b)
      out << b << ' ' << std::sqrt(h[b]) << '\n';
    out << "\n\n";
  }
  return out.str();
}

/** \brief One cell of the grid: the object in the upper part, its histogram below. */
void
addCell(std::ostringstream& script, const std::string& label, std::size_t i, std::size_t rows)
{
  const double width = 1.0 / kObjectsPerRow, height = 1.0 / static_cast<double>(rows);
  const std::size_t row = i / kObjectsPerRow;
  const double x = width * static_cast<double>(i % kObjectsPerRow);
  const double y = 1 - height * static_cast<double>(row + 1);
  script << "set size " << width << "," << 0.74 * height << "\nset origin " << x << ","
         << y + 0.26 * height << "\nset title '" << label << "' noenhanced offset 0,-0.7\n"
         << "set size ratio -1\nset autoscale\n"
         << "plot 'points.dat' index " << i
         << " using 1:2:3 with points pt 7 ps 0.35 lc rgb variable\n"
         << "unset title\nset size noratio\nset size " << width << "," << 0.25 * height
         << "\nset origin " << x << "," << y << "\nset xrange [0:*]\nset yrange [0:*]\n"
         << "plot 'histograms.dat' index " << i << " using 1:2 with impulses lc rgb '#1f5fa8'\n";
}

std::string
scriptFor(const std::vector<ExperimentObject>& objects)
{
  const std::size_t rows = (objects.size() + kObjectsPerRow - 1) / kObjectsPerRow;
  std::ostringstream script;
  script.imbue(std::locale::classic());
  script << "set terminal pngcairo size 1500," << 330 * rows << " font 'sans,12'\n"
         << outputStatements(kGallery) << "unset key\nunset tics\nunset border\n"
         << "set lmargin 1\nset rmargin 1\nset bmargin 0.3\nset tmargin 1.2\nset multiplot\n";
  for (std::size_t i = 0; i < objects.size(); ++i)
    addCell(script, objects[i].label, i, rows);
  script << "unset multiplot\n";
  return script.str();
}

} // namespace

std::string
drawGallery(const std::vector<ExperimentObject>& objects, const ModelDatabase& database,
            const std::string& directory)
{
  writeFile(directory + "/points.dat", pointData(objects));
  writeFile(directory + "/histograms.dat", histogramData(database));
  writeFile(directory + "/gallery.gp", scriptFor(objects));
  return drawByGnuplot(directory, "gallery.gp", kGallery);
}

} // namespace apps
} // namespace pcl_surflet
