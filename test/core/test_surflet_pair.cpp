#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/pair_histogram.h"
#include "pcl_surflet/core/surflet_pair.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace pcl_surflet;

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

std::array<double, 3>
unitVector(CounterRandom& random)
{
  const double z = random.uniform(-1, 1), t = random.uniform(0, 2 * M_PI);
  return {std::sqrt(1 - z * z) * std::cos(t), std::sqrt(1 - z * z) * std::sin(t), z};
}

Surflet
randomSurflet(CounterRandom& random)
{
  const auto n = unitVector(random);
  return {float(random.uniform(-1, 1)),
          float(random.uniform(-1, 1)),
          float(random.uniform(-1, 1)),
          float(n[0]),
          float(n[1]),
          float(n[2])};
}

Surflet
mirrored(Surflet s)
{
  s.x = -s.x;
  s.nx = -s.nx;
  return s;
}

/** \brief Rotation by \p angle about the unit \p axis (Rodrigues). */
Matrix
rotation(const std::array<double, 3>& a, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {{{c + a[0] * a[0] * (1 - c), a[0] * a[1] * (1 - c) - a[2] * s,
            a[0] * a[2] * (1 - c) + a[1] * s},
           {a[1] * a[0] * (1 - c) + a[2] * s, c + a[1] * a[1] * (1 - c),
            a[1] * a[2] * (1 - c) - a[0] * s},
           {a[2] * a[0] * (1 - c) - a[1] * s, a[2] * a[1] * (1 - c) + a[0] * s,
            c + a[2] * a[2] * (1 - c)}}};
}

Surflet
moved(const Surflet& s, const Matrix& m, const std::array<double, 3>& t)
{
  const auto row = [&](int i, float x, float y, float z) {
    return m[i][0] * x + m[i][1] * y + m[i][2] * z;
  };
  return {float(row(0, s.x, s.y, s.z) + t[0]), float(row(1, s.x, s.y, s.z) + t[1]),
          float(row(2, s.x, s.y, s.z) + t[2]), float(row(0, s.nx, s.ny, s.nz)),
          float(row(1, s.nx, s.ny, s.nz)),     float(row(2, s.nx, s.ny, s.nz))};
}

void
expectNear(const PairFeature& a, const PairFeature& b, double tolerance)
{
  // alpha is periodic
  EXPECT_NEAR(std::remainder(a.alpha - b.alpha, 2 * M_PI), 0, tolerance);
  EXPECT_NEAR(a.beta, b.beta, tolerance);
  EXPECT_NEAR(a.gamma, b.gamma, tolerance);
  EXPECT_NEAR(a.delta, b.delta, tolerance);
}

} // namespace

TEST(SurfletPair, HandComputedExample)
{
  // d = (2,0,0), n1 = z, n2 = (0.6,0,0.8): |n1.d| = 0 < |n2.d|, so the origin is p1.
  // u = z, v = d x u / 2 = -y, w = u x v = x; alpha = atan2(0.6, 0.8), beta = 0, gamma = 0.
  const auto f = computePairFeature({0, 0, 0, 0, 0, 1}, {2, 0, 0, 0.6f, 0, 0.8f});
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->alpha, std::atan2(0.6, 0.8), 1e-7);
  EXPECT_NEAR(f->beta, 0, 1e-7);
  EXPECT_NEAR(f->gamma, 0, 1e-7);
  EXPECT_DOUBLE_EQ(f->delta, 2);
}

TEST(SurfletPair, OriginIsTheEndWithTheMoreOrthogonalNormal)
{
  // n2 is orthogonal to d, n1 is not: the origin is p2 and d points to p1 [Wahl 2007, Eq. 2.2].
  const auto f = computePairFeature({2, 0, 0, 0.6f, 0, 0.8f}, {0, 0, 0, 0, 0, 1});
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->gamma, 0, 1e-7);
  EXPECT_NEAR(f->alpha, std::atan2(0.6, 0.8), 1e-7);
}

TEST(SurfletPair, TieTakesTheLargerGamma)
{
  // Parallel normals on two steps of a stair tie; gamma is +-0.6 depending on the end.
  const Surflet low{0, 0, 0, 0, 0, 1}, high{4, 0, 3, 0, 0, 1};
  for (const auto& f : {computePairFeature(low, high), computePairFeature(high, low)}) {
    ASSERT_TRUE(f);
    EXPECT_NEAR(f->gamma, 0.6, 1e-7);
  }
}

TEST(SurfletPair, TieSurvivesRounding)
{
  CounterRandom random(11);
  const Surflet low{0, 0, 0, 0, 0, 1}, high{4, 0, 3, 0, 0, 1};
  for (int i = 0; i < 1000; ++i) {
    const auto m = rotation(unitVector(random), random.uniform(0, 2 * M_PI));
    const auto f = computePairFeature(moved(low, m, {0, 0, 0}), moved(high, m, {0, 0, 0}));
    ASSERT_TRUE(f);
    EXPECT_NEAR(f->gamma, 0.6, 1e-6);
  }
}

TEST(SurfletPair, PlaneHasZeroAngles)
{
  CounterRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto m = rotation(unitVector(random), random.uniform(0, 2 * M_PI));
    const Surflet a{float(random.uniform()), float(random.uniform()), 0, 0, 0, 1};
    const Surflet b{float(random.uniform()), float(random.uniform()), 0, 0, 0, 1};
    const auto f = computePairFeature(moved(a, m, {0, 0, 0}), moved(b, m, {0, 0, 0}));
    ASSERT_TRUE(f);
    // Single-precision points: the angle error grows as the two points approach each other.
    const double tolerance = 1e-6 + 1e-6 / f->delta;
    EXPECT_NEAR(f->alpha, 0, tolerance);
    EXPECT_NEAR(f->beta, 0, tolerance);
    EXPECT_NEAR(f->gamma, 0, tolerance);
  }
}

TEST(SurfletPair, SphereFeatureDependsOnDistanceAlone)
{
  // On a sphere of radius R: gamma = -delta / (2R), beta = 0 and alpha is the central angle.
  CounterRandom random(2);
  const double radius = 0.7;
  for (int i = 0; i < 1000; ++i) {
    const auto a = unitVector(random), b = unitVector(random);
    const auto f =
        computePairFeature({float(radius * a[0]), float(radius * a[1]), float(radius * a[2]),
                            float(a[0]), float(a[1]), float(a[2])},
                           {float(radius * b[0]), float(radius * b[1]), float(radius * b[2]),
                            float(b[0]), float(b[1]), float(b[2])});
    if (!f)
      continue; // antipodal
    EXPECT_NEAR(f->gamma, -f->delta / (2 * radius), 1e-5);
    EXPECT_NEAR(f->beta, 0, 1e-5);
    EXPECT_NEAR(f->alpha, 2 * std::asin(std::min(1.0, f->delta / (2 * radius))), 2e-3);
  }
}

TEST(SurfletPair, InvariantToOrderAndRigidMotion)
{
  CounterRandom random(3);
  for (int i = 0; i < 2000; ++i) {
    const Surflet a = randomSurflet(random), b = randomSurflet(random);
    const auto f = computePairFeature(a, b), g = computePairFeature(b, a);
    ASSERT_TRUE(f && g);
    expectNear(*f, *g, 1e-12);
    const auto m = rotation(unitVector(random), random.uniform(0, 2 * M_PI));
    const auto h = computePairFeature(moved(a, m, {1, 2, 3}), moved(b, m, {1, 2, 3}));
    ASSERT_TRUE(h);
    expectNear(*f, *h, 2e-5 / std::min(1.0, f->delta));
  }
}

TEST(SurfletPair, MirrorImageDiffers)
{
  CounterRandom random(4);
  int differing = 0;
  for (int i = 0; i < 100; ++i) {
    const Surflet a = randomSurflet(random), b = randomSurflet(random);
    const auto f = computePairFeature(a, b), g = computePairFeature(mirrored(a), mirrored(b));
    ASSERT_TRUE(f && g);
    EXPECT_NEAR(f->beta, -g->beta, 1e-6);
    EXPECT_NEAR(f->gamma, g->gamma, 1e-6);
    differing += std::abs(f->beta - g->beta) > 1e-3;
  }
  EXPECT_GT(differing, 90);
}

TEST(SurfletPair, RejectsPairsWithoutFeature)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Surflet s{0, 0, 0, 0, 0, 1};
  EXPECT_FALSE(computePairFeature(s, s));                   // coincident
  EXPECT_FALSE(computePairFeature(s, {0, 0, 2, 0, 0, 1}));  // both normals along d
  EXPECT_FALSE(computePairFeature(s, {0, 0, 2, 0, 0, -1})); // a slab
  EXPECT_TRUE(computePairFeature(s, {0, 0, 2, 1, 0, 0}));   // one normal along d is fine
  EXPECT_FALSE(computePairFeature(s, {nan, 0, 2, 1, 0, 0}));
  EXPECT_FALSE(computePairFeature(s, {inf, 0, 2, 1, 0, 0}));
  EXPECT_FALSE(computePairFeature(s, {1, 0, 2, nan, 0, 0}));
  EXPECT_FALSE(computePairFeature(s, {1, 0, 2, inf, 0, 0}));
}

TEST(SurfletPair, AbsurdScalesStayFinite)
{
  for (const float scale : {1e-30f, 1e-10f, 1e10f, 1e30f}) {
    const auto f = computePairFeature({0, 0, 0, 0, 0, 1}, {2 * scale, 0, 0, 0.6f, 0, 0.8f});
    ASSERT_TRUE(f) << scale;
    EXPECT_NEAR(f->alpha, std::atan2(0.6, 0.8), 1e-6);
    EXPECT_NEAR(f->delta / (2.0 * scale), 1, 1e-6);
  }
}

TEST(BinIndex, AlphaFastestAndClosedUpperEnds)
{
  const Resolution r{3, 4, 5, 6};
  EXPECT_EQ(binIndex({-M_PI, -1, -1, 1e-9}, r, 2.0), 0);
  EXPECT_EQ(binIndex({0, -1, -1, 1e-9}, r, 2.0), 1);
  EXPECT_EQ(binIndex({-M_PI, -0.4, -1, 1e-9}, r, 2.0), 3);
  EXPECT_EQ(binIndex({-M_PI, -1, -0.5, 1e-9}, r, 2.0), 3 * 4);
  EXPECT_EQ(binIndex({-M_PI, -1, -1, 0.5}, r, 2.0), 3 * 4 * 5);
  EXPECT_EQ(binIndex({3.14159, 1, 1, 2.0}, r, 2.0), r.bins() - 1);
  EXPECT_EQ(binIndex({3.14159, 1, 1, 7.0}, r, 2.0), r.bins() - 1); // clamped [Sec. 3.3]
}

TEST(Resolution, NamesWhatIsWrong)
{
  EXPECT_TRUE(Resolution{}.problem().empty());
  EXPECT_NE((Resolution{0, 5, 5, 5}.problem().find("0,5,5,5")), std::string::npos);
  EXPECT_FALSE((Resolution{64, 64, 64, 64}.problem().empty()));
  EXPECT_TRUE((Resolution{32, 32, 32, 32}.problem().empty()));
}

TEST(PairHistogram, MergesAndNormalises)
{
  PairHistogram a({2, 1, 1, 1}), b({2, 1, 1, 1});
  a.counts = {3, 1};
  a.features = 4;
  b.counts = {0, 4};
  b.features = 4;
  b.rejected = 2;
  a.merge(b);
  EXPECT_EQ(a.counts, (std::vector<std::uint64_t>{3, 5}));
  EXPECT_EQ(a.rejected, 2u);
  EXPECT_EQ(a.normalized(), (std::vector<double>{3 / 8.0, 5 / 8.0}));
  EXPECT_THROW(a.merge(PairHistogram({3, 1, 1, 1})), std::invalid_argument);
}
