/** \file
 * Training of models from surflets and from meshes. */
#pragma once

#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/surflet_set.h"
#include "pcl_surflet/core/triangle_mesh.h"
#include "pcl_surflet/recognition/histogram_model.h"

#include <functional>
#include <stdexcept>

namespace pcl_surflet {

/** \brief Thrown when data cannot train a model; what() says why and how to mend it. */
class PCL_SURFLET_API TrainingError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
  ~TrainingError() override;
};

/** \brief What to do with a cloud of uneven density, in which dense areas would dominate. */
enum class UnevenDensity {
  EvenOut, ///< reduce to one mean surflet per cell, cells as wide as the sparse areas need
  Refuse,  ///< throw TrainingError
  Accept   ///< train as it is
};

/** \brief Trains HistogramModel from oriented clouds (training B, [Wahl 2007, Sec. 2.3.2]) and from
 * meshes (training A, [Wahl 2007, Sec. 2.3.1]).
 *
 * \code
 * HistogramModelTrainer trainer;
 * trainer.setResolution({7, 7, 7, 7});
 * HistogramModel bunny = trainer.train("bunny", surflets);
 * \endcode
 * The same seed gives the same model, whatever the number of threads. Const methods may be called
 * from several threads. */
class PCL_SURFLET_API HistogramModelTrainer {
public:
  /** \brief Bins per dimension, default 5,5,5,5.
   * \throws std::invalid_argument for an unusable resolution */
  void setResolution(const Resolution& resolution);
  /** \brief Bins per dimension. */
  const Resolution&
  getResolution() const
  {
    return resolution_;
  }

  /** \brief Number of pairs drawn from a cloud, k, default 10,000,000. A cloud that has no more
   * pairs than that is trained with all of them. \throws std::invalid_argument if 0 */
  void setNumberOfPairs(std::uint64_t pairs);
  /** \brief Number of pairs drawn from a cloud. */
  std::uint64_t
  getNumberOfPairs() const
  {
    return pairs_;
  }
  /** \brief Random seed, default 1. */
  void
  setSeed(std::uint64_t seed)
  {
    seed_ = seed;
  }
  /** \brief The random seed. */
  std::uint64_t
  getSeed() const
  {
    return seed_;
  }
  /** \brief Threads, 0 (default): all. */
  void
  setNumberOfThreads(unsigned threads)
  {
    threads_ = threads;
  }
  /** \brief Threads, 0: all. */
  unsigned
  getNumberOfThreads() const
  {
    return threads_;
  }
  /** \brief Default EvenOut. */
  void
  setUnevenDensity(UnevenDensity treatment)
  {
    uneven_ = treatment;
  }
  /** \brief What is done about uneven density. */
  UnevenDensity
  getUnevenDensity() const
  {
    return uneven_;
  }
  /** \brief Role of the trained models, default Object. */
  void
  setRole(ModelRole role)
  {
    role_ = role;
  }
  /** \brief Role of the trained models. */
  ModelRole
  getRole() const
  {
    return role_;
  }
  /** \brief Surflets per sampling of a mesh, default 4500 (the dissertation: 3,500-5,500), and
   * number of samplings, default 5. \throws std::invalid_argument if below 2 or 1 */
  void setMeshSampling(std::size_t surflets, unsigned samplings);
  /** \brief Surflets per sampling of a mesh. */
  std::size_t
  getMeshSurflets() const
  {
    return mesh_surflets_;
  }

  /** \brief Lets several processes train one model together, all of them on the same data: each
   * counts its \p share of the pairs, and \p sum returns what all of them counted, merged. Then all
   * have the model that one process would have trained. Called once in every train(), from the
   * calling thread; what it throws comes through. Default: one process, no \p sum.
   * \throws std::invalid_argument if \p share is none of its parts */
  void setPairShare(const PairShare& share, std::function<PairHistogram(const PairHistogram&)> sum);

  /** \brief Trains from an oriented cloud: k drawn pairs, or all if there are no more.
   *
   * \param label 1 to 63 bytes
   * \param surflets at least three that do not all coincide, finite, with outward normals of unit
   * length (toSurflets(), SurfletSet::appendChecked()); density see setUnevenDensity()
   * \throws TrainingError if no model can be made of them */
  HistogramModel train(const std::string& label, const SurfletSet& surflets) const;

  /** \brief Trains from a mesh: several independent iso-samplings (sampleIsoMesh()), all pairs of
   * each, histograms added bin by bin, then normalised. \throws TrainingError with
   * TriangleMesh::problem() */
  HistogramModel train(const std::string& label, const TriangleMesh& mesh) const;

  /** \brief The surflets that train() uses of a cloud: evened out if need be. \throws TrainingError
   * as setUnevenDensity() says, naming \p label */
  SurfletSet evened(const std::string& label, const SurfletSet& surflets) const;

private:
  PairHistogram summed(const PairHistogram& own) const;
  HistogramModel finish(const std::string& label, const PairHistogram& histogram,
                        const SurfletSet& surflets, double delta_max, double area) const;

  Resolution resolution_;
  std::uint64_t pairs_ = 10000000;
  std::uint64_t seed_ = 1;
  unsigned threads_ = 0;
  UnevenDensity uneven_ = UnevenDensity::EvenOut;
  ModelRole role_ = ModelRole::Object;
  std::size_t mesh_surflets_ = 4500;
  unsigned mesh_samplings_ = 5;
  PairShare share_;
  std::function<PairHistogram(const PairHistogram&)> sum_;
};

} // namespace pcl_surflet
