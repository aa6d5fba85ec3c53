#include "interpretation/output.h"

#include "picture.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>

#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief A directory of our own that is gone with the object: a name that others can guess in a
 * directory that all may write to could be a link of theirs. */
class TemporaryDirectory {
public:
  TemporaryDirectory()
      : path_((std::filesystem::temp_directory_path() / "pcl_surflet_interpret_XXXXXX").string())
  {
    if (::mkdtemp(path_.data()) == nullptr)
      throw DataError("cannot make the directory '" + path_ + "': " + std::strerror(errno) +
                      "; make room there, or name another by TMPDIR");
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory()
  {
    std::error_code failure;
    std::filesystem::remove_all(path_, failure);
  }
  std::string
  file(const std::string& name) const
  {
    return path_ + "/" + name;
  }

private:
  std::string path_;
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
  if (!o.out.empty())
    writeFile(o.out, scene.labelled);
  if (o.picture.empty())
    return;
  const TemporaryDirectory drawn;
  writeFile(drawn.file("scene.pcd"), scene.labelled);
  const std::string overlay = scene.posed.empty() ? "" : drawn.file("poses.pcd");
  if (!overlay.empty())
    writeFile(overlay, scene.posed);
  drawPicture(drawn.file("scene.pcd"), o.database, o.picture, overlay);
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
