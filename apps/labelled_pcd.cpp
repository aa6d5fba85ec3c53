#include "labelled_pcd.h"

#include "app_common.h"
#include "pcl_adapters/pcd_content.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

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

/** \brief What we say of a point: a normal, a label and an instance, one after the other. */
struct PointResult {
  float normal[3];
  std::uint32_t label, instance;
};

pcl::PCLPointField
field(const char* name, std::uint8_t type)
{
  pcl::PCLPointField f;
  f.name = name;
  f.datatype = type;
  f.count = 1;
  return f;
}

/** \brief The fields of PointResult. */
std::array<pcl::PCLPointField, 5>
resultFields()
{
  constexpr auto kFloat = pcl::PCLPointField::FLOAT32, kCount = pcl::PCLPointField::UINT32;
  return {field("normal_x", kFloat), field("normal_y", kFloat), field("normal_z", kFloat),
          field("label", kCount), field("instance", kCount)};
}

std::size_t
bytesOf(const pcl::PCLPointField& f)
{
  return static_cast<std::size_t>(pcl::getFieldSize(f.datatype)) * std::max(f.count, 1U);
}

/** \brief The fields of a cloud but padding, what is of no type of PCL's (it would be written as of
 * size 0) and what results replace. */
std::vector<pcl::PCLPointField>
keptFields(const pcl::PCLPointCloud2& cloud)
{
  const auto results = resultFields();
  std::vector<pcl::PCLPointField> kept;
  for (const auto& f : cloud.fields) {
    const bool is_whole = bytesOf(f) > 0 && f.offset + bytesOf(f) <= cloud.point_step;
    const bool is_ours = std::any_of(results.begin(), results.end(),
                                     [&](const auto& r) { return r.name == f.name; });
    if (f.name != "_" && is_whole && !is_ours)
      kept.push_back(f);
  }
  return kept;
}

std::vector<PointResult>
resultsOf(const SurfaceFile& file, const PointLabels& labels)
{
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<PointResult> results(file.points->size(), {{kNone, kNone, kNone}, 0, 0});
  for (std::size_t k = 0; k < file.surflets.size(); ++k) {
    const Surflet s = file.surflets[k];
    results[static_cast<std::size_t>(file.indices[k])] = {
        {s.nx, s.ny, s.nz}, labels.labels[k], labels.instances[k]};
  }
  return results;
}

/** \brief A cloud like \p in with these fields and those of results, and room for its points. */
pcl::PCLPointCloud2
emptyLike(const pcl::PCLPointCloud2& in, const std::vector<pcl::PCLPointField>& kept)
{
  pcl::PCLPointCloud2 out;
  out.width = in.width;
  out.height = in.height;
  out.is_dense = in.is_dense;
  out.fields = kept;
  for (const auto& f : resultFields())
    out.fields.push_back(f);
  for (auto& f : out.fields) {
    f.offset = out.point_step;
    out.point_step += static_cast<std::uint32_t>(bytesOf(f));
  }
  out.row_step = out.point_step * out.width;
  out.data.resize(std::size_t{out.point_step} * in.width * in.height);
  return out;
}

} // namespace

std::string
asPcd(const SurfaceFile& file, const PointLabels& labels)
{
  const auto& in = file.points->cloud;
  const auto kept = keptFields(in);
  SourcePoints out;
  out.origin = file.points->origin;
  out.orientation = file.points->orientation;
  out.cloud = emptyLike(in, kept);
  const auto results = resultsOf(file, labels);
  auto* to = out.cloud.data.data();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto* from = in.data.data() + i * in.point_step;
    for (const auto& f : kept)
      to = std::copy_n(from + f.offset, bytesOf(f), to);
    std::memcpy(to, &results[i], sizeof results[i]);
    to += sizeof results[i];
  }
  return detail::binaryPcd(out);
}

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
