#include "labelled_pcd.h"

#include "app_common.h"

#include <cstring>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief Everything before the points. \p viewpoint is a place and a quaternion (w, x, y, z). */
std::string
header(std::size_t width, std::size_t height, const std::string& viewpoint, bool labelled)
{
  return std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n") +
         "FIELDS x y z normal_x normal_y normal_z" + (labelled ? " label instance" : "") +
         "\nSIZE 4 4 4 4 4 4" + (labelled ? " 4 4" : "") + "\nTYPE F F F F F F" +
         (labelled ? " U U" : "") + "\nCOUNT 1 1 1 1 1 1" + (labelled ? " 1 1" : "") + "\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) + "\nVIEWPOINT " + viewpoint +
         "\nPOINTS " + std::to_string(width * height) + "\nDATA binary\n";
}

template <class Value>
void
append(std::string& text, const Value& value)
{
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  text.append(bytes, sizeof value);
}

std::string
viewpointOf(const SensorFrame& frame)
{
  std::string text;
  for (const double v : frame.position)
    text += number(v) + " ";
  const auto q = frame.quaternion();
  return text + number(q[0]) + " " + number(q[1]) + " " + number(q[2]) + " " + number(q[3]);
}

} // namespace

std::string
asPcd(const SurfletSet& set, const PointLabels* labels)
{
  const bool labelled = labels != nullptr;
  std::string text = header(set.size(), 1, "0 0 0 1 0 0 0", labelled);
  text.reserve(text.size() + set.size() * (labelled ? 32 : 24));
  for (std::size_t i = 0; i < set.size(); ++i) {
    append(text, set[i]); // six floats
    if (labelled) {
      append(text, labels->labels[i]);
      append(text, labels->instances[i]);
    }
  }
  return text;
}

std::string
asPcd(const OrientedScan& s)
{
  std::string text = header(s.scan.columns, s.scan.rows, viewpointOf(s.scan.frame), true);
  text.reserve(text.size() + s.scan.z.size() * 32);
  for (std::size_t i = 0; i < s.scan.z.size(); ++i) {
    append(text, Surflet{s.scan.x[i], s.scan.y[i], s.scan.z[i], s.nx[i], s.ny[i], s.nz[i]});
    append(text, s.scan.labels[i]);
    append(text, s.scan.instances[i]);
  }
  return text;
}

} // namespace apps
} // namespace pcl_surflet
