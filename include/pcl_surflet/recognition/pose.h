/** \file
 * Pose of a detected object: the second stage on each labelled cluster [Wahl 2007, Sec. 6.4]. */
#pragma once

#include "pcl_surflet/core/surflet_set.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief Rotation, then translation: x -> R x + t. */
struct PCL_SURFLET_API RigidMotion {
  using Vector = std::array<double, 3>; ///< x, y, z

  std::array<Vector, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; ///< its rows
  Vector translation{0, 0, 0};                                       ///< t

  Vector turned(const Vector& direction) const; ///< R \p direction
  Vector moved(const Vector& point) const;      ///< R \p point + t
  RigidMotion inverse() const;                  ///< of a rotation R, whose rows are orthonormal
  /** \brief This motion after \p first. */
  RigidMotion after(const RigidMotion& first) const;
  /** \brief Unit quaternion (x, y, z, w) with w >= 0. */
  std::array<double, 4> quaternion() const;
};

/** \brief The turn by \p angle (radians) about the unit vector \p axis through \p point. */
PCL_SURFLET_API RigidMotion turnAbout(const RigidMotion::Vector& axis,
                                      const RigidMotion::Vector& point, double angle);
/** \brief \p set moved: positions and normals. */
PCL_SURFLET_API SurfletSet moved(const SurfletSet& set, const RigidMotion& motion);

/** \brief Turns that map a surface onto itself. */
enum class SymmetryKind {
  None,
  Discrete,   ///< turns by 360 degrees / order about an axis
  Continuous, ///< every turn about an axis, a body of revolution
  Spherical   ///< every turn about a point
};

/** \brief How a pose is ambiguous: turned so, the object looks the same. */
struct Symmetry {
  SymmetryKind kind = SymmetryKind::None; ///< which turns
  std::array<double, 3> axis{0, 0, 1};  ///< unit vector; of the highest order, if there are several
  std::array<double, 3> point{0, 0, 0}; ///< on the axis; of Spherical the centre
  unsigned order = 1;                   ///< of Discrete, 2 to 12; 1 for None, 0 for the others
  /** \brief Every motion that is known to map the surface onto itself, without the identity:
   * of a continuous axis its turns in steps of 10 degrees are not listed, half turns about axes
   * across it are. */
  std::vector<RigidMotion> motions;
};

/** \brief What a pose model cannot be made from; what() names cause and remedy. */
class PCL_SURFLET_API PoseModelError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
  ~PoseModelError() override;
};

namespace pose {
struct ModelData;
}

/** \brief What the pose of an object is found with: reduced cells of its whole surface with a table
 * from the features of their pairs to the pairs, the surface for measuring distances, what is
 * visible from where, and its symmetries. An immutable value, cheap to copy.
 *
 * \ref train() takes 0.05 to 0.3 s and a model 2 to 6 MB. */
class PCL_SURFLET_API PoseModel {
public:
  /** \brief Makes a model of a surface.
   * \param label the name by which detections find it
   * \param surflets of the complete surface, evenly dense, normals outwards; 20,000 are a good
   * number. In the unit of the scenes to come, at any place.
   * \param seed of what is drawn at random
   * \throws PoseModelError for fewer than 50 cells, less extent than 1e-12, or surflets that are
   * not finite. The same input and seed give the same model for any number of threads. */
  static PoseModel train(const std::string& label, const SurfletSet& surflets,
                         std::uint64_t seed = 1);

  /** \brief The name given to train(). */
  const std::string& label() const;
  /** \brief Largest distance between two surflets. */
  double diameter() const;
  /** \brief In the model's coordinates. */
  const Symmetry& symmetry() const;
  /** \brief About 500 mean surflets of the surface, in the model's coordinates. */
  SurfletSet cells() const;
  /** \brief The implementation; of no use outside the library. */
  const pose::ModelData&
  data() const
  {
    return *data_;
  }

private:
  explicit PoseModel(std::shared_ptr<const pose::ModelData> data) : data_(std::move(data)) {}

  std::shared_ptr<const pose::ModelData> data_;
};

/** \brief Constants of estimatePose(), chosen on scenes with seeds below 100. Lengths are shares of
 * the model's diameter. */
struct PoseParameters {
  /** \brief Places of the sensors that made the scene, in its coordinates. Known, what a pose says
   * they should have seen and have not counts against it. Empty: unknown. */
  std::vector<std::array<double, 3>> viewpoints;
  std::size_t references = 24;   ///< cells whose pairs vote, >= 1
  std::size_t partners = 400;    ///< cells that each is paired with, >= 1
  std::size_t peaks = 3;         ///< poses that each reference proposes, >= 1
  std::size_t refined = 6;       ///< proposals that are refined, >= 1
  std::size_t final_cells = 800; ///< most cells of the cluster that are looked at, >= 50
  double coarse_reach = 0.08;    ///< farthest distance that counts among proposals, in (0, 0.08]
  double fine_reach = 0.03;      ///< the same at the end, in (0, coarse_reach]
  double unseen_weight = 0.3;    ///< of surface not found, where viewpoints are known, in [0, 1]
  double min_inliers = 0.3;      ///< least share of the cluster that lies on the model, in [0, 1]
  std::uint64_t seed = 1;        ///< of the cells drawn
};

/** \brief How an estimation ended. */
enum class PoseStatus {
  Found,
  TooFewCells,  ///< fewer than three cells, or nothing finite
  Undetermined, ///< planar, or normals that leave the pose open: no three independent directions
  NoAgreement,  ///< no pose puts enough of the cluster on the model
  NoModel       ///< PoseEstimator: no model has the name of the detection
};

/** \brief Where an object is. */
struct PoseEstimate {
  PoseStatus status = PoseStatus::TooFewCells; ///< what follows is only meant for Found
  std::string reason;                          ///< status in words; empty if a pose was found
  RigidMotion motion;                          ///< from the model's coordinates to the scene's
  double score = 0;        ///< by which poses were compared: inlier share less what should be seen
  double inlier_share = 0; ///< of the cluster's cells, weighted by how well they fit, in [0, 1]
  /** \brief Score less that of the best pose found that looks different; small where the cluster
   * leaves the pose open, say where a cup hides its handle. */
  double margin = 0;
  /** \brief Share of what the viewpoints should see of the model in this pose that the cluster
   * holds, in [0, 1]: what is missing is hidden by other things or was not found, or the cluster is
   * sparser than the model's cells (about 500 on the whole surface). NaN without viewpoints. */
  double coverage = std::numeric_limits<double>::quiet_NaN();
  double residual = 0; ///< root mean square distance of inliers from the surface, scene's unit
  /** \brief Standard deviation of the object's centre, scene's unit, as the residuals of
   * independent cells tell. */
  double position_deviation = 0;
  /** \brief The same of its rotation, radians, without the turn about a continuous axis. */
  double rotation_deviation = 0;
  Symmetry symmetry;     ///< in the scene's coordinates
  std::size_t cells = 0; ///< of the cluster, looked at
};

/** \brief Finds the pose of \p model in a cluster, from the cluster alone.
 *
 * Pairs of the cluster's cells look up model pairs of like feature [Wahl 2007, Eq. 2.6-2.9]; two
 * such pairs fix a motion, which is voted for. The best motions are scored by how many cells lie on
 * the model with like normals, refined by Gauss-Newton steps on the distances from tangent
 * planes, tried in all turns that nearly map the model onto itself (a cup's yaw is decided by its
 * handle), and scored again.
 *
 * \param cluster points or cells of one object, normals outwards; up to a quarter may be foreign.
 * Surflets that are not finite are left out.
 * \param model of the object that the cluster is taken for
 * \param parameters see there
 * \param beside points around the cluster that belong to no other object: what a segmentation lost.
 * They propose no pose, but confirm one where they lie on the model: a cup's handle often is
 * missing in its cluster. Far ones are ignored.
 * The result depends on nothing but the arguments. \throws std::invalid_argument if a parameter is
 * out of range */
PCL_SURFLET_API PoseEstimate estimatePose(const SurfletSet& cluster, const PoseModel& model,
                                          const PoseParameters& parameters = {},
                                          const SurfletSet& beside = {});

} // namespace pcl_surflet
