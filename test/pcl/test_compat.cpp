/** \file
 * Both interfaces of pcl::search::Search that OctreeRegionSearch can meet: setInputCloud() returns
 * nothing up to PCL 1.13 and bool from 1.14 on. */
#include "pcl_surflet/octree_region_search.h"

#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <memory>
#include <type_traits>

namespace {

using pcl_surflet::compat::SetInputCloudResult;

/** \brief What of a pcl::search::Search matters here. */
template <typename Result>
struct SearchReturning {
  using PointCloudConstPtr = std::shared_ptr<const int>;
  using IndicesConstPtr = std::shared_ptr<const int>;

  virtual ~SearchReturning() = default;
  virtual Result setInputCloud(const PointCloudConstPtr& cloud,
                               const IndicesConstPtr& indices = IndicesConstPtr()) = 0;
};

/** \brief Overrides it as OctreeRegionSearch does. */
template <typename Base>
struct Override : Base {
  SetInputCloudResult<Base>
  setInputCloud(const typename Base::PointCloudConstPtr& cloud,
                const typename Base::IndicesConstPtr&) override
  {
    return static_cast<SetInputCloudResult<Base>>(cloud != nullptr);
  }
};

TEST(Compat, TakesTheReturnTypeOfTheBase)
{
  static_assert(std::is_void<SetInputCloudResult<SearchReturning<void>>>::value, "PCL 1.12, 1.13");
  static_assert(std::is_same<SetInputCloudResult<SearchReturning<bool>>, bool>::value,
                "PCL 1.14, 1.15");
  Override<SearchReturning<void>> older;
  older.setInputCloud(nullptr, nullptr);
  Override<SearchReturning<bool>> newer;
  EXPECT_FALSE(newer.setInputCloud(nullptr, nullptr));
  EXPECT_TRUE(newer.setInputCloud(std::make_shared<int>(1), nullptr));
}

TEST(Compat, IsThatOfThisPcl)
{
  using Search = pcl::search::Search<pcl::PointXYZ>;
  constexpr bool returns_bool = std::is_same<SetInputCloudResult<Search>, bool>::value;
  EXPECT_EQ(returns_bool, bool(PCL_VERSION_COMPARE(>=, 1, 14, 0)));
}

} // namespace
