// Trains models from files and keeps them in a database.

#include "app_common.h"
#include "file_lock.h"
#include "parallel/share_out.h"
#include "training/options.h"
#include "training/trained_file.h"

#include "pcl_surflet/database_file.h"

#include <filesystem>
#include <functional>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_train";

ModelDatabase
openDatabase(const TrainOptions& o)
{
  checkOutput(o.database);
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

/** \brief Puts the models of one file after the other into the database, which only the first rank
 * has. */
class Collector {
public:
  Collector(const TrainOptions& o, ModelDatabase& database, bool shows_progress)
      : o_(o), database_(database), progress_(shows_progress ? o.files.size() : 0)
  {
    showNext(0);
  }

  void
  take(std::size_t i, TrainedFile trained)
  {
    try {
      if (!trained.error.empty())
        throw DataError(trained.error);
      for (const auto& text : trained.notes)
        note(text);
      add(std::move(trained.model));
    }
    catch (const std::exception& error) {
      complain(std::string(kProgram) + ": " + about(o_.files[i], error.what()));
      ++failed_;
    }
    showNext(i + 1);
  }

  /** \brief Keeps the database, if there is anything new. \return exit code */
  int
  finish()
  {
    progress_.clear();
    if (failed_ < o_.files.size())
      saveDatabase(database_, o_.database);
    if (failed_ > 0)
      complain(std::string(kProgram) + ": " + std::to_string(failed_) + " of " +
               std::to_string(o_.files.size()) + " files could not be trained");
    return failed_ > 0 ? kBadData : kOk;
  }

private:
  void
  showNext(std::size_t i)
  {
    if (i < o_.files.size())
      progress_.show(i, o_.files[i]);
  }

  void
  add(HistogramModel model)
  {
    const std::string label = model.label;
    const std::uint64_t features = model.members.front().features;
    const std::size_t members = model.members.size();
    const bool replaced = database_.replace(std::move(model));
    note(std::string(replaced ? "replaced" : "added") + " '" + label + "' (" +
         (o_.background ? "background" : "object") + ", " + std::to_string(features) + " features" +
         (members > 1 ? ", " + std::to_string(members) + " members)" : ")"));
  }

  const TrainOptions& o_;
  ModelDatabase& database_;
  Progress progress_;
  std::size_t failed_ = 0;
};

/** \brief Many files go to whichever rank is free; files of very many pairs to all ranks at once.
 */
void
trainAll(const TrainOptions& o, Ranks& ranks,
         const std::function<void(std::size_t i, TrainedFile trained)>& take)
{
  if (ranks.size() == 1 || !pairsAreWorthSharing(o))
    return shareOut<TrainedFile>(
        ranks, o.files.size(), [&](std::size_t i) { return trainedFrom(o.files[i], o); }, take);
  for (std::size_t i = 0; i < o.files.size(); ++i) {
    TrainedFile trained = trainedTogether(o.files[i], o, ranks);
    if (ranks.isFirst())
      take(i, std::move(trained));
  }
}

int
train(int argc, char** argv, Ranks& ranks)
{
  TrainOptions o;
  ModelDatabase database;
  bool help = false;
  ranks.together([&] {
    help = !readTrainOptions(kProgram, argc, argv, o);
    if (!help && ranks.isFirst())
      database = openDatabase(o);
  });
  if (help)
    return kOk;
  o.threads = ranks.threads(o.threads);
  Collector collector(o, database, ranks.isFirst());
  trainAll(o, ranks,
           [&](std::size_t i, TrainedFile trained) { collector.take(i, std::move(trained)); });
  int code = kOk;
  ranks.together([&] {
    if (ranks.isFirst())
      code = collector.finish();
  });
  return code;
}

} // namespace

int
main(int argc, char** argv)
{
  return runOnRanks(kProgram, argc, argv, [&](Ranks& ranks) { return train(argc, argv, ranks); });
}
