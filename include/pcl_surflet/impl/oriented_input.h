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

/** \brief What can be wrong with points, normals and indices. */
enum class InputProblem { None, NoNormals, OtherSurface, NumberOfNormals, IndexOutside };

/** \brief The problem in words, with its remedy. */
inline const char*
textOf(InputProblem problem)
{
  switch (problem) {
  case InputProblem::NoNormals:
    return "No normals: call setInputNormals() with one normal per input point.";
  case InputProblem::OtherSurface:
    return "A search surface other than the input is not supported: set it as the input.";
  case InputProblem::NumberOfNormals:
    return "The normals are not as many as the input points.";
  case InputProblem::IndexOutside:
    return "An index is outside the input cloud.";
  case InputProblem::None:
    break;
  }
  return "";
}

/** \brief Looks for what VFHEstimation and its like do not check and crash of. A search surface
 * other than the input has no meaning for pairs: its points would have normals but no indices. */
template <typename PointInT, typename PointNT>
InputProblem
findInputProblem(const typename pcl::PointCloud<PointInT>::ConstPtr& input,
                 const typename pcl::PointCloud<PointInT>::ConstPtr& surface,
                 const typename pcl::PointCloud<PointNT>::ConstPtr& normals,
                 const pcl::Indices& indices)
{
  if (!normals)
    return InputProblem::NoNormals;
  if (surface && surface != input)
    return InputProblem::OtherSurface;
  if (normals->size() != input->size())
    return InputProblem::NumberOfNormals;
  for (const auto i : indices)
    if (i < 0 || static_cast<std::size_t>(i) >= input->size())
      return InputProblem::IndexOutside;
  return InputProblem::None;
}

/** \brief Converts the indexed points, or prints in the name of \p who why it cannot. */
template <typename PointInT, typename PointNT>
bool
convertInput(const std::string& who, const typename pcl::PointCloud<PointInT>::ConstPtr& input,
             const typename pcl::PointCloud<PointInT>::ConstPtr& surface,
             const typename pcl::PointCloud<PointNT>::ConstPtr& given_normals,
             const pcl::Indices& indices, ConvertedSurflets& out)
{
  const auto normals = normalsOrInput<PointInT, PointNT>(input, given_normals);
  const auto problem = findInputProblem<PointInT, PointNT>(input, surface, normals, indices);
  if (problem != InputProblem::None) {
    PCL_ERROR("[pcl_surflet::%s::compute] %s\n", who.c_str(), textOf(problem));
    return false;
  }
  out = toSurflets(*input, *normals, indices);
  return true;
}

} // namespace detail
} // namespace pcl_surflet
