// Trains models from files and keeps them in a database.

#include "app_common.h"
#include "file_lock.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/surface_file.h"
#include "pcl_surflet/view_training.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include <unistd.h>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_train";

struct Options {
  std::string database, label;
  bool background = false;
  Resolution resolution;
  ModelBank bank = ModelBank::none();
  double leaf = 0;
  bool views = false;
  std::uint64_t pairs = 10000000, seed = 1, threads = 0, neighbours = 0;
  std::vector<std::string> files;
};

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
checkLeaf(const CommandLine& line, const Options& o)
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
  std::ifstream file(name);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw DataError("cannot read the bank '" + name +
                    "': give default, none, or the path of a text file that is not empty");
  try {
    return ModelBank::parse(text.str());
  }
  catch (const ModelBankError& error) {
    throw DataError("'" + name + "': " + error.what());
  }
}

/** \brief Every file must give a model of its own. */
void
checkLabels(const Options& o)
{
  if (!o.label.empty() && o.files.size() > 1)
    throw UsageError("option -label names one model, but " + std::to_string(o.files.size()) +
                     " files are given; train them one by one");
  if (o.label.size() > HistogramModel::kMaxLabelBytes)
    throw UsageError("option -label: longer than 63 bytes");
  std::map<std::string, std::string> seen;
  for (const auto& file : o.files)
    if (const auto [at, is_new] = seen.try_emplace(stemOf(file), file); !is_new)
      throw UsageError("'" + at->second + "' and '" + file + "' would both be labelled '" +
                       at->first + "'; train them one by one with option -label");
}

void
addOptions(CommandLine& line, Options& o)
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
  addNeighbours(line, o.neighbours);
}

/** \return false if help was asked for */
bool
readOptions(int argc, char** argv, Options& o)
{
  CommandLine line(kProgram, "FILE...",
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

/** \brief Training may take long: better to know before it whether the result can be kept. */
void
checkDirectory(const std::string& database)
{
  const auto directory = std::filesystem::absolute(database).parent_path();
  if (::access(directory.c_str(), W_OK) != 0)
    throw DataError("cannot write the database '" + database + "': " + std::strerror(errno) +
                    "; check its directory and the permissions");
}

ModelDatabase
openDatabase(const Options& o)
{
  checkDirectory(o.database);
  lockUntilExit(o.database); // two trainings at once would lose models
  if (!std::filesystem::exists(std::filesystem::symlink_status(o.database)))
    return {};
  ModelDatabase database = readDatabase(o.database);
  if (database.resolution() != o.resolution)
    throw DataError("the database '" + o.database + "' has the resolution " +
                    database.resolution().toString() + ", not " + o.resolution.toString() +
                    "; give -bins " + database.resolution().toString() + " or another database");
  return database;
}

HistogramModelTrainer
trainerFor(const Options& o)
{
  HistogramModelTrainer trainer;
  trainer.setResolution(o.resolution);
  trainer.setNumberOfPairs(o.pairs);
  trainer.setSeed(o.seed);
  trainer.setNumberOfThreads(static_cast<unsigned>(o.threads));
  trainer.setRole(o.background ? ModelRole::Background : ModelRole::Object);
  return trainer;
}

/** \brief Says what of the file was not used as it is. */
void
noteLosses(const Options& o, const std::string& path, const SurfaceFile& file)
{
  if (file.rejected > 0)
    note(path + ": " + std::to_string(file.rejected) +
         " points left out (not finite or without usable normal)");
  if (!file.mesh && o.leaf == 0 && surfaceDensity(file.surflets).contrast >= kUnevenContrast)
    note(path + ": uneven density evened out, one mean surflet per cell");
}

/** \brief About as many surflets as give every cell that the mesh meets several.
 * \throws DataError if there would be too many */
std::size_t
surfletsFor(const TriangleMesh& mesh, double leaf)
{
  constexpr double kPerSquare = 16; // of an edge: a dozen a cell
  constexpr double kFewest = 1000, kMost = 10000000;
  const double wanted = kPerSquare * surfaceArea(mesh) / (leaf * leaf);
  if (wanted > kMost)
    throw DataError("its surface has more than " + number(kMost / kPerSquare) +
                    " cells of that edge; give a larger -leaf in the unit of the mesh");
  return static_cast<std::size_t>(std::max(wanted, kFewest));
}

HistogramModel
modelOf(const Options& o, const std::string& label, const SurfaceFile& file)
{
  if (o.views) {
    if (!file.mesh)
      throw DataError("'" + label + "': option -views needs a mesh, not points");
    const SceneItem item = sceneItem(label, *file.mesh);
    return trainForSensors(trainerFor(o), item, sensingFor(item, o.leaf), o.leaf, o.seed,
                           static_cast<unsigned>(o.threads));
  }
  if (o.leaf > 0) {
    const std::size_t wanted = file.mesh ? surfletsFor(*file.mesh, o.leaf) : 0;
    return trainForScenes(trainerFor(o), label, surfletsOf(file, wanted, o.seed), o.leaf, o.seed,
                          static_cast<unsigned>(o.threads));
  }
  const ModelBankTrainer trainer(trainerFor(o), o.bank);
  return file.mesh ? trainer.train(label, *file.mesh) : trainer.train(label, file.surflets);
}

void
trainFile(const Options& o, const std::string& path, ModelDatabase& database)
{
  SurfaceFileOptions loading;
  loading.estimate_normals = static_cast<int>(o.neighbours);
  loading.threads = static_cast<unsigned>(o.threads);
  const SurfaceFile file = loadSurface(path, loading);
  const std::string label = o.label.empty() ? stemOf(path) : o.label;
  if (label.size() > HistogramModel::kMaxLabelBytes)
    throw DataError("'" + path + "': its name is longer than the 63 bytes of a label; give -label");
  HistogramModel model = modelOf(o, label, file);
  noteLosses(o, path, file);
  const std::uint64_t features = model.members.front().features;
  const std::size_t members = model.members.size();
  const bool replaced = database.replace(std::move(model));
  note(std::string(replaced ? "replaced" : "added") + " '" + label + "' (" +
       (o.background ? "background" : "object") + ", " + std::to_string(features) + " features" +
       (members > 1 ? ", " + std::to_string(members) + " members)" : ")"));
}

int
train(int argc, char** argv)
{
  Options o;
  if (!readOptions(argc, argv, o))
    return kOk;
  ModelDatabase database = openDatabase(o);
  Progress progress(o.files.size());
  std::size_t failed = 0;
  for (std::size_t i = 0; i < o.files.size(); ++i) {
    progress.show(i, o.files[i]);
    try {
      trainFile(o, o.files[i], database);
    }
    catch (const std::exception& error) {
      complain(std::string(kProgram) + ": " + about(o.files[i], error.what()));
      ++failed;
    }
  }
  if (failed < o.files.size())
    saveDatabase(database, o.database);
  if (failed > 0)
    complain(std::string(kProgram) + ": " + std::to_string(failed) + " of " +
             std::to_string(o.files.size()) + " files could not be trained");
  return failed > 0 ? kBadData : kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return train(argc, argv); });
}
