/** \file
 * SceneInterpreter: segments and names the objects of a scene in one filter. */
#pragma once

#include "pcl_surflet/conversions.h"
#include "pcl_surflet/recognition/scene_interpretation.h"

#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {

enum class Method {
  Explanation, ///< interpretByExplanation(), the default
  Dissertation ///< interpretByDissertation(), the seven steps as written
};

/** \brief An object found in a cloud. */
struct SceneDetection : Detection {
  pcl::Indices indices; ///< its points in the input cloud, ascending
};

namespace detail {

/** \brief What the interpreter wants, free of point types. */
struct InterpreterRequest {
  Method method = Method::Explanation;
  ExplanationParameters parameters;
  double leaf = 0;
  std::size_t max_detections = 0;
};

/** \brief Reduces, interprets and finds the points of every detection.
 * \throws DatabaseError, std::invalid_argument */
PCL_SURFLET_API std::vector<SceneDetection> interpretPoints(const ConvertedSurflets& points,
                                                            const ModelDatabase& database,
                                                            const InterpreterRequest& request,
                                                            InterpretationDiagnostics& diagnostics);

} // namespace detail

/** \brief Finds and names the known objects of a scene [Wahl 2007, Ch. 5].
 *
 * \code
 * pcl_surflet::SceneInterpreter<pcl::PointNormal> interpreter;
 * interpreter.setInputCloud (cloud);
 * interpreter.setDatabase (pcl_surflet::loadDatabase ("objects.pcd"));
 * for (const auto& object : interpreter.interpret ())
 *   std::cout << object.label << " " << object.indices.size () << " points\n";
 * \endcode
 *
 * As a filter it keeps the points that belong to an object, or with setNegative() the others.
 * Points that are not finite or have no usable normal belong to neither: they are always removed.
 * The database should have seven intervals in every dimension and the unit of the cloud.
 *
 * Misuse (no normals, no object in the database) is reported with PCL_ERROR and gives no detection.
 * One seed gives one result for any number of threads. */
template <typename PointT, typename PointNT = PointT>
class SceneInterpreter : public pcl::FilterIndices<PointT> {
public:
  using Ptr = pcl::shared_ptr<SceneInterpreter<PointT, PointNT>>;
  using ConstPtr = pcl::shared_ptr<const SceneInterpreter<PointT, PointNT>>;
  using Normals = pcl::PointCloud<PointNT>;

  explicit SceneInterpreter(bool extract_removed_indices = false)
      : pcl::FilterIndices<PointT>(extract_removed_indices)
  {
    this->filter_name_ = "SceneInterpreter";
  }

  /** \brief One normal per input point, pointing outwards; not needed if the points carry them. */
  void
  setInputNormals(const typename Normals::ConstPtr& normals)
  {
    normals_ = normals;
  }
  void
  setDatabase(const ModelDatabase& database)
  {
    database_ = database;
  }
  void
  setMethod(Method method)
  {
    request_.method = method;
  }
  /** \brief Default Ignore. Exclude is for clouds without background (setIndices() selects). */
  void
  setBackgroundTreatment(BackgroundTreatment treatment)
  {
    request_.parameters.steps.background = treatment;
  }
  /** \brief Edge of the cells in the cloud's unit; 0 (default): a fiftieth of the largest model. */
  void
  setLeafSize(double leaf)
  {
    request_.leaf = leaf;
  }
  /** \brief All other constants; replaces background, seed and threads too. Method::Dissertation
   * takes its steps. */
  void
  setParameters(const ExplanationParameters& parameters)
  {
    request_.parameters = parameters;
  }
  const ExplanationParameters&
  getParameters() const
  {
    return request_.parameters;
  }
  void
  setSeed(std::uint64_t seed)
  {
    request_.parameters.steps.seed = seed;
  }
  /** \brief Threads, 0 (default): all. */
  void
  setNumberOfThreads(unsigned threads = 0)
  {
    request_.parameters.steps.threads = threads;
  }
  /** \brief Keeps this many detections, those of the most cells; 0 (default): all. */
  void
  setMaximumDetections(std::size_t detections)
  {
    request_.max_detections = detections;
  }

  /** \brief Finds the objects. \return them, or nothing after an error */
  std::vector<SceneDetection> interpret();

  /** \brief What the last interpretation did. */
  const InterpretationDiagnostics&
  getDiagnostics() const
  {
    return diagnostics_;
  }

  /** \brief Interprets, and labels every point: 0 for none, else index in the database + 1. */
  void getLabeledCloud(pcl::PointCloud<pcl::PointXYZL>& output);

protected:
  void applyFilter(pcl::Indices& indices) override;

private:
  /** \brief Interprets within initCompute(). \return false after an error; \p points are those that
   * could be used */
  bool interpretInput(ConvertedSurflets& points, std::vector<SceneDetection>& detections);

  typename Normals::ConstPtr normals_;
  ModelDatabase database_;
  detail::InterpreterRequest request_;
  InterpretationDiagnostics diagnostics_;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/scene_interpreter.hpp"
#endif
