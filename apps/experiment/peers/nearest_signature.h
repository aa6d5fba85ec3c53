/** \file
 * 1-NN among signatures by FLANN. */
#pragma once

#include "experiment/peers/descriptors.h"

#include <memory>

namespace pcl_surflet {
namespace apps {

enum class Metric { L1, L2, ChiSquared };

const std::vector<Metric>& allMetrics();
const char* metricName(Metric metric);

/** \brief Which object owns the signature nearest to a query? Exact (FLANN's linear index: a
 * hundred signatures of hundreds of bins are searched faster so than by a tree). */
class NearestSignature {
public:
  /** \param signatures of objects[i] are signatures[i]; all of one length, at least one in all */
  NearestSignature(const std::vector<Signatures>& signatures,
                   const std::vector<std::size_t>& objects, Metric metric);
  NearestSignature(NearestSignature&&) noexcept;
  ~NearestSignature();

  /** \brief Owner of the nearest neighbour of any of the query's signatures (at least one). */
  std::size_t object(const Signatures& query) const;

  /** \brief What FLANN's index of each metric answers to. */
  struct Search;

private:
  std::unique_ptr<Search> search_;
  std::vector<std::size_t> owners_;
};

} // namespace apps
} // namespace pcl_surflet
