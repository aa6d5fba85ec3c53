/** \file
 * SceneInterpreter: segments and names the objects of a scene in one filter. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/conversions.h"
#include "pcl_surflet/recognition/scene_accumulation.h"

#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief How scenes are interpreted. */
enum class Method {
  Explanation, ///< interpretByExplanation(), the default
  Dissertation ///< interpretByDissertation(), the seven steps as written
};

/** \brief An object found in a cloud. Its \ref cells are indices of SceneInterpreter::getCells().
 */
struct SceneDetection : Detection {
  /** \brief Its points in the input cloud, ascending: those of its cells, and those of thin walls,
   * whose cells have no normal, beside them. */
  pcl::Indices indices;
  /** \brief How often such a detection is right among unknown objects, in [0, 1]; see
   * detail::confidenceOf(). */
  double confidence = 0;
  /** \brief Its cells, relative to those that what its model's member shows (Detection::member) is
   * expected to occupy: the whole surface, or one view of it; see detail::coverageOf(). Below 1 a
   * part is hidden or was not found. NaN if the member's area is unknown: it was trained from
   * points. Where the pose and the viewpoints are known, PoseEstimate::coverage knows better. */
  double coverage = std::numeric_limits<double>::quiet_NaN();
};

/** \brief How an interpretation ended. */
enum class SceneStatus {
  NotYet,       ///< there was none
  Found,        ///< there are detections
  NothingFound, ///< no object; SceneDiagnostics::reason says why
  Cancelled,    ///< the progress callback returned false
  // Misuse:
  NoInput,       ///< no input cloud
  NoNormals,     ///< neither the points nor setInputNormals() have normals, or the background lacks
  WrongInput,    ///< normals are not as many as points, or an index is outside the cloud
  WrongDatabase, ///< no object, or no background model where it is to be modelled
  WrongParameter, ///< a parameter is out of range
};

/** \brief What the last interpretation did, step by step, and why it ended. */
struct SceneDiagnostics : InterpretationDiagnostics {
  SceneStatus status = SceneStatus::NotYet; ///< how it ended
  std::string reason;                       ///< status in words; empty if objects were found
  std::size_t points = 0;                   ///< input points that can be used
  std::size_t rejected = 0;                 ///< not finite or without usable normal
  std::size_t background_points = 0;        ///< left out by BackgroundTreatment::Exclude
  std::size_t planes = 0;                   ///< of them: planes found
  std::size_t cells = 0;                    ///< what was interpreted
  std::size_t runs = 0;     ///< interpretations that were merged; the counts are the first's
  double leaf = 0;          ///< edge of a cell, in the cloud's unit
  double extent = 0;        ///< diagonal of the cells' bounding box
  double largest_model = 0; ///< delta_max of the largest object of the database
};

/** \brief What BackgroundTreatment::Exclude takes for background: points near it whose normals
 * agree with it. The underside of an object on a table faces the other way, and stays. */
struct ExclusionOptions {
  double distance = 0;       ///< from the background, in the cloud's unit; 0: one leaf
  double max_angle = 1.0472; ///< between the normals in radians, in (0, pi]; pi ignores normals
};

/** \brief A plane to be found by pcl::SACSegmentation and excluded. */
struct BackgroundPlane {
  /** \brief Direction of its normal (either sign, any length); all zero: any. */
  std::array<double, 3> normal{};
  double max_tilt = 0.26;        ///< from that direction, radians, in (0, pi / 2]
  double min_share = 0.1;        ///< of the cells left; a plane of fewer is not removed, in (0, 1]
  unsigned max_iterations = 500; ///< of RANSAC, in [1, 2^31)
};

namespace detail {

/** \brief What the interpreter wants, free of point types. */
struct InterpreterRequest {
  Method method = Method::Explanation;
  ExplanationParameters parameters;
  double leaf = 0;
  std::size_t max_detections = 0;
  AccumulationParameters accumulation;
  double seconds = 0; ///< time budget, 0: none
  ExclusionOptions exclusion;
  std::vector<BackgroundPlane> planes;
};

/** \brief The edge of the cells that all objects were trained for (HistogramModel::leaf); 0 if they
 * differ or one was not trained for cells. */
PCL_SURFLET_API double trainedLeafOf(const ModelDatabase& database);

/** \brief Edge of the cells: \p leaf, or if 0 trainedLeafOf(), or if that is 0 a fiftieth of the
 * largest object. \throws
 * DatabaseError if there is no object \throws std::invalid_argument if it is not positive and
 * finite */
PCL_SURFLET_API double leafOf(double leaf, const ModelDatabase& database);

/** \brief Reduces, interprets and finds the points of every detection. Sets what it does in
 * \p diagnostics. \param cells the reduced scene \throws DatabaseError, std::invalid_argument */
PCL_SURFLET_API std::vector<SceneDetection> interpretPoints(const ConvertedSurflets& points,
                                                            const ModelDatabase& database,
                                                            const InterpreterRequest& request,
                                                            SceneDiagnostics& diagnostics,
                                                            SurfletSet& cells);

/** \brief Removes the points of the planes, one after the other. \return how many were found
 * \throws std::invalid_argument if an option is out of range */
PCL_SURFLET_API std::size_t removePlanes(const std::vector<BackgroundPlane>& planes,
                                         const ExclusionOptions& options,
                                         ConvertedSurflets& points);

/** \brief Removes the points that \p is_background calls so. */
PCL_SURFLET_API void removePoints(const std::function<bool(const Surflet&)>& is_background,
                                  ConvertedSurflets& points);

/** \brief The background as cells of half the distance: even, and dense enough for it.
 * \throws std::invalid_argument if an option is out of range */
PCL_SURFLET_API SurfletSet backgroundCells(const SurfletSet& background,
                                           const ExclusionOptions& options);

/** \brief How sure a detection is, in [0, 1].
 *
 * Method::Explanation: the share of detections of such fit and margin that are right where unknown
 * objects are as frequent as known ones, 1 / (1 + exp(18.4 - 19.7 fit - 12.5 margin)); without any
 * other model, 1 / (1 + exp(26.3 - 31 fit)). Fitted to 120 generated scenes of four known and five
 * unknown things each, two databases, apart and piled up, complete and seen by a sensor from one
 * side or two, with min_fit 0.5 so that the unknown got names: 860 detections, 447 right. On 120
 * others with other seeds, 861 detections: right were 222 of 222 above 0.95, 127 of 142 from 0.8
 * on (mean 0.90), 48 of 82 from 0.5 on (mean 0.67), 29 of 61 from 0.2 on (mean 0.35) and 19 of 354
 * below (mean 0.05). With fewer unknown things than that it is too cautious.
 *
 * Method::Dissertation, which has no fit: 1 / (1 + exp(-10 score)), the posterior against the best
 * rival were ten features independent, times n / (n + min_cluster) for n cells. Not calibrated.
 *
 * Of an accumulated detection: the same of its mean fit and margin, times the share of the runs
 * that found it. */
PCL_SURFLET_API double confidenceOf(const Detection& detection, std::size_t min_cluster);

/** \throws std::invalid_argument if an index is not below \p size */
PCL_SURFLET_API void checkWithin(const pcl::Indices& indices, std::size_t size);

/** \brief \p cells relative to those that a surface of \p area occupies, 1.27 area / leaf^2 on
 * average: the definition by which trainForScenes() sets HistogramModel::surface_area. Of models
 * trained otherwise the area is that of the mesh, and thin walls share cells: vessels reach less
 * than 1. Above 1 the detection holds more than the object. NaN if the area is not positive. */
PCL_SURFLET_API double coverageOf(std::size_t cells, double area, double leaf);

} // namespace detail

/** \brief Finds and names the known objects of a scene [Wahl 2007, Ch. 5].
 *
 * \code
 * pcl_surflet::SceneInterpreter<pcl::PointNormal> interpreter;
 * interpreter.setInputCloud (cloud);
 * interpreter.setDatabase (pcl_surflet::loadDatabase ("objects.pcd"));
 * interpreter.setBackgroundPlanes ({pcl_surflet::BackgroundPlane ()}); // they stand on a table
 * for (const auto& object : interpreter.interpret ())
 *   std::cout << object.label << " " << object.indices.size () << " points\n";
 * \endcode
 *
 * As a filter it keeps the points that belong to an object, or with setNegative() the others, the
 * background among them. Points that are not finite or have no usable normal belong to neither:
 * they are always removed. The database should have seven intervals in every dimension and the
 * unit of the cloud. Normals are not estimated here: which way is out only the user knows.
 *
 * Misuse (no normals, no object in the database) is reported with PCL_ERROR, gives no detection,
 * and can be read from getDiagnostics(). One seed gives one result for any number of threads. */
template <typename PointT, typename PointNT = PointT>
class SceneInterpreter : public pcl::FilterIndices<PointT> {
public:
  ///@{
  /** \brief As PCL's classes have it. */
  using Ptr = pcl::shared_ptr<SceneInterpreter<PointT, PointNT>>;
  using ConstPtr = pcl::shared_ptr<const SceneInterpreter<PointT, PointNT>>;
  using Normals = pcl::PointCloud<PointNT>;
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;
  ///@}

  /** \brief \param extract_removed_indices whether getRemovedIndices() lists what filter() takes
   * out */
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
  /** \brief What is known: objects and, for BackgroundTreatment::Model, background models. Copied.
   */
  void
  setDatabase(const ModelDatabase& database)
  {
    database_ = database;
  }
  /** \brief What is known. */
  const ModelDatabase&
  getDatabase() const
  {
    return database_;
  }
  /** \brief Default Explanation. */
  void
  setMethod(Method method)
  {
    request_.method = method;
  }
  /** \brief The method in use. */
  Method
  getMethod() const
  {
    return request_.method;
  }

  /** \name Background
   * Default Ignore. Exclude looks at what is left of the input without the background cloud and the
   * planes; without either the user has removed the background, say with setIndices(). */
  ///@{
  /** \brief Default Ignore. */
  void
  setBackgroundTreatment(BackgroundTreatment treatment)
  {
    request_.parameters.steps.background = treatment;
  }
  /** \brief The treatment in use. */
  BackgroundTreatment
  getBackgroundTreatment() const
  {
    return request_.parameters.steps.background;
  }
  /** \brief The scene sensed before there were objects in it; turns to Exclude. Null forgets it.
   * \param cloud in the frame and unit of the input
   * \param normals as in setInputNormals() */
  void
  setBackgroundCloud(const typename pcl::PointCloud<PointT>::ConstPtr& cloud,
                     const typename Normals::ConstPtr& normals = nullptr)
  {
    background_ = cloud;
    background_normals_ = normals;
    setBackgroundTreatment(BackgroundTreatment::Exclude);
  }
  /** \brief Planes to be found, one after the other; turns to Exclude. One for a table, two for the
   * corner of a shelf. A plane has no end: what lies in it elsewhere goes as well. */
  void
  setBackgroundPlanes(const std::vector<BackgroundPlane>& planes)
  {
    request_.planes = planes;
    setBackgroundTreatment(BackgroundTreatment::Exclude);
  }
  /** \brief Planes to be found. */
  const std::vector<BackgroundPlane>&
  getBackgroundPlanes() const
  {
    return request_.planes;
  }
  /** \brief What of the input counts as near the background. */
  void
  setExclusionOptions(const ExclusionOptions& options)
  {
    request_.exclusion = options;
  }
  /** \brief What counts as near the background. */
  const ExclusionOptions&
  getExclusionOptions() const
  {
    return request_.exclusion;
  }
  /** \brief Searches the background cloud, whose neighbours are what is excluded: nothing else
   * here needs neighbours in a cloud. Default: OctreeRegionSearch. Its input cloud is replaced. */
  void
  setSearchMethod(const SearchPtr& search)
  {
    search_ = search;
  }
  /** \brief Null before the first use of the default. */
  SearchPtr
  getSearchMethod() const
  {
    return search_;
  }
  ///@}

  /** \brief Edge of the cells in the cloud's unit; 0 (default): that which all models were trained
   * for, or if there is none a fiftieth of the largest model. */
  void
  setLeafSize(double leaf)
  {
    request_.leaf = leaf;
  }
  /** \brief As set, 0: the default; the edge in use is SceneDiagnostics::leaf. */
  double
  getLeafSize() const
  {
    return request_.leaf;
  }
  /** \brief All other constants; replaces background, seed, threads and progress too, but its leaf
   * is that of setLeafSize().
   * Method::Dissertation takes its steps. */
  void
  setParameters(const ExplanationParameters& parameters)
  {
    request_.parameters = parameters;
  }
  /** \brief All constants as they are now. */
  const ExplanationParameters&
  getParameters() const
  {
    return request_.parameters;
  }
  /** \brief Random seed, default 1. */
  void
  setSeed(std::uint64_t seed)
  {
    request_.parameters.steps.seed = seed;
  }
  /** \brief Random seed. */
  std::uint64_t
  getSeed() const
  {
    return request_.parameters.steps.seed;
  }
  /** \brief Threads, 0 (default): all. */
  void
  setNumberOfThreads(unsigned threads = 0)
  {
    request_.parameters.steps.threads = threads;
  }
  /** \brief Threads, 0: all. */
  unsigned
  getNumberOfThreads() const
  {
    return request_.parameters.steps.threads;
  }
  /** \brief Keeps this many detections, those of the most cells; 0 (default): all. */
  void
  setMaximumDetections(std::size_t detections)
  {
    request_.max_detections = detections;
  }
  /** \brief Most detections, 0: all. */
  std::size_t
  getMaximumDetections() const
  {
    return request_.max_detections;
  }
  /** \brief Interprets several times and votes [Wahl 2007, Sec. 6.2]. By default once.
   *
   * \param parameters runs is the most; the same parameters and seed give the same result
   * \param seconds time budget, 0: none. No further run begins that would, taking as long as those
   * before, end later; the first always runs. How many there were is in getDiagnostics(). */
  void
  setAccumulation(const AccumulationParameters& parameters, double seconds = 0)
  {
    request_.accumulation = parameters;
    request_.seconds = seconds;
  }
  /** \brief How often it interprets, and how votes count. */
  const AccumulationParameters&
  getAccumulation() const
  {
    return request_.accumulation;
  }
  /** \brief Told the share done, in [0, 1]; returns false to cancel. See
   * DissertationParameters::progress. */
  void
  setProgressCallback(const std::function<bool(double)>& progress)
  {
    request_.parameters.steps.progress = progress;
  }

  /** \brief Finds the objects. \return them, or nothing after an error or when cancelled */
  std::vector<SceneDetection> interpret();

  /** \brief What the last interpretation did. */
  const SceneDiagnostics&
  getDiagnostics() const
  {
    return diagnostics_;
  }
  /** \brief The mean surflets that the last interpretation looked at. */
  const SurfletSet&
  getCells() const
  {
    return cells_;
  }

  /** \brief Interprets, and labels every point: 0 for none, else index in the database + 1.
   *
   * The output has the size and order of the input cloud. PointXYZLNormal takes the normals of the
   * input (NaN where interpret() had none to work with). */
  void getLabeledCloud(pcl::PointCloud<pcl::PointXYZL>& output);
  void getLabeledCloud(pcl::PointCloud<pcl::PointXYZLNormal>& output); ///< the same with normals

  /** \brief The same for detections that one has already.
   * \throws std::invalid_argument if they are of another cloud: an index is outside the input's */
  template <typename PointOutT>
  void labelCloud(const std::vector<SceneDetection>& detections,
                  pcl::PointCloud<PointOutT>& output) const;

protected:
  /** \brief interpret(), then the indices of the objects' points. */
  void applyFilter(pcl::Indices& indices) override;

private:
  /** \brief Interprets within initCompute(). \return false after an error; \p points are those that
   * could be used */
  bool interpretInput(ConvertedSurflets& points, std::vector<SceneDetection>& detections);
  /** \brief Converts the input. \return false after an error */
  bool convertPoints(ConvertedSurflets& points);
  /** \brief BackgroundTreatment::Exclude. */
  ConvertedSurflets withoutBackground(ConvertedSurflets points);
  void removeBackgroundCloud(const ExclusionOptions& options, ConvertedSurflets& points);
  /** \brief Keeps and prints what went wrong. \return false */
  bool fail(SceneStatus status, const std::string& reason);

  typename Normals::ConstPtr normals_;
  typename pcl::PointCloud<PointT>::ConstPtr background_;
  typename Normals::ConstPtr background_normals_;
  SearchPtr search_;
  ModelDatabase database_;
  detail::InterpreterRequest request_;
  SceneDiagnostics diagnostics_;
  SurfletSet cells_;
};

} // namespace pcl_surflet

#ifdef PCL_NO_PRECOMPILE
#include "pcl_surflet/impl/scene_interpreter.hpp"
#endif
