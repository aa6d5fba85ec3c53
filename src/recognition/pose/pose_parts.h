/** \file
 * The parts of pose estimation; internal, not installed.
 *
 * Everything here is in the model's unit frame: its centroid in the origin, its diameter 1. */
#pragma once

#include "pcl_surflet/recognition/pose.h"

#include "core/vector3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_surflet {
namespace pose {

using detail::Vector3;

constexpr double kReach = 0.08; ///< farthest distance that a lookup answers

inline Vector3
positionOf(const SurfletSet& s, std::size_t i)
{
  return {s.x[i], s.y[i], s.z[i]};
}

inline Vector3
normalOf(const SurfletSet& s, std::size_t i)
{
  return {s.nx[i], s.ny[i], s.nz[i]};
}

/** \brief Mean surflets of cells, made apart for normals along +-x, +-y, +-z: both sides of a thin
 * wall remain, where reduceToCells() alone cancels them. */
SurfletSet cellsByDirection(const SurfletSet& set, double leaf);

/** \brief Every k-th surflet, at most \p most in all. */
SurfletSet thinned(const SurfletSet& set, std::size_t most);

/** \brief Answers which surflet of a surface is nearest among those that face the same way, in the
 * time of one memory access: a grid of voxels for each of six directions. */
class SurfaceLookup {
public:
  static constexpr std::uint16_t none = 0xffff;

  /** \param surface at most 65,534 surflets within the unit ball */
  explicit SurfaceLookup(const SurfletSet& surface);

  /** \brief Index of the nearest surflet, or none within kReach. */
  std::uint16_t nearest(const Vector3& p, const Vector3& n) const;

private:
  void enter(const SurfletSet& surface, std::size_t i, std::size_t direction,
             std::vector<float>& distances);

  std::array<double, 3> low_{};
  std::array<std::ptrdiff_t, 3> size_{};
  std::vector<std::uint16_t> voxels_;
};

/** \brief A pair of the model, as a pose needs it. */
struct TablePair {
  std::uint16_t origin; ///< cell that Eq. 2.2 makes the origin
  float azimuth;        ///< of the other end about the origin's normal, from its tangent
};

/** \brief Model pairs by their quantised features. */
class PairTable {
public:
  explicit PairTable(const SurfletSet& cells);

  struct Range {
    const TablePair *first, *last;
  };
  Range pairsLike(const double (&feature)[4]) const;

private:
  std::vector<std::uint32_t> begin_;
  std::vector<TablePair> pairs_;
};

/** \brief Right-handed frame whose third axis is \p n: rows e1, e2, n. */
std::array<Vector3, 3> frameOf(const Vector3& n);

/** \brief Azimuth of \p d about the third axis of \p frame, in (-pi, pi]. */
double azimuthOf(const Vector3& d, const std::array<Vector3, 3>& frame);

/** \brief Which cells are seen from where, by a distant sensor without other things between. */
class Visibility {
public:
  Visibility() = default;
  Visibility(const SurfletSet& surface, const SurfletSet& cells);

  /** \brief Adds to \p seen (as many as cells) what is seen from the unit direction \p to_sensor.
   */
  void addSeen(const Vector3& to_sensor, std::vector<char>& seen) const;

private:
  std::vector<Vector3> directions_;
  std::vector<std::vector<char>> seen_;
};

/** \brief See PoseModel. */
struct ModelData {
  ModelData(std::string name, double model_diameter, const Vector3& model_centre,
            SurfletSet unit_surface);

  std::string label;
  double diameter;
  Vector3 centre;
  SurfletSet surface; ///< dense, for distances
  SurfaceLookup lookup;
  double leaf; ///< of the cells
  SurfletSet cells;
  std::vector<std::uint16_t> cell_of; ///< of every surflet of the surface
  PairTable table;
  Visibility visibility;
  Symmetry symmetry;              ///< in the model's coordinates
  std::vector<RigidMotion> turns; ///< that nearly map the model onto itself, unit frame
};

/** \brief Cells of a cluster and where its sensors are, in a frame of the model's unit. */
struct Cluster {
  SurfletSet cells;
  SurfletSet beside; ///< cells that may belong to the object, too
  std::vector<Vector3> viewpoints;
  double unseen_weight = 0;
};

struct Fit {
  double share = 0;   ///< of the cluster on the model
  double score = 0;   ///< share less what should be seen
  double squares = 0; ///< mean squared distance from tangent planes, weighted
};

/** \brief How well the cluster lies on the model if \p to_model takes it there. Cells beside it add
 * to the score where they lie on the model, and count as found. */
Fit fitOf(const ModelData& model, const Cluster& cluster, const RigidMotion& to_model,
          double reach);

/** \brief Share of what the viewpoints should see that the cluster, without what is beside it,
 * holds; NaN without viewpoints, or where they see nothing. */
double coverageOf(const ModelData& model, const Cluster& cluster, const RigidMotion& to_model,
                  double reach);

/** \brief Share of the model that lies on itself after \p motion. */
double selfShare(const ModelData& model, const RigidMotion& motion, double reach);

/** \brief Sums of a Gauss-Newton step on distances from tangent planes, and its solution. */
struct NormalEquations {
  std::array<std::array<double, 6>, 6> matrix{};
  std::array<double, 6> right{};
  double weight = 0, squares = 0;
  std::size_t cells = 0;

  /** \brief Turn and shift that reduce the distances, damped. */
  std::array<double, 6> solved(double damping) const;
};

NormalEquations normalEquations(const ModelData& model, const SurfletSet& cells,
                                const RigidMotion& to_model, double reach);

/** \brief Gauss-Newton steps, the reach shrinking from \p coarse to \p fine. */
RigidMotion refined(const ModelData& model, const SurfletSet& cells, RigidMotion to_model,
                    double coarse, double fine, unsigned steps);

/** \brief A motion that pairs voted for. */
struct Proposal {
  RigidMotion to_model;
  double score = 0;
};

/** \brief The best motions of every reference, in no order of merit. */
std::vector<Proposal> proposals(const ModelData& model, const SurfletSet& cells,
                                const PoseParameters& parameters);

/** \brief The best by score of proposals that differ. */
std::vector<Proposal> distinct(std::vector<Proposal> all, std::size_t most);

/** \brief Finds ModelData::symmetry and ModelData::turns by registering the model with itself. */
void findSymmetries(ModelData& model, std::uint64_t seed);

/** \brief Angle of a rotation in [0, pi]. */
double angleOf(const RigidMotion& motion);

} // namespace pose
} // namespace pcl_surflet
