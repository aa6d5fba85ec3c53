// Shows a labelled scene: grey, its objects coloured and named.

#include "app_common.h"
#include "viewer/labelled_scene.h"
#include "viewer/scene_picture.h"
#include "viewer/upright.h"
#include "viewer/virtual_display.h"

#include <memory>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_view";

struct Options {
  std::string database, picture, overlay, up;
  std::uint64_t width = 1000, height = 640;
  PictureOptions look;
};

void
addOptions(CommandLine& line, Options& o)
{
  line.text("-database", "DB.pcd", "names of the labels, which are numbers in it, from 1",
            o.database);
  line.text("-picture", "OUT.png", "draws a picture instead of opening a window", o.picture);
  line.text("-overlay", "CLOUD.pcd", "points drawn dark over the scene, such as posed models",
            o.overlay);
  line.count("-width", "W", "pixels, default 1000", o.width, 16, 16384);
  line.count("-height", "H", "pixels, default 640", o.height, 16, 16384);
  line.text(
      "-up", "AXIS",
      "what points upwards in the scene: x, y, z, -x, -y or -z; default -y for captures in the "
      "frame of their camera (rows and columns, x to the right, y down, z forward), else z",
      o.up);
  line.real("-azimuth", "A",
            "eye about the vertical, degrees from +x, default -60, for captures -90: behind the "
            "camera",
            o.look.azimuth, -360, 360);
  line.real("-elevation", "E", "eye above the horizon, degrees, default 35, for captures 10",
            o.look.elevation, -89, 89);
  line.real("-zoom", "Z", "larger: nearer, default 1", o.look.zoom, 0.01, 100);
  line.real("-point", "P", "size of a point in pixels, default 2", o.look.point, 1, 100);
}

Names
namesIn(const std::string& path)
{
  Names names;
  if (path.empty())
    return names;
  const ModelDatabase database = readDatabase(path);
  for (std::size_t i = 0; i < database.size(); ++i)
    names.push_back(database[i].label);
  return names;
}

/** \brief Turns all so that z is up; a capture is looked at as its camera did, unless told
 * otherwise. */
void
setUpright(const CommandLine& line, LabelledScene& scene, Options& o)
{
  if (o.up.empty() && isCapture(scene)) {
    o.up = "-y";
    if (!line.given("-azimuth"))
      o.look.azimuth = -90;
    if (!line.given("-elevation"))
      o.look.elevation = 10;
  }
  const std::string up = o.up.empty() ? "z" : o.up;
  turnUpright(up, scene.points);
  turnUpright(up, o.look.overlay);
}

int
view(int argc, char** argv)
{
  Options o;
  CommandLine line(kProgram, "LABELLED.pcd",
                   "Shows a scene with its objects coloured and named, such as\n"
                   "pcl_surflet_interpret -out and pcl_surflet_generate write.");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return kOk;
  line.requireFiles(1, 1);
  requirePngName(o.picture);
  o.look.width = static_cast<int>(o.width);
  o.look.height = static_cast<int>(o.height);
  LabelledScene scene = readLabelledScene(line.files()[0]);
  if (!o.overlay.empty())
    o.look.overlay = readLabelledScene(o.overlay).points;
  setUpright(line, scene, o);
  const Names names = namesIn(o.database);
  std::unique_ptr<VirtualDisplay> own_display;
  if (!displayAnswers()) {
    if (o.picture.empty())
      throw DataError("cannot open a window: there is no display (DISPLAY is not set, or its "
                      "server does not answer); draw a file with -picture, or log in graphically");
    own_display = std::make_unique<VirtualDisplay>();
  }
  if (o.picture.empty())
    showScene(scene, names, o.look);
  else
    writeFile(o.picture, drawnScene(scene, names, o.look));
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return view(argc, argv); });
}
