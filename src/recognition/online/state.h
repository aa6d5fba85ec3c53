/** \file
 * A scene that is interpreted while it grows; internal, not installed. */
#pragma once

#include "free_space.h"
#include "tracking.h"

#include "recognition/interpretation/exclusion.h"

#include <optional>

namespace pcl_surflet {

struct OnlineInterpretation::State {
  ModelDatabase database;
  OnlineParameters parameters;
  double largest;                                  ///< delta_max of the objects
  double farthest;                                 ///< from one end of a ball to the other
  std::optional<interpretation::EmptyScene> empty; ///< none: nothing is left out
  online::OnlineCells cells;
  std::vector<OnlineDetection> detections; ///< those that vanished come last
  std::vector<online::Note> notes;         ///< one for each that did not
  std::vector<std::uint64_t> owner;        ///< of each cell: id of a detection, or 0
  online::Groups groups;                   ///< of cells that nothing explains
  std::vector<Attractor> attractors;
  std::vector<Distractor> distractors;
  std::uint64_t next_id = 1;

  State(ModelDatabase d, OnlineParameters p);

  /** \brief All or nothing. */
  OnlineScan addScan(const SurfletSet& surflets, const online::Place* sensor);

private:
  /** \brief What a scan changed. */
  struct Changes {
    online::Indices cells, gone;
    std::vector<online::ChangedPlace> places; ///< where these are, and those that are gone were
  };
  /** \brief What will be known. Everything that can fail is done before any of it is taken over. */
  struct Next {
    online::Concern concern;
    std::vector<OnlineDetection> found;
    std::vector<online::Note> kept_notes, found_notes; ///< parallel to concern.kept and found
    std::vector<online::Indices> kept_cells;           ///< parallel, empty: as they were
    std::vector<bool> goes_on;                         ///< parallel to concern.reopened
    online::Groups groups;
    std::vector<Attractor> attractors;
    std::vector<Distractor> distractors;
    std::vector<OnlineDetection> detections; ///< empty, with room for all
    std::vector<online::Note> notes;         ///< likewise
    std::uint64_t next_id = 1;
  };

  void fill(const SurfletSet& surflets, OnlineScan& scan);
  Changes changesBy(const SurfletSet& surflets, const online::Place* sensor, OnlineScan& scan);
  void exclude(const online::Indices& changed, OnlineScan& scan);
  void removeSeenThrough(const SurfletSet& ends, const online::Place& sensor, Changes& changes);

  Next next(const Changes& changes, OnlineScan& scan) const;
  std::vector<OnlineDetection> interpretOpen(const online::Concern& concern,
                                             OnlineScan& scan) const;
  online::Note noteOf(const OnlineDetection& d, const online::Indices& cells) const;
  void noteKept(Next& next) const;
  void regroup(const Changes& changes, Next& next) const;
  void lookAround(Next& next) const;
  void takeKept(Next& next) noexcept;
  void takeFound(Next& next) noexcept;
  void takeOver(Next&& next) noexcept;
};

} // namespace pcl_surflet
