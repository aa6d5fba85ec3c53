/** \file
 * From a scene's file to what is said and written about it. */
#pragma once

#include "interpretation/options.h"

#include "pcl_surflet/recognition/model_database.h"
#include "pcl_surflet/scene_interpreter.h"

#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief A file to be written. */
struct NamedContent {
  std::string name, content;

  template <class Archive>
  void
  serialize(Archive& archive, unsigned)
  {
    archive& name& content;
  }
};

/** \brief What became of one scene; the rank that interprets it neither prints nor writes. */
struct InterpretedScene {
  std::string error;                 ///< empty if it could be interpreted
  std::vector<std::string> notes;    ///< about the file
  std::string found, steps;          ///< foundText(), and with -verbose stepsText()
  std::vector<NamedContent> objects; ///< with -objects_dir: SCENE_NUMBER_NAME.pcd
  std::string labelled;              ///< PCD of all points, with -out or -picture
  std::string posed;                 ///< PCD of the models in their poses, with -picture and -pose

  template <class Archive>
  void
  serialize(Archive& archive, unsigned)
  {
    archive& error& notes& found& steps& objects& labelled& posed;
  }
};

/** \brief Interprets one scene after the other as the options want it. */
class SceneWorker {
public:
  /** \param notes what is to be said about the file of -empty is appended
   * \throws SurfaceFileError, DataError if that file cannot be used */
  SceneWorker(const ModelDatabase& database, const InterpretOptions& o,
              std::vector<std::string>& notes);

  /** \brief Never throws because of the file. */
  InterpretedScene interpret(const std::string& path);

private:
  void interpretInto(const std::string& path, InterpretedScene& out);

  const InterpretOptions& o_;
  SceneInterpreter<pcl::PointNormal> interpreter_;
};

} // namespace apps
} // namespace pcl_surflet
