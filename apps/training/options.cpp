#include "training/options.h"

#include "pcl_surflet/recognition/histogram_model.h"

#include <limits>
#include <map>

namespace pcl_surflet {
namespace apps {
namespace {

Resolution
parseResolution(const std::string& text)
{
  constexpr const char* kName = "-bins";
  std::vector<int> bins;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    bins.push_back(static_cast<int>(
        parseCount(kName, text.substr(begin, end - begin), 1, Resolution::kMaxPerDimension)));
    begin = end + 1;
  }
  if (bins.size() != 4)
    throw UsageError("option -bins: '" + text + "' is not four numbers, as in 5,5,5,5");
  const Resolution resolution{bins[0], bins[1], bins[2], bins[3]};
  if (const auto problem = resolution.problem(); !problem.empty())
    throw UsageError("option -bins: " + problem);
  return resolution;
}

/** \brief Training for scenes is of one histogram from all pairs of an object's cells. */
void
checkLeaf(const CommandLine& line, const TrainOptions& o)
{
  if (o.leaf > 0 && !o.bank.conditions.empty())
    throw UsageError("option -leaf goes with -bank none: scenes are searched for whole objects");
  if (o.views && !(o.leaf > 0))
    throw UsageError("option -views goes with -leaf");
  if (o.views && o.background)
    throw UsageError("option -views does not go with -background");
  if (o.leaf > 0 && line.given("-pairs"))
    throw UsageError("option -pairs does not go with -leaf, which decides how many there are");
  if (o.leaf > 0 && o.background)
    throw UsageError("option -background does not go with -leaf, which leaves out what objects "
                     "lose in cells; train backgrounds apart");
}

/** \brief What option -bank names. */
ModelBank
bankNamed(const std::string& name)
{
  if (name == "default")
    return ModelBank::standard();
  if (name == "none")
    return ModelBank::none();
  try {
    return ModelBank::parse(readTextFile(name));
  }
  catch (const DataError& error) {
    throw DataError("the bank " + std::string(error.what()) +
                    "; or give one of our own, default or none");
  }
  catch (const ModelBankError& error) {
    throw DataError("'" + name + "': " + error.what());
  }
}

/** \brief Every file must give a model of its own. */
void
checkLabels(const TrainOptions& o)
{
  if (!o.label.empty() && o.files.size() > 1)
    throw UsageError("option -label names one model, but " + std::to_string(o.files.size()) +
                     " files are given; train them one by one");
  if (o.label.size() > HistogramModel::kMaxLabelBytes)
    throw UsageError("option -label: longer than 63 bytes");
  if (o.label == HistogramModel::kReservedLabel)
    throw UsageError("option -label: '" + o.label +
                     "' is what programs say of things that no model "
                     "fits; give another");
  std::map<std::string, std::string> seen;
  for (const auto& file : o.files)
    if (o.label.empty() && stemOf(file) == HistogramModel::kReservedLabel)
      throw UsageError("'" + file + "' would be labelled '" + stemOf(file) +
                       "', which programs say of things that no model fits; name it by -label");
  for (const auto& file : o.files)
    if (const auto [at, is_new] = seen.try_emplace(stemOf(file), file); !is_new)
      throw UsageError("'" + at->second + "' and '" + file + "' would both be labelled '" +
                       at->first + "'; train them one by one with option -label");
}

void
addOptions(CommandLine& line, TrainOptions& o)
{
  line.text("-database", "DB.pcd", "the database; made if it does not exist (required)",
            o.database);
  line.text("-label", "NAME", "label of the model, for a single file", o.label);
  line.flag("-background", "the models are background, to be told from objects", o.background);
  line.option("-bins", "A,B,C,D", "bins of alpha, beta, gamma, delta, default 5,5,5,5",
              [&o](const std::string& text) { o.resolution = parseResolution(text); });
  line.option("-bank", "NAME|FILE",
              "conditions that are trained beside the ideal one: default (noise, missing parts, "
              "views; 29 histograms), none (default), or a text file of conditions",
              [&o](const std::string& name) { o.bank = bankNamed(name); });
  line.count("-pairs", "N", "pairs drawn from a cloud, default 10000000 (meshes: all pairs)",
             o.pairs, 1, 1000000000000ULL);
  line.real("-leaf", "S",
            "for pcl_surflet_interpret with cells of this edge (best with -bins 7,7,7,7): learns "
            "what of an object is left in such cells. Clouds should have several points a cell; "
            "meshes are sampled so. Default none: for single objects",
            o.leaf, 1e-9, 1e9);
  line.flag("-views",
            "with -leaf, of meshes: also learns what a sensor sees of the object from one "
            "side or two, z up; for scenes that are not seen from all round",
            o.views);
  addSeed(line, o.seed);
  addThreads(line, o.threads);
  addMissingNormals(line, o.normals);
}

} // namespace

bool
readTrainOptions(const std::string& program, int argc, char** argv, TrainOptions& o)
{
  CommandLine line(program, "FILE...",
                   "Trains one model per file (PCD, PLY, OBJ, STL, OFF), labelled with the file's "
                   "name\nwithout ending, and adds them to a database or replaces those of the "
                   "same label.\nClouds need normals (see -k); clouds of uneven density are evened "
                   "out.");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return false;
  line.require("-database");
  line.requireFiles(1, std::numeric_limits<std::size_t>::max());
  o.files = line.files();
  checkLabels(o);
  checkLeaf(line, o);
  return true;
}

} // namespace apps
} // namespace pcl_surflet
