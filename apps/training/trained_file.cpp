#include "training/trained_file.h"

#include "parallel/packing.h"
#include "surfaces.h"

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/model_bank_trainer.h"
#include "pcl_surflet/recognition/scene_training.h"
#include "pcl_surflet/view_training.h"

#include <algorithm>

namespace pcl_surflet {
namespace apps {
namespace {

HistogramModelTrainer
trainerFor(const TrainOptions& o)
{
  HistogramModelTrainer trainer;
  trainer.setResolution(o.resolution);
  trainer.setNumberOfPairs(o.pairs);
  trainer.setSeed(o.seed);
  trainer.setNumberOfThreads(static_cast<unsigned>(o.threads));
  trainer.setRole(o.background ? ModelRole::Background : ModelRole::Object);
  return trainer;
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
modelOf(const HistogramModelTrainer& trainer, const std::string& label, const SurfaceFile& file,
        const TrainOptions& o)
{
  const auto threads = static_cast<unsigned>(o.threads);
  if (o.views) {
    if (!file.mesh)
      throw DataError("'" + label + "': option -views needs a mesh, not points");
    const SceneItem item = sceneItem(label, *file.mesh);
    SceneSensing sensing = sensingFor(item, o.leaf);
    sensing.threads = threads;
    return trainForSensors(trainer, item, sensing, o.leaf, o.seed, threads);
  }
  if (o.leaf > 0) {
    const std::size_t wanted = file.mesh ? surfletsFor(*file.mesh, o.leaf) : 0;
    return trainForScenes(trainer, label, surfletsOf(file, wanted, o.seed), o.leaf, o.seed,
                          threads);
  }
  const ModelBankTrainer banks(trainer, o.bank);
  return file.mesh ? banks.train(label, *file.mesh) : banks.train(label, file.surflets);
}

std::vector<std::string>
notesOn(const std::string& path, const SurfaceFile& file, const TrainOptions& o)
{
  std::vector<std::string> notes;
  if (file.rejected > 0)
    notes.push_back(losses(path, file));
  if (!file.mesh && o.leaf == 0 && surfaceDensity(file.surflets).contrast >= kUnevenContrast)
    notes.push_back(path + ": uneven density evened out, one mean surflet per cell");
  return notes;
}

TrainedFile
trainedOn(const HistogramModelTrainer& trainer, const std::string& path, const SurfaceFile& file,
          const TrainOptions& o)
{
  const std::string label = o.label.empty() ? stemOf(path) : o.label;
  return {modelOf(trainer, label, file, o), notesOn(path, file, o), ""};
}

TrainedFile
failed(const std::string& error)
{
  return {{}, {}, error};
}

/** \brief The file, and an error message unless it can be trained from. */
std::pair<SurfaceFile, std::string>
fileOrError(const std::string& path, const TrainOptions& o)
{
  try {
    if (o.label.empty() && stemOf(path).size() > HistogramModel::kMaxLabelBytes)
      throw DataError("'" + path +
                      "': its name is longer than the 63 bytes of a label; give -label");
    return {readSurface(path, o.normals, o.threads), ""};
  }
  catch (const std::exception& error) {
    return {SurfaceFile(), error.what()};
  }
}

} // namespace

TrainedFile
trainedFrom(const std::string& path, const TrainOptions& o)
{
  const auto [file, error] = fileOrError(path, o);
  if (!error.empty())
    return failed(error);
  try {
    return trainedOn(trainerFor(o), path, file, o);
  }
  catch (const std::exception& problem) {
    return failed(problem.what());
  }
}

bool
pairsAreWorthSharing(const TrainOptions& o)
{
  constexpr std::uint64_t kSecondsOfWork = 1000000000;
  return o.pairs >= kSecondsOfWork && o.bank.conditions.empty();
}

TrainedFile
trainedTogether(const std::string& path, const TrainOptions& o, Ranks& ranks)
{
  std::pair<SurfaceFile, std::string> read;
  if (ranks.isFirst())
    read = fileOrError(path, o);
  read = unpacked<decltype(read)>(ranks.fromFirst(ranks.isFirst() ? packed(read) : Bytes()));
  if (!read.second.empty())
    return failed(read.second);
  HistogramModelTrainer trainer = trainerFor(o);
  trainer.setPairShare(
      {static_cast<std::size_t>(ranks.rank()), static_cast<std::size_t>(ranks.size())},
      [&ranks](const PairHistogram& own) { return ranks.sum(own); });
  try {
    return trainedOn(trainer, path, read.first, o);
  }
  catch (const TrainingError& error) { // all ranks meet it, as they have the same file
    return failed(error.what());
  }
}

} // namespace apps
} // namespace pcl_surflet
