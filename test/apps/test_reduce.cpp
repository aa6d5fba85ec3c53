// pcl_surflet_reduce: what it makes of clouds, right and wrong.
#include "../full_disk.h"
#include "app_runner.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

using Numbers = std::vector<float>; ///< x y z normal_x normal_y normal_z, point after point

const char* const kFields = "x y z normal_x normal_y normal_z";

std::string
asciiPcd(const Numbers& values, const std::string& fields = kFields, const std::string& type = "F",
         const std::string& size = "4")
{
  std::string types, sizes, counts, body;
  std::size_t width = 1 + static_cast<std::size_t>(std::count(fields.begin(), fields.end(), ' '));
  for (std::size_t i = 0; i < width; ++i) {
    types += " " + type;
    sizes += " " + size;
    counts += " 1";
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    body += std::to_string(values[i]) + ((i + 1) % width == 0 ? "\n" : " ");
  const std::string n = std::to_string(values.size() / width);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE" + sizes + "\nTYPE" + types +
         "\nCOUNT" + counts + "\nWIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS " + n +
         "\nDATA ascii\n" + body;
}

/** \brief The values of a binary PCD of single floats. */
Numbers
valuesOf(const std::string& pcd)
{
  const std::string mark = "DATA binary\n";
  const std::size_t begin = pcd.find(mark) + mark.size();
  Numbers values((pcd.size() - begin) / sizeof(float));
  std::memcpy(values.data(), pcd.data() + begin, values.size() * sizeof(float));
  return values;
}

/** \brief Two cells of edge 1, one whose normals cancel, and a point that is not finite. */
Numbers
someSurflets()
{
  return {0.25f, 0.25f, 0.5f, 0, 0, 1, 0.75f, 0.25f, 0.5f, 0, 0, 1,  //
          5.5f,  0.5f,  0.5f, 1, 0, 0, 5.5f,  0.75f, 0.5f, 0, 1, 0,  //
          9.5f,  0.5f,  0.5f, 0, 0, 1, 9.5f,  0.5f,  0.5f, 0, 0, -1, //
          NAN,   0,     0,    0, 0, 1};
}

class Reduce : public Apps {
protected:
  AppRun
  reduce(std::vector<std::string> extra)
  {
    extra.insert(extra.begin(), {path("in.pcd"), path("out.pcd")});
    return run("reduce", extra);
  }
};

} // namespace

TEST_F(Reduce, CellsAreMeansAndCountsAddUp)
{
  writeFile(path("in.pcd"), asciiPcd(someSurflets()));
  const AppRun r = reduce({"-leaf", "1", "-csv"});
  ASSERT_TRUE(ended(r, 0, {}));
  EXPECT_EQ(r.out, "input,output,cancelled_cells,left_out\n7,2,1,3\n");
  EXPECT_EQ(r.err, "");
  const std::string out = readFile(path("out.pcd"));
  EXPECT_NE(out.find("POINTS 2\n"), std::string::npos);
  EXPECT_NE(out.find("VIEWPOINT 1 2 3 1 0 0 0\n"), std::string::npos) << "the sensor's";
  const float half = std::sqrt(0.5f);
  const Numbers expected = {0.5f, 0.25f, 0.5f, 0, 0, 1, 5.5f, 0.625f, 0.5f, half, half, 0};
  const Numbers values = valuesOf(out);
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], expected[i], 1e-6f) << i;
}

TEST_F(Reduce, MinimumNormalAndMessage)
{
  writeFile(path("in.pcd"), asciiPcd(someSurflets()));
  EXPECT_EQ(reduce({"-leaf", "1", "-min_normal", "0.9", "-csv"}).out,
            "input,output,cancelled_cells,left_out\n7,1,2,5\n");
  const AppRun r = reduce({"-leaf", "1"});
  EXPECT_TRUE(ended(r, 0, {path("out.pcd"), "7 points -> 2 mean surflets", "1 cells"}));
  EXPECT_EQ(r.out, "");
}

TEST_F(Reduce, OtherFieldsAreThoseOfTheFirstPointAndRunsAgree)
{
  const Numbers points = {0, 0, 0, 0, 0, 1, 7, 0.5f, 0, 0, 0, 0, 1, 9};
  writeFile(path("in.pcd"), asciiPcd(points, std::string(kFields) + " curvature"));
  ASSERT_TRUE(ended(reduce({"-leaf", "1"}), 0, {}));
  const std::string once = readFile(path("out.pcd"));
  EXPECT_EQ(valuesOf(once), (Numbers{0.25f, 0, 0, 0, 0, 1, 7}));
  ASSERT_TRUE(ended(reduce({"-leaf", "1"}), 0, {}));
  EXPECT_TRUE(readFile(path("out.pcd")) == once);
  // What is read is not overwritten.
  const std::string before = readFile(path("in.pcd"));
  EXPECT_TRUE(
      ended(run("reduce", {path("in.pcd"), path("in.pcd"), "-leaf", "1"}), 2, {"named twice"}));
  EXPECT_TRUE(readFile(path("in.pcd")) == before);
}

TEST_F(Reduce, ARealSizedCloud)
{
  makeShapes();
  ASSERT_TRUE(ended(run("reduce", {path("ball.pcd"), path("out.pcd"), "-leaf", "0.03"}), 0, {}));
  const Numbers values = valuesOf(readFile(path("out.pcd")));
  ASSERT_EQ(values.size() % 6, 0u);
  EXPECT_GT(values.size(), 600u);
  EXPECT_LT(values.size(), 6000u);
  for (std::size_t i = 0; i < values.size(); i += 6)
    EXPECT_NEAR(std::hypot(values[i + 3], values[i + 4], values[i + 5]), 1, 1e-5) << i;
}

TEST_F(Reduce, WrongUsageIsNamed)
{
  writeFile(path("in.pcd"), asciiPcd(someSurflets()));
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "-leaf"},
      {{"-leaf"}, "-leaf"},
      {{"-leaf", "1", "-leaf", "2"}, "-leaf"},
      {{"-leaf", "1", "-min_normal"}, "-min_normal"},
      {{"-leaf", "1", "-colour", "red"}, "-colour"},
      {{"-leaf", "1", "third.pcd"}, "third.pcd"}};
  for (const auto& [arguments, named] : wrong)
    EXPECT_TRUE(ended(reduce(arguments), 1, {named, "-h"})) << named;
  for (const std::string bad : {"abc", "1x", "", "0", "-1", "nan", "inf", "1e999", "1,5"})
    EXPECT_TRUE(ended(reduce({"-leaf", bad}), 1, {"-leaf", "-h"})) << bad;
  for (const std::string bad : {"abc", "-0.1", "1.1", "nan", ""})
    EXPECT_TRUE(ended(reduce({"-leaf", "1", "-min_normal", bad}), 1, {"-min_normal"})) << bad;
  EXPECT_TRUE(ended(run("reduce", {"-leaf", "1", path("in.pcd")}), 1, {"OUT.pcd", "-h"}));
  EXPECT_FALSE(fs::exists(path("out.pcd")));
}

TEST_F(Reduce, FilesItCannotUseAreNamedAndTheOutputIsKept)
{
  const std::string good = asciiPcd(someSurflets());
  const Numbers nan(12, NAN);
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "empty"},
      {std::string(5000, '\xfe'), "PCD"},
      {good.substr(0, good.size() / 4), "PCD"},
      {good.substr(0, good.find("DATA ascii") + 20), "truncated"},
      {asciiPcd({0, 0, 0, 1, 1, 1}, "x y z"), "normal_x"},
      {asciiPcd({0, 0, 1, 1, 1, 1}, "x y normal_x normal_y normal_z curvature"), "no field z"},
      {asciiPcd(someSurflets(), kFields, "F", "8"), "FLOAT32"},
      {asciiPcd({}), "no points"},
      {asciiPcd(nan), "no cell has a mean surflet"},
      {asciiPcd({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1}), "cancel"}};
  writeFile(path("out.pcd"), "kept");
  for (const auto& [content, word] : bad) {
    writeFile(path("in.pcd"), content);
    EXPECT_TRUE(ended(reduce({"-leaf", "1"}), 2, {path("in.pcd"), word, ";"})) << word;
    EXPECT_EQ(readFile(path("out.pcd")), "kept") << word;
  }
  fs::remove(path("in.pcd"));
  EXPECT_TRUE(ended(reduce({"-leaf", "1"}), 2, {path("in.pcd"), "does not exist"}));
  writeFile(path("in.pcd"), good);
  EXPECT_TRUE(ended(reduce({"-leaf", "1e-29"}), 2, {path("in.pcd"), "larger -leaf"}));
  EXPECT_EQ(readFile(path("out.pcd")), "kept");
}

TEST_F(Reduce, PlacesItCannotWriteTo)
{
  writeFile(path("in.pcd"), asciiPcd(someSurflets()));
  const std::string nowhere = path("no/such/directory/out.pcd");
  for (const auto& out : {nowhere, directory_.string()})
    EXPECT_TRUE(ended(run("reduce", {path("in.pcd"), out, "-leaf", "1"}), 2, {out, "directory"}));
  writeFile(path("out.pcd"), "kept");
  {
    const FullDisk full(200); // less than a header, more than the messages
    EXPECT_TRUE(ended(reduce({"-leaf", "1"}), 2, {"cannot write"}));
  }
  EXPECT_EQ(readFile(path("out.pcd")), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 2)
      << "nothing else is left behind";
}
