/** \file
 * Counting the features of all pairs, or of randomly drawn pairs, of a surflet set. */
#pragma once

#include "pcl_surflet/core/pair_histogram.h"
#include "pcl_surflet/core/surflet_set.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace pcl_surflet {

/** \brief A surflet set made ready for the pair kernels; immutable, may be shared by threads.
 *
 * Centred and scaled by a power of two (toUnitScale), once as columns for streaming and once as
 * records for random access. Pairs so close that their squared distance vanishes
 * in single precision (about 1e-22 of its extent) count as coincident.
 * Fewer than 2^29 surflets (std::length_error). */
class PCL_SURFLET_API PairSource {
public:
  /** \brief Copies \p set, whose surflets must be finite with normals of unit length
   * (SurfletSet::appendChecked()). \throws std::length_error for 2^29 surflets or more */
  explicit PairSource(const SurfletSet& set);
  PairSource(PairSource&&) = default;            ///< leaves the other only to be destroyed
  PairSource& operator=(PairSource&&) = default; ///< leaves the other only to be destroyed

  /** \brief Number of surflets. */
  std::size_t
  size() const
  {
    return unit_.set.size();
  }
  /** \brief Length in unit scale per length of the original set. */
  double
  scale() const
  {
    return unit_.scale;
  }
  /** \brief The surflets, centred and scaled. */
  const SurfletSet&
  columns() const
  {
    return unit_.set;
  }
  /** \brief size() records of 8 floats (x y z nx ny nz 0 0), 32-byte aligned. */
  const float*
  records() const
  {
    return records_;
  }

private:
  UnitSurflets unit_;
  std::unique_ptr<float[]> storage_;
  const float* records_ = nullptr;
};

/** \brief One of several shares of the pairs that a call would count, for counting in several
 * processes: the histograms of shares 0 to parts - 1, merged, are the histogram of the whole. */
struct PairShare {
  std::size_t part = 0;  ///< which share
  std::size_t parts = 1; ///< of how many
};

/** \brief Features of all m(m-1)/2 pairs [Wahl 2007, Eq. 2.19]; each unordered pair once.
 *
 * \param source the surflets
 * \param resolution intervals in every dimension
 * \param delta_max in the unit of the set, > 0; longer pairs go to the last delta interval
 * \param threads 0: all; the result is the same for any number
 * \param share what is counted of them, default all
 * \throws std::invalid_argument for an unusable resolution, delta_max or share */
PCL_SURFLET_API PairHistogram countAllPairs(const PairSource& source, const Resolution& resolution,
                                            double delta_max, unsigned threads = 0,
                                            const PairShare& share = {});

/** \brief Features of \p n pairs drawn uniformly, with replacement, from the pairs of different
 * surflets [Wahl 2007, Sec. 2.3.2]. Pairs without feature count as drawn.
 *
 * Pair number i depends on \p seed and i alone. Fewer than two surflets give an empty histogram.
 * Parameters and errors as in countAllPairs(). */
PCL_SURFLET_API PairHistogram countDrawnPairs(const PairSource& source,
                                              const Resolution& resolution, double delta_max,
                                              std::uint64_t n, std::uint64_t seed,
                                              unsigned threads = 0, const PairShare& share = {});

/** \brief Features of \p n pairs (i, i + s mod m) of the shuffled set, for shifts s drawn at
 * random.
 *
 * About twice as fast as countDrawnPairs() because memory is read in order. Every surflet takes
 * part equally often (up to one), so the counts scatter less than those of independent pairs; but
 * pairs repeat as soon as a shift is drawn twice, so use it for n well below m^2 / 2. Parameters
 * and errors as in countAllPairs(). */
PCL_SURFLET_API PairHistogram countStreamedPairs(const PairSource& source,
                                                 const Resolution& resolution, double delta_max,
                                                 std::uint64_t n, std::uint64_t seed,
                                                 unsigned threads = 0);

/** \brief Drawn features as far as models of one angular resolution need them: each model maps
 * delta with its own delta_max [Wahl 2007, Eq. 3.4]. */
struct PCL_SURFLET_API FeatureSample {
  Resolution resolution;                  ///< of \ref angular_bin and of bins()
  std::vector<std::uint32_t> angular_bin; ///< bin of (alpha, beta, gamma), < angularBins()
  std::vector<float> delta_squared;       ///< squared distance, times scale^2
  double scale = 1;                       ///< PairSource::scale()
  std::uint64_t rejected = 0;             ///< pairs drawn without feature

  /** \brief Number of features. */
  std::size_t
  size() const
  {
    return delta_squared.size();
  }
  /** \brief Linear bin of every feature for a model of \p delta_max. */
  void bins(double delta_max, std::vector<std::uint32_t>& out) const;
};

/** \brief Draws the same pairs as countDrawnPairs() and keeps their features, in drawing order.
 * Fewer than two surflets have none. The result does not depend on \p threads (0: all).
 * \throws std::invalid_argument for an unusable resolution */
PCL_SURFLET_API FeatureSample drawFeatures(const PairSource& source, const Resolution& resolution,
                                           std::uint64_t n, std::uint64_t seed,
                                           unsigned threads = 1);

/** \brief Mark of a pair without feature in PairFeatures::angular_bin. */
constexpr std::uint32_t kNoPairFeature = 0xffffffffu;

/** \brief Features of pairs, one entry a pair, as far as models of one angular resolution need
 * them. */
struct PairFeatures {
  std::vector<std::uint32_t> angular_bin; ///< bin of (alpha, beta, gamma), or kNoPairFeature
  std::vector<float> delta_squared;       ///< squared distance, times the source's scale^2
};

/** \brief Features of the pairs (first[i], second[i]) of \p source, in one thread; \p out is
 * replaced. Indices must be below source.size(); a surflet paired with itself has no feature.
 * \throws std::invalid_argument for an unusable resolution or lists of different length */
PCL_SURFLET_API void featuresOfPairs(const PairSource& source, const Resolution& resolution,
                                     const std::vector<std::uint32_t>& first,
                                     const std::vector<std::uint32_t>& second, PairFeatures& out);

/** \brief Rows of pairs that share partners: surflet[i] of a source with count[i] partners from
 * begin[i] on. Twice as fast as featuresOfPairs(), as partners are read in order. */
class PCL_SURFLET_API PairRows {
public:
  std::vector<std::uint32_t> surflet; ///< of each row, below the source's size()
  std::vector<std::uint32_t> begin;   ///< its first partner, below numberOfPartners()
  std::vector<std::uint32_t> count;   ///< its number of partners

  /** \brief Removes all rows; the partners stay. */
  void clearRows();
  /** \brief Adds the pairs of \p surflet with the partners [begin, begin + count). */
  void addRow(std::uint32_t surflet, std::size_t begin, std::size_t count);
  /** \brief Copies the surflets at \p indices, which must be below source.size(), as partners. */
  void setPartners(const PairSource& source, const std::vector<std::uint32_t>& indices);
  /** \brief Columns of the partners, in the source's unit scale, and some padding. */
  const SurfletSet&
  partners() const
  {
    return partners_;
  }
  /** \brief Number of partners, without the padding. */
  std::size_t
  numberOfPartners() const
  {
    return number_;
  }

private:
  SurfletSet partners_;
  std::size_t number_ = 0;
};

/** \brief Features of the pairs, row by row, as featuresOfPairs() computes them.
 * \throws std::invalid_argument for an unusable resolution, lists of different length, or a row
 * that ends behind the last partner */
PCL_SURFLET_API void featuresOfRows(const PairSource& source, const Resolution& resolution,
                                    const PairRows& rows, PairFeatures& out);

/** \brief Border \p k (0 to d_delta - 2) between the intervals of delta, in the measure of
 * PairFeatures::delta_squared: a pair is beyond it where delta_squared >= border. The same
 * comparison as in all counting functions. */
PCL_SURFLET_API float deltaBorder(int k, const Resolution& resolution, double delta_max,
                                  double scale);

/** \brief Indices of the drawn pairs number \p first to \p first + n - 1 among \p m surflets (m >=
 * 2), the same pairs that countDrawnPairs() and drawFeatures() draw with that seed. */
PCL_SURFLET_API std::vector<std::pair<std::uint32_t, std::uint32_t>>
drawPairs(std::size_t m, std::uint64_t n, std::uint64_t seed, std::uint64_t first = 0);

} // namespace pcl_surflet
