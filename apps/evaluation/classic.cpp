#include "evaluation/classic.h"

#include "surfaces.h"

#include <flann/flann.hpp>
#include <pcl/features/esf.h>
#include <pcl/features/vfh.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

namespace pcl_surflet {
namespace apps {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;
using Metric = flann::ChiSquareDistance<float>;

constexpr std::size_t kFewestPoints = 10; // fewer make no cluster worth a descriptor
constexpr int kRansacIterations = 500;
/** \brief VFH sees every scene from far above: so it does not depend on the place of an object, nor
 * on how it is turned about the vertical. */
constexpr float kViewpointHeight = 1000;

/** \brief Indices of what is left of \p cloud once its largest planes are gone. */
pcl::IndicesPtr
offPlanes(const Cloud::Ptr& cloud, const ClassicParameters& p)
{
  pcl::IndicesPtr left(new pcl::Indices(cloud->size()));
  std::iota(left->begin(), left->end(), 0);
  const double fewest = std::max(3.0, p.min_plane * static_cast<double>(cloud->size()));
  for (unsigned k = 0; k < p.planes && static_cast<double>(left->size()) >= fewest; ++k) {
    pcl::SACSegmentation<pcl::PointNormal> ransac;
    ransac.setModelType(pcl::SACMODEL_PLANE);
    ransac.setMethodType(pcl::SAC_RANSAC);
    ransac.setDistanceThreshold(p.plane_distance * p.leaf);
    ransac.setMaxIterations(kRansacIterations);
    ransac.setOptimizeCoefficients(true);
    ransac.setInputCloud(cloud);
    ransac.setIndices(left);
    pcl::PointIndices plane;
    pcl::ModelCoefficients coefficients;
    ransac.segment(plane, coefficients);
    if (static_cast<double>(plane.indices.size()) < fewest)
      break;
    std::sort(plane.indices.begin(), plane.indices.end());
    pcl::IndicesPtr rest(new pcl::Indices);
    std::set_difference(left->begin(), left->end(), plane.indices.begin(), plane.indices.end(),
                        std::back_inserter(*rest));
    left = rest;
  }
  return left;
}

/** \brief Clusters of at least \p fewest points, the largest first. */
std::vector<pcl::PointIndices>
clustersIn(const Cloud::Ptr& cloud, const ClassicParameters& p, std::size_t fewest)
{
  std::vector<pcl::PointIndices> clusters;
  const auto left = offPlanes(cloud, p);
  if (left->empty())
    return clusters;
  pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>(false));
  tree->setInputCloud(cloud, left);
  pcl::EuclideanClusterExtraction<pcl::PointNormal> extraction;
  extraction.setClusterTolerance(p.tolerance * p.leaf);
  extraction.setMinClusterSize(static_cast<pcl::uindex_t>(fewest));
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  extraction.setIndices(left);
  extraction.extract(clusters);
  return clusters;
}

template <class Signature>
std::vector<float>
numbersOf(const pcl::PointCloud<Signature>& signatures)
{
  const auto& histogram = signatures.at(0).histogram;
  return {std::begin(histogram), std::end(histogram)};
}

std::vector<float>
vfh(const Cloud::Ptr& cloud)
{
  pcl::VFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::VFHSignature308> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setViewPoint(0, 0, kViewpointHeight);
  estimation.setSearchMethod(
      pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>(false)));
  pcl::PointCloud<pcl::VFHSignature308> out;
  estimation.compute(out);
  return numbersOf(out);
}

std::vector<float>
esf(const Cloud::Ptr& cloud)
{
  pcl::ESFEstimation<pcl::PointNormal, pcl::ESFSignature640> estimation;
  std::srand(1); // the estimation has just seeded it with the time
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::ESFSignature640> out;
  estimation.compute(out);
  return numbersOf(out);
}

} // namespace

class TabletopClassic::Impl {
public:
  explicit Impl(const ClassicParameters& parameters) : parameters_(parameters) {}

  bool
  learn(std::size_t object, const SurfletSet& cells)
  {
    const auto cloud = cloudOf(cells);
    const auto clusters = clustersIn(cloud, parameters_, kFewestPoints);
    if (clusters.empty())
      return false;
    const auto& largest = clusters.front().indices;
    smallest_ = std::min(smallest_, largest.size());
    objects_.push_back(object);
    const auto d = described(cloud, largest);
    width_ = d.size();
    examples_.insert(examples_.end(), d.begin(), d.end());
    return true;
  }

  void
  finish()
  {
    if (objects_.empty())
      throw std::invalid_argument("the classic sees no cluster in any scene it should learn from; "
                                  "give larger items or a smaller -leaf");
    index_ = std::make_unique<flann::Index<Metric>>(
        flann::Matrix<float>(examples_.data(), objects_.size(), width_),
        flann::LinearIndexParams());
    index_->buildIndex();
    limits_.assign(*std::max_element(objects_.begin(), objects_.end()) + 1, 0);
    for (std::size_t i = 0; i < objects_.size(); ++i)
      limits_[objects_[i]] =
          std::max(limits_[objects_[i]], parameters_.slack * distanceToOthers(i));
  }

  std::vector<NamedCluster>
  find(const SurfletSet& cells) const
  {
    const auto cloud = cloudOf(cells);
    const auto fewest =
        std::max(kFewestPoints, static_cast<std::size_t>(parameters_.min_cluster *
                                                         static_cast<double>(smallest_)));
    std::vector<NamedCluster> named;
    for (const auto& cluster : clustersIn(cloud, parameters_, fewest)) {
      NamedCluster c = nearest(described(cloud, cluster.indices));
      if (c.distance > limits_[c.object])
        continue;
      c.cells.assign(cluster.indices.begin(), cluster.indices.end());
      std::sort(c.cells.begin(), c.cells.end());
      named.push_back(std::move(c));
    }
    return named;
  }

private:
  std::vector<float>
  described(const Cloud::Ptr& cloud, const pcl::Indices& indices) const
  {
    const Cloud::Ptr cluster(new Cloud(*cloud, indices));
    return parameters_.descriptor == Descriptor::Vfh ? vfh(cluster) : esf(cluster);
  }

  NamedCluster
  nearest(std::vector<float> d) const
  {
    std::size_t at = 0;
    float distance = 0;
    flann::Matrix<std::size_t> indices(&at, 1, 1);
    flann::Matrix<float> distances(&distance, 1, 1);
    index_->knnSearch(flann::Matrix<float>(d.data(), 1, width_), indices, distances, 1,
                      flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    NamedCluster c;
    c.object = objects_[at];
    c.distance = distance;
    return c;
  }

  /** \brief Distance of example \p i to the nearest other one of its object. */
  double
  distanceToOthers(std::size_t i) const
  {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < objects_.size(); ++j)
      if (j != i && objects_[j] == objects_[i])
        best = std::min<double>(best,
                                Metric()(&examples_[i * width_], &examples_[j * width_], width_));
    return best;
  }

  ClassicParameters parameters_;
  std::vector<std::size_t> objects_; ///< of each example
  std::vector<float> examples_;      ///< one after the other
  std::size_t width_ = 0, smallest_ = ~std::size_t{0};
  std::vector<double> limits_; ///< of each object: what is farther is unknown
  std::unique_ptr<flann::Index<Metric>> index_;
};

TabletopClassic::TabletopClassic(const ClassicParameters& parameters)
    : impl_(std::make_unique<Impl>(parameters))
{
}

TabletopClassic::~TabletopClassic() = default;

bool
TabletopClassic::learn(std::size_t object, const SurfletSet& cells)
{
  return impl_->learn(object, cells);
}

void
TabletopClassic::finish()
{
  impl_->finish();
}

std::vector<NamedCluster>
TabletopClassic::find(const SurfletSet& cells) const
{
  return impl_->find(cells);
}

} // namespace apps
} // namespace pcl_surflet
