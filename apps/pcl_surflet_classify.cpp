// Says which models of a database files look like.

#include "queries.h"

#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/recognition/histogram_classifier.h"

#include <algorithm>
#include <iostream>
#include <limits>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_classify";
constexpr const char* kColumns = "file,answer,rank,label,score,posterior,surprise,condition,misfit";

struct Options : QueryOptions {
  Criterion criterion = Criterion::Likelihood;
  double unknown = 0;
  bool has_unknown = false, calibrated = false, scale_normalized = false;
  std::vector<std::string> files;
};

/** \brief What became of one file. */
struct Answer {
  Classification classification;
  std::string error; ///< empty if it could be classified
};

std::string
criterionNames()
{
  std::string names;
  for (const auto criterion : allCriteria())
    names += (names.empty() ? "" : ", ") + std::string(criterionName(criterion));
  return names;
}

void
addOptions(CommandLine& line, Options& o)
{
  constexpr double kLargest = std::numeric_limits<double>::max();
  addQueryOptions(line, kColumns, o);
  line.option("-criterion", "NAME", criterionNames() + "; default likelihood",
              [&o](const std::string& name) {
                const auto criterion = criterionByName(name);
                if (!criterion)
                  throw UsageError("option -criterion: '" + name + "' is none of " +
                                   criterionNames());
                o.criterion = *criterion;
              });
  line.option("-unknown", "auto|T",
              "auto: reject what fits worse than 97.5 % of the training samples (needs models of a "
              "bank); T: worst accepted value, surprise in nats (likelihood) or score; default: "
              "nothing is rejected",
              [&o](const std::string& value) {
                o.calibrated = value == "auto";
                o.has_unknown = !o.calibrated;
                if (o.has_unknown)
                  o.unknown = parseReal("-unknown", value, -kLargest, kLargest);
              });
  line.flag("-scale_normalized", "compare shapes regardless of size", o.scale_normalized);
}

/** \return false if help was asked for */
bool
readOptions(int argc, char** argv, Options& o)
{
  CommandLine line(kProgram, "FILE...",
                   "Classifies files (PCD, PLY, OBJ, STL, OFF) against the models of a database "
                   "and lists\nthe best ones with score, posterior probability, surprise and the "
                   "condition that the model was\ntrained under (of the winner an estimate of the "
                   "file's noise and missing parts); the answer is\n'unknown' where no model is "
                   "similar enough (see -unknown).");
  addOptions(line, o);
  if (!line.parse(argc, argv))
    return false;
  line.require("-database");
  line.requireFiles(1, std::numeric_limits<std::size_t>::max());
  o.files = line.files();
  return true;
}

HistogramClassifier
classifierFor(const Options& o, const ModelDatabase& database)
{
  HistogramClassifier classifier(database);
  classifier.setCriterion(o.criterion);
  classifier.setNumberOfFeatures(o.features);
  classifier.setSeed(o.seed);
  classifier.setScaleNormalized(o.scale_normalized);
  if (o.has_unknown)
    classifier.setUnknownThreshold(o.unknown);
  if (!o.calibrated)
    return classifier;
  const auto limit = classifier.calibratedMisfitLimit();
  if (!limit)
    throw DataError("'" + o.database +
                    "' has no model trained in a bank, which -unknown auto needs; train with -bank "
                    "default, or give -unknown a number");
  classifier.setMisfitLimit(limit);
  return classifier;
}

Answer
answerTo(const Options& o, const HistogramClassifier& classifier, const std::string& path)
{
  Answer answer;
  try {
    const SurfletSet query = queryFrom(path, o, 1); // files are spread over the threads
    answer.classification = classifier.classify(query);
    if (answer.classification.ranking.empty())
      refuseQueryWithoutPairs();
  }
  catch (const std::exception& error) {
    answer.error = error.what();
  }
  return answer;
}

void
printText(const Options& o, const std::string& path, const Classification& c)
{
  const ModelMatch* best = c.best();
  std::cout << path << ": " << (best != nullptr ? best->label : "unknown") << "\n";
  for (std::size_t r = 0; r < std::min<std::size_t>(o.top, c.ranking.size()); ++r) {
    const ModelMatch& m = c.ranking[r];
    std::cout << "  " << r + 1 << " " << m.label << "  score " << number(m.score) << "  posterior "
              << number(m.posterior) << "  surprise " << number(m.surprise) << "  as "
              << (m.condition.empty() ? "trained" : m.condition) << "\n";
  }
}

void
printCsv(const Options& o, const std::string& path, const Classification& c)
{
  const ModelMatch* best = c.best();
  const std::string begin =
      csvField(path) + "," + csvField(best != nullptr ? best->label : "unknown") + ",";
  for (std::size_t r = 0; r < std::min<std::size_t>(o.top, c.ranking.size()); ++r) {
    const ModelMatch& m = c.ranking[r];
    std::cout << begin << r + 1 << "," << csvField(m.label) << "," << number(m.score) << ","
              << number(m.posterior) << "," << number(m.surprise) << "," << csvField(m.condition)
              << "," << number(m.relative_misfit) << "\n";
  }
}

/** \brief Prints one answer. \return false if there was none */
bool
report(const Options& o, const std::string& path, const Answer& answer)
{
  if (!answer.error.empty()) {
    complain(std::string(kProgram) + ": " + about(path, answer.error));
    return false;
  }
  if (o.csv)
    printCsv(o, path, answer.classification);
  else
    printText(o, path, answer.classification);
  return true;
}

int
classify(int argc, char** argv)
{
  Options o;
  if (!readOptions(argc, argv, o))
    return kOk;
  const ModelDatabase database = readDatabase(o.database);
  const HistogramClassifier classifier = classifierFor(o, database);
  const unsigned threads = resolveThreads(static_cast<unsigned>(o.threads));
  if (o.csv)
    std::cout << kColumns << "\n";
  Progress progress(o.files.size());
  std::size_t failed = 0;
  // A few files at a time: answers come in order and soon, and memory stays bounded.
  const std::size_t chunk = 4 * std::size_t{threads};
  for (std::size_t first = 0; first < o.files.size(); first += chunk) {
    progress.show(first, o.files[first]);
    std::vector<Answer> answers(std::min(chunk, o.files.size() - first));
    parallelFor(answers.size(), threads, [&](std::size_t i, unsigned) {
      answers[i] = answerTo(o, classifier, o.files[first + i]);
    });
    progress.clear();
    for (std::size_t i = 0; i < answers.size(); ++i)
      failed += !report(o, o.files[first + i], answers[i]);
    std::cout.flush();
  }
  if (failed > 0)
    complain(std::string(kProgram) + ": " + std::to_string(failed) + " of " +
             std::to_string(o.files.size()) + " files could not be classified");
  return failed > 0 ? kBadData : kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return classify(argc, argv); });
}
