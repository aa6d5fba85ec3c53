/** \file
 * Which detections pcl_surflet_interpret tells of. */
#pragma once

#include "interpretation/options.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Leaves out what is not sure enough, and notes how much that was. */
class Selection {
public:
  /** \param path of the scene, for the notes */
  Selection(const InterpretOptions& o, std::string path, std::vector<std::string>& notes)
      : o_(o), path_(std::move(path)), notes_(notes)
  {
  }

  /** \brief Before there are poses: by confidence, unless poses are to be the judge. */
  void removeDoubtful(std::vector<SceneDetection>& found) const;
  /** \brief By poses, if they are to be the judge; where they leave it open, by confidence. */
  void verify(std::vector<SceneDetection>& found, std::vector<PoseEstimate>& poses) const;

private:
  void note(std::size_t removed, const std::string& why) const;

  const InterpretOptions& o_;
  std::string path_;
  std::vector<std::string>& notes_;
};

} // namespace apps
} // namespace pcl_surflet
