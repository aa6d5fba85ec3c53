/** \file
 * Online interpretation: a scene that grows scan by scan. */
#pragma once

#include "pcl_surflet/recognition/scene_interpretation.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_surflet {

/** \brief What the last scan meant for a detection. */
enum class OnlineState {
  New,     ///< was not there before
  Updated, ///< was there before, and its region has been interpreted again
  Kept,    ///< nothing, or too little, has changed where it is
  Vanished ///< was there before the last scan; reported once
};

/** \brief An object of a growing scene. */
struct OnlineDetection : Detection {
  std::uint64_t id = 0;                 ///< from 1; never given twice
  OnlineState state = OnlineState::New; ///< since the scan before
  /** \brief Its cells, relative to those expected of the model's whole surface. NaN if the model's
   * area is unknown. */
  double coverage = 0;
};

/** \brief A place where more data would decide [Wahl 2007, Sec. 6.3.2]. */
struct Attractor {
  std::array<double, 3> centre{}; ///< of the cells seen there
  double radius = 0;              ///< largest distance of these to the centre
  /** \brief Unit vector from the place to where a sensor should stand: opposite to the mean normal
   * of the cells seen. All 0 if these look every way. */
  std::array<double, 3> view_from{};
  std::uint64_t id = 0; ///< of the detection in doubt; 0: cells that nothing explains
};

/** \brief A region that is explained; another look at it tells little. */
struct Distractor {
  std::array<double, 3> centre{}; ///< of the detection's cells
  double radius = 0;              ///< largest distance of these to the centre
  std::uint64_t id = 0;           ///< of the detection
};

/** \brief What one scan did. */
struct OnlineScan {
  std::size_t surflets = 0;          ///< that went into cells
  std::size_t rejected = 0;          ///< not finite, or absurdly far away
  std::size_t background = 0;        ///< cells that are new or moved, and near the empty scene
  std::size_t cells = 0;             ///< of the scene so far: the size of cells()
  std::size_t changed_cells = 0;     ///< others that are new or moved since they last changed
  std::size_t vanished_cells = 0;    ///< that the scan has seen through
  std::size_t interpreted_cells = 0; ///< interpreted again
  std::size_t kept = 0;              ///< detections that were not sought again
  std::size_t sought = 0;            ///< detections that were
  bool cancelled = false; ///< progress said so: nothing is as if the scan had not been taken
};

/** \brief Constants of OnlineInterpretation; leaf must be set. Lengths are in the unit of the
 * scene. */
struct OnlineParameters {
  /** \brief Its threads, seed, background and progress apply; leaf is set to that of the cells. */
  ExplanationParameters explanation;
  double leaf = 0;       ///< edge of the cells, > 0
  double moved = 0.25;   ///< a cell has changed if its mean moved by this many leaves, > 0
  double turned = 0.35;  ///< or its mean normal turned by this angle in rad, in (0, pi]
  double coverage = 0.5; ///< a detection of less is an attractor, in [0, 1]
  double margin = 0.05;  ///< a detection of less is an attractor, in [-1, 1]
  /** \brief A detection that is no attractor is sought again once so many cells, relative to its
   * own, changed where it is, >= 0; 0: after any change. */
  double stale = 0.1;
  /** \brief A cell vanishes if a scan's rays that pass within a leaf of it all end at least this
   * many leaves behind it, >= 0. 0: cells never vanish. Needs to know where the sensor is. */
  double behind = 1.5;
  std::size_t rays = 3;   ///< and if they are at least so many, >= 1
  SurfletSet empty_scene; ///< the scene without objects, whose surface is left out; may be empty
  double distance = 0;    ///< what is so near to it is left out; 0: a leaf
};

/** \brief Interprets a scene while it grows [Wahl 2007, Sec. 6.3.2].
 *
 * Keeps the mean surflets of cells, two where both sides of a wall are seen. After each scan only
 * what lies about new, moved and vanished cells is interpreted again, by interpretByExplanation();
 * other detections stay, and those that are no attractors until enough has changed. How often a
 * cell was seen does not count, as the interpretation knows nothing but its mean. The result
 * depends on the scans and their order, not on the number of threads. Limits: doc/online.md.
 *
 * A scan that throws, for want of memory or because progress does, leaves everything as it was. */
class PCL_SURFLET_API OnlineInterpretation {
public:
  /** \brief Nothing seen yet. \throws std::invalid_argument if a parameter is out of range \throws
   * DatabaseError if the database has no object */
  OnlineInterpretation(ModelDatabase database, OnlineParameters parameters);
  ~OnlineInterpretation();
  OnlineInterpretation(OnlineInterpretation&&) noexcept; ///< leaves the other to be destroyed
  /** \brief Leaves the other only to be destroyed. */
  OnlineInterpretation& operator=(OnlineInterpretation&&) noexcept;

  /** \brief Takes in a scan and interprets what it changed. \param surflets in the frame of the
   * scene, normals towards the sensor; what is not finite is left out. May be empty. */
  OnlineScan addScan(const SurfletSet& surflets);
  /** \brief The same, and cells that the scan has seen through vanish: OnlineParameters::behind.
   * Positions without usable normal count as ends of rays.
   * \param surflets in the frame of the scene, normals towards the sensor
   * \param sensor where it was, in the frame of the scene
   * \throws std::invalid_argument if that is not finite */
  OnlineScan addScan(const SurfletSet& surflets, const std::array<double, 3>& sensor);

  /** \brief The cells so far; what Detection::cells indexes. Numbers of cells never change; those
   * that vanished hold NaN. The empty scene's are among them. */
  const SurfletSet& cells() const;
  /** \brief By ascending id; those that vanished come last. */
  const std::vector<OnlineDetection>& detections() const;
  const std::vector<Attractor>& attractors() const;   ///< of the scene so far
  const std::vector<Distractor>& distractors() const; ///< of the scene so far

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace pcl_surflet
