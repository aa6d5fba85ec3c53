// Objects found by pcl_surflet_interpret.
#include "app_runner.h"

#include <cmath>

using namespace pcl_surflet::test;

namespace {

class Interpret : public Apps {
protected:
  void
  SetUp() override
  {
    Apps::SetUp();
    for (const std::string shape : {"bottle", "torus"}) {
      ASSERT_EQ(run("generate_shape", {shape, path(shape + ".pcd"), "-points", "20000"}).code, 0);
      ASSERT_EQ(run("train", {"-database", path("db.pcd"), "-bins", "7,7,7,7", "-pairs", "1000000",
                              path(shape + ".pcd")})
                    .code,
                0);
    }
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-poses", path("p.csv"), "-empty",
                               path("e.pcd"), "-density", "100000", "bottle", "torus"})
                  .code,
              0);
  }
};

} // namespace

TEST_F(Interpret, FindsWhatWasPutThere)
{
  const AppRun r = run("interpret", {"-database", path("db.pcd"), "-background", "exclude",
                                     "-empty", path("e.pcd"), "-leaf", "0.008", "-csv", "-verbose",
                                     "-out", path("labelled.pcd"), path("s.pcd")});
  ASSERT_TRUE(ended(r, 0, {"drawn", "bottle", "torus"}));
  const auto table = parseCsv(r.out);
  const auto truth = parseCsv(readFile(path("p.csv")));
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t row = 1; row < 3; ++row) {
    const auto& item = truth[table[row][1] == "bottle" ? 1 : 2];
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(std::stod(table[row][3 + axis]), std::stod(item[20 + axis]), 0.02);
  }
  EXPECT_NE(table[1][1], table[2][1]);
  EXPECT_NE(readFile(path("labelled.pcd")).find("FIELDS x y z label"), std::string::npos);
}

TEST_F(Interpret, GoesOnAfterABadFile)
{
  const AppRun r = run("interpret", {"-database", path("db.pcd"), path("none.pcd"), path("s.pcd")});
  EXPECT_TRUE(ended(r, 2, {"none.pcd"}));
  EXPECT_NE(r.out.find("s.pcd"), std::string::npos);
}

TEST_F(Interpret, SaysWhatIsMissing)
{
  EXPECT_TRUE(
      ended(run("interpret", {"-database", path("db.pcd"), "-background", "model", path("s.pcd")}),
            2, {"background model"}));
  EXPECT_TRUE(ended(run("interpret", {"-database", path("no.pcd"), path("s.pcd")}), 2, {"no.pcd"}));
}
