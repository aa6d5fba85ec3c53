/** \file
 * What the estimators share: checking a pcl::FeatureFromNormals' input and converting it. */
#pragma once

#include "pcl_surflet/conversions.h"

#include <pcl/console/print.h>

#include <string>
#include <type_traits>

namespace pcl_surflet {
namespace detail {

/** \brief The normals to use: those set, or the input itself if its points carry normals. */
template <typename PointInT, typename PointNT>
typename pcl::PointCloud<PointNT>::ConstPtr
normalsOrInput(const typename pcl::PointCloud<PointInT>::ConstPtr& input,
               const typename pcl::PointCloud<PointNT>::ConstPtr& normals)
{
  if constexpr (std::is_same<PointInT, PointNT>::value) {
    if (!normals)
      return input;
  }
  return normals;
}

/** \brief Converts the indexed points, or prints in the name of \p who why it cannot.
 *
 * VFHEstimation and its like skip these checks and crash without normals. A search surface other
 * than the input has no meaning for pairs: its points would have normals but no indices. */
template <typename PointInT, typename PointNT>
bool
convertInput(const std::string& who, const typename pcl::PointCloud<PointInT>::ConstPtr& input,
             const typename pcl::PointCloud<PointInT>::ConstPtr& surface,
             const typename pcl::PointCloud<PointNT>::ConstPtr& given_normals,
             const pcl::Indices& indices, ConvertedSurflets& out)
{
  const auto fail = [&](const char* text) {
    PCL_ERROR("[pcl_surflet::%s::compute] %s\n", who.c_str(), text);
    return false;
  };
  const auto normals = normalsOrInput<PointInT, PointNT>(input, given_normals);
  if (!normals)
    return fail("No normals: call setInputNormals() with one normal per input point.");
  if (surface && surface != input)
    return fail("A search surface other than the input is not supported: set it as the input.");
  if (normals->size() != input->size())
    return fail("The normals are not as many as the input points.");
  for (const auto i : indices)
    if (i < 0 || static_cast<std::size_t>(i) >= input->size())
      return fail("An index is outside the input cloud.");
  out = toSurflets(*input, *normals, indices);
  return true;
}

} // namespace detail
} // namespace pcl_surflet
