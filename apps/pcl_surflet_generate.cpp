// Makes labelled scenes of objects on a background, with the truth about them.

#include "app_common.h"
#include "labelled_pcd.h"
#include "scene_items.h"

#include "pcl_surflet/core/scene_generator.h"

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_generate";

struct Outputs {
  std::string scene, poses, empty, models;
};

std::string
asPoses(const Scene& scene)
{
  std::string text = "object,label,instance,known";
  for (const char* row : {"0", "1", "2", "3"})
    for (const char* column : {"0", "1", "2", "3"})
      text += std::string(",m") + row + column;
  text += ",cx,cy,cz,points\n";
  for (std::size_t k = 0; k < scene.items.size(); ++k) {
    const auto& item = scene.items[k];
    text += csvField(item.label) + "," + std::to_string(item.number) + "," + std::to_string(k + 1) +
            (item.clutter ? ",0" : ",1");
    for (const double v : item.pose)
      text += "," + number(v);
    for (const double v : item.centroid)
      text += "," + number(v);
    text += "," + std::to_string(item.surflets) + "\n";
  }
  return text;
}

int
generate(int argc, char** argv)
{
  SceneOptions o;
  Outputs out;
  std::string clutter;
  std::uint64_t present = 0, unknown = 0;
  CommandLine line(kProgram, "ITEM...",
                   "Makes a labelled scene of objects on a background. ITEM is the name of a shape "
                   "(see pcl_surflet_generate_shape)\nor FILE[:DIAMETER[:UP]], a mesh, its "
                   "diameter in the scene and which of its axes (x, y, z) points up.");
  line.text("-out", "SCENE.pcd", "labelled scene: 0 background, i the i-th ITEM, then clutter",
            out.scene);
  line.text("-poses", "POSES.csv", "pose (item to scene), centroid and points of what is there",
            out.poses);
  line.text("-empty", "EMPTY.pcd", "the same background without objects", out.empty);
  line.text("-models", "DIR", "every ITEM by itself as DIR/NAME.off, upright, to train models from",
            out.models);
  line.count("-present", "N", "items present, chosen at random, default all", present, 1, 1000000);
  line.text("-clutter", "ITEM,...", "things unknown to the database", clutter);
  line.count("-unknown", "N", "things present of the clutter, default all", unknown, 0, 1000000);
  addArrangement(line, o);
  line.real("-density", "D", "points per squared unit, default 470000", o.density, 1e-9, 1e12);
  line.real("-noise", "S", "moves points along their normals by up to S, default 0", o.noise, 0,
            1e6);
  addSeed(line, o.seed);
  if (!line.parse(argc, argv))
    return kOk;
  line.require("-out");
  line.requireFiles(1, 1000);
  const auto objects = itemsOf(line.files());
  const auto others = line.given("-clutter") ? itemsOf(parts(clutter, ',')) : itemsOf({});
  o.present = line.given("-present") ? present : objects.size();
  o.clutter = line.given("-unknown") ? unknown : others.size();
  if (o.present > objects.size() || o.clutter > others.size())
    throw UsageError(std::string("option ") +
                     (o.present > objects.size() ? "-present" : "-unknown") +
                     ": so many things were not given");
  const Scene scene = generateScene(objects, others, o);
  const PointLabels labels{scene.labels, scene.instances};
  writeFile(out.scene, asPcd(scene.surflets, &labels));
  if (line.given("-poses"))
    writeFile(out.poses, asPoses(scene));
  if (line.given("-models"))
    saveMeshes(line.files(), out.models);
  if (line.given("-empty"))
    writeFile(out.empty, asPcd(emptyBackground(o), nullptr));
  note("wrote '" + out.scene + "': " + std::to_string(scene.surflets.size()) + " points, " +
       std::to_string(scene.items.size()) + " items");
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return generate(argc, argv); });
}
