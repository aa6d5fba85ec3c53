/** \file
 * Whatever can name the object of a cloud: what the experiments compare. */
#pragma once

#include "experiment/objects.h"
#include "experiment/output.h"
#include "pcl_surflet/core/surflet_set.h"
#include "thread_time.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Whose normals a recogniser gets where a sample's own are undisturbed. Under noise they
 * are estimated for all. */
enum class Normals {
  Sampled,  ///< those of the mesh
  Estimated ///< estimated from the positions, as from a sensor
};

/** \brief The answer to one query. */
struct Answer {
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::size_t object = kNone; ///< index of the object, kNone if there is no answer
  bool failed = false;        ///< the recogniser crashed, took too long or had nothing to say
  double seconds = 0;         ///< CPU time of this query
};

/** \brief A trained recogniser. classify() may be called from several threads. */
class Recogniser {
public:
  explicit Recogniser(std::string name, Normals normals = Normals::Sampled)
      : name_(std::move(name)), normals_(normals)
  {
  }
  virtual ~Recogniser() = default;

  const std::string&
  name() const
  {
    return name_;
  }
  Normals
  normals() const
  {
    return normals_;
  }
  /** \brief Names the object of \p query (lengths in diameters). */
  virtual Answer classify(const SurfletSet& query) const = 0;

private:
  std::string name_;
  Normals normals_;
};

using Recognisers = std::vector<std::unique_ptr<Recogniser>>;

/** \brief What recognisers are trained with: the objects and seeds that no test uses. */
struct Training {
  const std::vector<ExperimentObject>& objects;
  std::uint64_t seed;
  unsigned threads; ///< 0: all
  ProgressFunction progress;
};

} // namespace apps
} // namespace pcl_surflet
