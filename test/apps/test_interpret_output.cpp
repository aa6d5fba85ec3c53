// What pcl_surflet_interpret -out writes: the scene as it was, and what is known of its points.
#include "app_runner.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>

using namespace pcl_surflet::test;

namespace {

/** \brief A binary PCD: its header, and where its points begin. */
struct Pcd {
  std::map<std::string, std::string> header;
  std::string points;

  explicit Pcd(const std::string& file)
  {
    const std::size_t end = file.find("DATA binary\n") + 12;
    std::istringstream lines(file.substr(0, end));
    for (std::string line; std::getline(lines, line);)
      header[line.substr(0, line.find(' '))] = line.substr(line.find(' ') + 1);
    points = file.substr(end);
  }
  std::size_t
  size() const
  {
    return std::stoul(header.at("POINTS"));
  }
  template <class Value>
  Value
  at(std::size_t point, std::size_t byte) const
  {
    Value value;
    std::memcpy(&value, points.data() + point * (points.size() / size()) + byte, sizeof value);
    return value;
  }
};

/** \brief A point as sensors deliver it, with more than we ask for, and something between. */
#pragma pack(push, 1)
struct CameraPoint {
  std::uint32_t rgb;
  float x, y, z;
  char padding[4];
  double time;
  float normal_x, normal_y, normal_z;
  std::uint32_t label; // of someone else
};
struct LabelledPoint {
  std::uint32_t rgb;
  float x, y, z;
  double time;
  float normal_x, normal_y, normal_z;
  std::uint32_t label, instance;
};
#pragma pack(pop)

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/** \brief The points of a scene of ours; every seventh has no normal, every eleventh is NaN. */
std::vector<CameraPoint>
seenByACamera(const Pcd& scene)
{
  std::vector<CameraPoint> out(scene.size() / 2 * 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::array<float, 6> s = scene.at<std::array<float, 6>>(i, 0);
    if (i % 7 == 3)
      s[3] = s[4] = s[5] = kNaN;
    if (i % 11 == 5)
      s[0] = s[1] = s[2] = kNaN;
    out[i] = {static_cast<std::uint32_t>(i * 77),
              s[0],
              s[1],
              s[2],
              {},
              0.25 * double(i),
              s[3],
              s[4],
              s[5],
              9999};
  }
  return out;
}

std::string
asFile(const std::vector<CameraPoint>& points)
{
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS rgb x y z _ time normal_x normal_y normal_z label\n"
         "SIZE 4 4 4 4 1 8 4 4 4 4\nTYPE U F F F U F F F F U\nCOUNT 1 1 1 1 4 1 1 1 1 1\n"
         "WIDTH " +
         std::to_string(points.size() / 2) + "\nHEIGHT 2\nVIEWPOINT 0.5 0.25 2 0 1 0 0\nPOINTS " +
         std::to_string(points.size()) + "\nDATA binary\n" +
         std::string(reinterpret_cast<const char*>(points.data()),
                     points.size() * sizeof(CameraPoint));
}

bool
same(float a, float b)
{
  return a == b || (std::isnan(a) && std::isnan(b));
}

class InterpretOutput : public Apps {
protected:
  void
  SetUp() override
  {
    ASSERT_NO_FATAL_FAILURE(makeSceneDatabase({"bottle", "torus"}, "20000"));
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-empty", path("e.pcd"), "-density", "100000",
                               "bottle", "torus"})
                  .code,
              0);
    camera_ = seenByACamera(Pcd(readFile(path("s.pcd"))));
    writeFile(path("camera.pcd"), asFile(camera_));
  }
  AppRun
  interpreted(const std::string& scene, std::vector<std::string> more = {})
  {
    std::vector<std::string> all = {"-database", path("db.pcd"), "-background",   "exclude",
                                    "-empty",    path("e.pcd"),  "-leaf",         "0.008",
                                    "-csv",      "-out",         path("out.pcd"), path(scene)};
    all.insert(all.begin(), more.begin(), more.end());
    return run("interpret", all);
  }
  std::vector<CameraPoint> camera_;
};

} // namespace

TEST_F(InterpretOutput, KeepsFieldsRowsColumnsAndViewpoint)
{
  ASSERT_TRUE(ended(interpreted("camera.pcd"), 0, {"points left out"}));
  const Pcd out(readFile(path("out.pcd")));
  EXPECT_EQ(out.header.at("FIELDS"), "rgb x y z time normal_x normal_y normal_z label instance");
  EXPECT_EQ(out.header.at("WIDTH"), std::to_string(camera_.size() / 2));
  EXPECT_EQ(out.header.at("HEIGHT"), "2");
  EXPECT_EQ(out.header.at("VIEWPOINT"), "0.5 0.25 2 0 1 0 0");
  ASSERT_EQ(out.points.size(), camera_.size() * sizeof(LabelledPoint));
  for (std::size_t i = 0; i < camera_.size(); ++i) {
    const auto a = camera_[i];
    const auto b = out.at<LabelledPoint>(i, 0);
    ASSERT_EQ(+a.rgb, +b.rgb) << i; // copies: packed members may lie anywhere
    ASSERT_EQ(+a.time, +b.time) << i;
    ASSERT_TRUE(same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z)) << i;
  }
}

TEST_F(InterpretOutput, LabelsThePointsThatWereFound)
{
  const AppRun r = interpreted("camera.pcd");
  ASSERT_TRUE(ended(r, 0, {}));
  const auto table = parseCsv(r.out);
  ASSERT_EQ(table.size(), 3u);
  const Pcd out(readFile(path("out.pcd"))), truth(readFile(path("s.pcd")));
  std::array<std::size_t, 3> points{};
  std::size_t right = 0;
  for (std::size_t i = 0; i < camera_.size(); ++i) {
    const auto p = out.at<LabelledPoint>(i, 0);
    ASSERT_LE(+p.instance, 2u);
    ++points[p.instance];
    const bool unusable = i % 7 == 3 || i % 11 == 5;
    ASSERT_EQ(std::isnan(p.normal_x), unusable) << i;
    if (unusable) {
      ASSERT_EQ(p.label + p.instance, 0u) << i;
    }
    else if (p.instance > 0) {
      right += p.label == truth.at<std::uint32_t>(i, 24);
      // Labels count the database's models, which are in the order of the alphabet.
      ASSERT_EQ(+p.label, table[p.instance][1] == "bottle" ? 1u : 2u) << i;
    }
  }
  for (std::size_t k = 1; k < 3; ++k)
    EXPECT_EQ(std::to_string(points[k]), table[k][2]);
  EXPECT_GT(double(right), 0.95 * double(points[1] + points[2])) << "the right points";
}

TEST_F(InterpretOutput, OfPointsWithEstimatedNormals)
{
  for (auto& p : camera_)
    p.normal_x = p.normal_y = p.normal_z = 0;
  writeFile(path("bare.pcd"), asFile(camera_));
  const AppRun r = interpreted("bare.pcd", {"-k", "12"});
  ASSERT_TRUE(ended(r, 0, {"points left out"}));
  const Pcd out(readFile(path("out.pcd")));
  ASSERT_EQ(out.size(), camera_.size());
  std::size_t with_normal = 0;
  for (std::size_t i = 0; i < camera_.size(); ++i) {
    const auto p = out.at<LabelledPoint>(i, 0);
    const double length = std::hypot(p.normal_x, p.normal_y, p.normal_z);
    if (std::isfinite(length)) {
      ++with_normal;
      ASSERT_NEAR(length, 1, 1e-5) << i;
    }
    ASSERT_EQ(std::isnan(p.x), i % 11 == 5) << i;
    ASSERT_EQ(std::isnan(length), i % 11 == 5) << i;
  }
  EXPECT_EQ(with_normal, camera_.size() - (camera_.size() + 5) / 11);
}

TEST_F(InterpretOutput, LeavesOutFieldsOfNoKnownType)
{
  std::string odd = asFile(camera_);
  odd.replace(odd.find("TYPE U"), 6, "TYPE X");
  writeFile(path("odd.pcd"), odd);
  ASSERT_TRUE(ended(interpreted("odd.pcd"), 0, {}));
  const Pcd out(readFile(path("out.pcd")));
  EXPECT_EQ(out.header.at("FIELDS"), "x y z time normal_x normal_y normal_z label instance");
  ASSERT_EQ(out.points.size(), camera_.size() * (sizeof(LabelledPoint) - 4));
  EXPECT_EQ(out.at<float>(0, 0), camera_[0].x);
  EXPECT_TRUE(ended(run("reduce", {"-leaf", "0.01", path("out.pcd"), path("less.pcd")}), 0, {}));
}

TEST_F(InterpretOutput, OfAPly)
{
  std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(camera_.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
                    "property float ny\nproperty float nz\nend_header\n";
  for (const auto& p : camera_) {
    for (const float v : {p.x, p.y, p.z, p.normal_x, p.normal_y})
      ply += std::to_string(v) + " ";
    ply += std::to_string(p.normal_z) + "\n";
  }
  writeFile(path("camera.ply"), ply);
  ASSERT_TRUE(ended(interpreted("camera.ply"), 0, {"points left out"}));
  const Pcd out(readFile(path("out.pcd")));
  EXPECT_EQ(out.header.at("FIELDS"), "x y z normal_x normal_y normal_z label instance");
  ASSERT_EQ(out.size(), camera_.size());
  for (std::size_t i = 0; i < camera_.size(); ++i)
    ASSERT_TRUE(std::isnan(camera_[i].x) ? std::isnan(out.at<float>(i, 0))
                                         : std::abs(out.at<float>(i, 0) - camera_[i].x) < 1e-5)
        << i;
}
