#include "interpretation/options.h"

#include "scene_items.h"

#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

void
addOptions(CommandLine& line, InterpretOptions& o)
{
  line.text("-database", "DB.pcd",
            "models, made by pcl_surflet_train, best with -bins 7,7,7,7 (required)", o.database);
  addChoice<Method>(line, "-method", "default explanation", o.method,
                    {{"explanation", Method::Explanation}, {"dissertation", Method::Dissertation}});
  addChoice<BackgroundTreatment>(line, "-background", "default ignore", o.background,
                                 {{"ignore", BackgroundTreatment::Ignore},
                                  {"exclude", BackgroundTreatment::Exclude},
                                  {"model", BackgroundTreatment::Model}});
  line.text("-empty", "EMPTY.pcd", "exclude: the scene sensed without objects", o.empty);
  line.count("-planes", "N", "exclude: the N largest planes, 1 for a table, 2 for a shelf",
             o.planes, 1, 100);
  line.real("-distance", "D", "exclude: what is so near to the background, default a cell",
            o.distance, 1e-9, 1e9);
  line.real("-leaf", "S",
            "edge of the cells, default what all models were trained for, else a fiftieth of the "
            "largest",
            o.leaf, 1e-9, 1e9);
  line.count("-max", "N", "detections, those of the most cells, default all", o.detections, 1,
             1000000);
  line.real("-min_confidence", "X", "explanation: leaves out what is less sure, default 0.1",
            o.min_confidence, 0, 1);
  line.text(
      "-out", "OUT.pcd",
      "the scene with all its points and fields as they are, and normals, label (0 none, else "
      "number in the database, from 1) and instance (0 none, else which detection); one "
      "scene only",
      o.out);
  line.text("-objects_dir", "DIR", "every object by itself as DIR/SCENE_NUMBER_NAME.pcd",
            o.objects_dir);
  line.text("-picture", "OUT.png",
            "the scene with its objects coloured and named, and with -pose the models as dark "
            "points; one scene only",
            o.picture);
  o.pose.addOptions(line);
  line.flag("-csv",
            "prints a table with the columns file,label,points,x,y,z,score,fit,confidence,coverage "
            "and those of poses; x,y,z is where the middle of the whole object is guessed",
            o.csv);
  line.flag("-verbose", "prints what each step did for each model to stderr", o.verbose);
  addMissingNormals(line, o.normals);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
}

void
checkBackground(const CommandLine& line, const InterpretOptions& o)
{
  const bool excludes = o.background == BackgroundTreatment::Exclude;
  for (const char* name : {"-empty", "-planes", "-distance"})
    if (!excludes && line.given(name))
      throw UsageError(std::string("option ") + name + " goes with -background exclude");
  if (excludes && !line.given("-empty") && !line.given("-planes"))
    throw UsageError("option -background exclude needs -empty or -planes");
}

/** \brief Objects are named by their scene. */
void
checkStems(const std::vector<std::string>& files)
{
  std::map<std::string, std::string> seen;
  for (const auto& file : files)
    if (const auto [at, is_new] = seen.try_emplace(stemOf(file), file); !is_new)
      throw UsageError("'" + at->second + "' and '" + file +
                       "' would have the same names by option -objects_dir; give them one by one");
}

} // namespace

bool
readInterpretOptions(const std::string& program, int argc, char** argv, InterpretOptions& o)
{
  CommandLine line(program, "SCENE...",
                   "Finds and names the objects of scenes (PCD or PLY with normals, or see -k).");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return false;
  line.require("-database");
  line.requireFiles(1, line.given("-out") || line.given("-picture") ? 1 : 1000000);
  checkBackground(line, o);
  if (o.method == Method::Dissertation && !line.given("-min_confidence"))
    o.min_confidence = 0; // its confidence is not calibrated
  for (const char* name : {"-viewpoints", "-verify"})
    if (line.given(name) && !line.given("-pose"))
      throw UsageError(std::string("option ") + name + " goes with -pose");
  if (o.pose.verify && o.method == Method::Dissertation)
    throw UsageError("option -verify is for -method explanation");
  o.files = line.files();
  requirePngName(o.picture);
  requirePcdName(o.out);
  if (!o.objects_dir.empty())
    checkStems(o.files);
  return true;
}

} // namespace apps
} // namespace pcl_surflet
