#include "interpretation/output.h"

#include "picture.h"

#include <filesystem>
#include <iostream>
#include <system_error>

#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief A file that is gone with the object. */
struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& what)
      : path((std::filesystem::temp_directory_path() /
              ("pcl_surflet_interpret_" + std::to_string(::getpid()) + what + ".pcd"))
                 .string())
  {
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile()
  {
    std::error_code failure;
    std::filesystem::remove(path, failure);
  }
};

void
writeObjects(const std::vector<NamedContent>& objects, const std::string& directory)
{
  std::error_code failure;
  std::filesystem::create_directories(directory, failure); // writeFile() will say it better
  for (const auto& object : objects)
    writeFile((std::filesystem::path(directory) / object.name).string(), object.content);
}

/** \brief The labelled points, and a picture of them. */
void
writeScene(const InterpretedScene& scene, const InterpretOptions& o)
{
  const TemporaryFile temporary(""), overlay("_poses");
  const std::string labelled = o.out.empty() ? temporary.path : o.out;
  writeFile(labelled, scene.labelled);
  if (o.picture.empty())
    return;
  if (!scene.posed.empty())
    writeFile(overlay.path, scene.posed);
  drawPicture(labelled, o.database, o.picture, scene.posed.empty() ? "" : overlay.path);
}

} // namespace

void
deliver(const InterpretedScene& scene, const InterpretOptions& o)
{
  for (const auto& text : scene.notes)
    note(text);
  if (!scene.error.empty())
    throw DataError(scene.error);
  std::cout << scene.found << std::flush; // whole scenes, should the run be ended
  std::cerr << scene.steps;
  if (!o.objects_dir.empty())
    writeObjects(scene.objects, o.objects_dir);
  if (!o.out.empty() || !o.picture.empty())
    writeScene(scene, o);
}

} // namespace apps
} // namespace pcl_surflet
