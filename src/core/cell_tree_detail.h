/** \file
 * What both dynamic trees are made of: buckets, and the geometry of a region query. */
#pragma once

#include "pcl_surflet/core/cell_tree.h"
#include "pcl_surflet/core/morton_key.h"

#include <vector>

namespace pcl_surflet {
namespace detail {

constexpr std::uint32_t kNone = 0xffffffffu;

struct CellPoint {
  float x, y, z;
  PointIndex id;
};

/** \brief Content of an atomic cell: its points and integer sums for the mean surflet. */
struct Bucket {
  std::int64_t position[3] = {0, 0, 0}; ///< from the cell's lowest corner, in 2^-30 of its edge
  std::int64_t normal[3] = {0, 0, 0};   ///< in 2^-30
  std::vector<CellPoint> points;
};

/** \brief Adds (\p sign = 1) or subtracts (-1) \p s; \p cell are its coordinates in \p frame. */
void addToSums(Bucket& bucket, const CubeFrame& frame, const CubeFrame::Coordinates& cell,
               const Surflet& s, int sign);

Cell toCell(const Bucket& bucket, const CubeFrame& frame, const CubeFrame::Coordinates& cell);

/** \brief Buckets by number; numbers of emptied ones are used again. */
class BucketStore {
public:
  std::uint32_t take();
  void release(std::uint32_t bucket);
  std::size_t count() const;
  std::size_t memoryUsage() const;

  Bucket&
  operator[](std::uint32_t i)
  {
    return buckets_[i];
  }
  const Bucket&
  operator[](std::uint32_t i) const
  {
    return buckets_[i];
  }

private:
  std::vector<Bucket> buckets_;
  std::vector<std::uint32_t> free_;
};

/** \brief How far beyond the radius a coordinate can lie and still be found: squares round, and
 * tiny ones vanish. */
double reachOf(double radius);

/** \brief Geometry of F(r, q) with margins that cover all rounding, so that cells are never
 * wrongly skipped or wrongly taken whole. */
struct RegionBounds {
  double q[3];
  double slack;        ///< uncertainty of cell borders
  double skip_beyond;  ///< squared distance
  double whole_within; ///< squared distance
  float square;

  RegionBounds(const CubeFrame& frame, const Position& centre, double radius);
  bool reaches(const double* low, double edge) const;
  bool contains(const double* low, double edge) const;
};

/** \brief Results of a search under way, gathered in blocks. */
struct RegionResult {
  static constexpr std::size_t kCapacity = 512;

  RegionResult(const Position& centre, float square_radius, std::vector<PointIndex>& index_results,
               std::vector<float>* square_results);

  void test(const Bucket& bucket); ///< takes the points of F(r, q)
  void take(const Bucket& bucket); ///< takes all
  void flush();                    ///< once more at the end

  std::vector<PointIndex>& indices;
  std::vector<float>* squares;
  const Position q;
  const float square;
  std::size_t size = 0;
  PointIndex index_buffer[kCapacity];
  float square_buffer[kCapacity];

private:
  void append(const Bucket& bucket, float limit);
};

/** \brief What both trees share; Derived tells how to reach buckets. */
class CellTreeBase : public CellTree {
public:
  explicit CellTreeBase(const CubeFrame& frame) : frame_(frame) {}

  std::size_t
  size() const override
  {
    return size_;
  }
  std::size_t
  cellCount() const override
  {
    return buckets_.count();
  }
  const CubeFrame&
  frame() const override
  {
    return frame_;
  }
  void regionSearch(const Position& q, double radius, std::vector<PointIndex>& indices,
                    std::vector<float>* sqr_distances) const override;
  void nearestSearch(const Position& q, std::size_t k, std::vector<PointIndex>& indices,
                     std::vector<float>& sqr_distances) const override;

  void regionCells(const Position& q, double radius, std::vector<Cell>& cells) const override;

protected:
  /** \brief Steps 2 and 3 of ch. 4.4 for the points of F(r, q). */
  virtual void collectPoints(const StartCells& starts, const RegionBounds& bounds,
                             RegionResult& result) const = 0;

  /** \brief Steps 2 and 3 for the cells that F(r, q) reaches, at least. */
  virtual void collectCells(const StartCells& starts, const RegionBounds& bounds,
                            std::vector<Cell>& cells) const = 0;

  void addToBucket(std::uint32_t bucket, const CubeFrame::Coordinates& cell, PointIndex id,
                   const Surflet& s);
  bool removeFromBucket(std::uint32_t bucket, const CubeFrame::Coordinates& cell, PointIndex id,
                        const Surflet& s);
  CubeFrame::Coordinates
  cellOf(const Surflet& s) const
  {
    return frame_.coordinates({s.x, s.y, s.z});
  }

  CubeFrame frame_;
  BucketStore buckets_;
  std::size_t size_ = 0;
};

bool isFinite(const Position& q);

/** \brief k nearest points by growing regions until one holds k points: what the region search
 * finds is exact, so the k best of it are the nearest. */
void nearestByRegions(const RegionIndex& index, const Position& q, std::size_t k,
                      double first_radius, std::vector<PointIndex>& indices,
                      std::vector<float>& sqr_distances);

/** \brief Appends the points of \p bucket that lie in the box. */
void appendInBox(const Bucket& bucket, const Position& low, const Position& high,
                 std::vector<PointIndex>& indices);

std::unique_ptr<CellTree> makeOctree(const CubeFrame& frame);
std::unique_ptr<CellTree> makeAvlTree(const CubeFrame& frame);

} // namespace detail
} // namespace pcl_surflet
