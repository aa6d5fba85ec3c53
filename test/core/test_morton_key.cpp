#include "pcl_surflet/core/counter_random.h"
#include "pcl_surflet/core/morton_key.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace pcl_surflet;

TEST(MortonKey, DigitsFollowFigure41)
{
  // Upper half in x sets bit 0, in y bit 1, in z bit 2.
  EXPECT_EQ(MortonKey::fromCoordinates({1, 0, 0}, 1).toString(), "1");
  EXPECT_EQ(MortonKey::fromCoordinates({0, 1, 0}, 1).toString(), "2");
  EXPECT_EQ(MortonKey::fromCoordinates({0, 0, 1}, 1).toString(), "4");
  EXPECT_EQ(MortonKey::fromCoordinates({2, 1, 3}, 2).toString(), "56");
}

TEST(MortonKey, PlanarExampleOfChapter442)
{
  const std::vector<std::string> digits = {"230", "132", "121", "303", "021", "103",
                                           "300", "013", "102", "003", "123", "120"};
  std::vector<int> inside;
  const auto start = PlanarMortonKey::fromDigits("12");
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const auto key = PlanarMortonKey::fromDigits(digits[i]);
    EXPECT_EQ(key.toString(), digits[i]);
    EXPECT_EQ(PlanarMortonKey::fromCoordinates(key.coordinates(), 3), key);
    EXPECT_EQ(key.prefix(2).toString(), digits[i].substr(0, 2));
    if (start.isPrefixOf(key))
      inside.push_back(static_cast<int>(i) + 1);
  }
  EXPECT_EQ(inside, (std::vector<int>{3, 11, 12}));
}

TEST(MortonKey, PlanarKeyIsTheSpaceKeyOnTheGround)
{
  CounterRandom random(1);
  for (int i = 0; i < 100; ++i) {
    const MortonKey::Coordinates c{random.below(1u << 21), random.below(1u << 21), 0};
    EXPECT_EQ(MortonKey::fromCoordinates(c, 21).toString(),
              PlanarMortonKey::fromCoordinates(c, 21).toString());
  }
}

template <class Key>
class KeyTest : public ::testing::Test {
};
using Keys = ::testing::Types<MortonKey, WideMortonKey, PlanarMortonKey>;
TYPED_TEST_SUITE(KeyTest, Keys);

TYPED_TEST(KeyTest, CoordinatesDigitsAndPrefixesAgreeAtEveryDepth)
{
  CounterRandom random(2);
  for (int depth = 0; depth <= std::min(63, TypeParam::max_depth); ++depth) {
    const std::uint64_t mask = (std::uint64_t{1} << depth) - 1;
    const typename TypeParam::Coordinates c{random() & mask, random() & mask,
                                            TypeParam::bits_per_digit == 3 ? random() & mask : 0};
    const auto key = TypeParam::fromCoordinates(c, depth);
    EXPECT_EQ(key.coordinates(), c) << depth;
    EXPECT_EQ(TypeParam::fromDigits(key.toString()), key);
    for (int d = 0; d <= depth; ++d) {
      EXPECT_EQ(key.prefix(d).toString(), key.toString().substr(0, d));
      EXPECT_TRUE(key.prefix(d).isPrefixOf(key));
      const int up = depth - d;
      EXPECT_EQ(key.prefix(d).coordinates(),
                (typename TypeParam::Coordinates{c[0] >> up, c[1] >> up, c[2] >> up}));
    }
  }
}

TYPED_TEST(KeyTest, OrderIsTheOrderOfTheDigits)
{
  CounterRandom random(3);
  const int depth = TypeParam::max_depth;
  std::vector<TypeParam> keys;
  std::vector<std::string> digits;
  for (int i = 0; i < 200; ++i) {
    TypeParam key;
    const int end = static_cast<int>(random.below(depth + 1));
    for (int d = 0; d < end; ++d)
      key = key.child(static_cast<int>(random.below(i % 2 ? 2 : 1 << TypeParam::bits_per_digit)));
    keys.push_back(key);
    digits.push_back(key.toString());
  }
  std::sort(keys.begin(), keys.end());
  std::sort(digits.begin(), digits.end());
  for (std::size_t i = 0; i < keys.size(); ++i)
    EXPECT_EQ(keys[i].toString(), digits[i]);
}

TEST(MortonKey, WordsHoldWholeDigits)
{
  EXPECT_EQ(MortonKey::max_depth, 21);
  EXPECT_EQ(WideMortonKey::digits_per_word, 21);
  auto key = WideMortonKey::fromDigits(std::string(21, '7'));
  EXPECT_EQ(key.word(0), 0x7fffffffffffffffULL); // one unused bit
  EXPECT_EQ(key.word(1), 0u);
  key = key.child(5);
  EXPECT_EQ(key.word(0), 0x7fffffffffffffffULL);
  EXPECT_EQ(key.word(1), std::uint64_t{5} << 60);
}
