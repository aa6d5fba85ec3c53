// Finds the models of a large collection that resemble a file, and scores collections with classes.

#include "queries.h"

#include "pcl_surflet/model_search.h"
#include "pcl_surflet/recognition/retrieval_figures.h"

#include <iostream>
#include <limits>
#include <map>
#include <sstream>

using namespace pcl_surflet;
using namespace pcl_surflet::apps;

namespace {

constexpr const char* kProgram = "pcl_surflet_search";

struct Options : QueryOptions {
  Options() { top = 10; }

  std::string classes;
  std::uint64_t shortlist = 0;
  bool exhaustive = false;
  std::vector<std::string> files;
};

/** \return false if help was asked for */
bool
readOptions(int argc, char** argv, Options& o)
{
  CommandLine line(kProgram, "FILE...",
                   "Lists the models of a database that resemble files (PCD, PLY, OBJ, STL, OFF) "
                   "most,\nregardless of size; or, with -classes, takes every model as a query and "
                   "prints\nnearest-neighbour, first-tier and second-tier rates and the precision "
                   "over the recall.");
  addQueryOptions(line, "file,rank,label,score", o);
  line.text("-classes", "FILE.csv", "score the collection: a table of label,class per line",
            o.classes);
  line.count("-shortlist", "N", "histograms compared by likelihood, default 100", o.shortlist, 1,
             100000000);
  line.flag("-exhaustive", "compare with every model, without index", o.exhaustive);
  if (!line.parse(argc, argv))
    return false;
  line.require("-database");
  if (o.exhaustive && line.given("-shortlist"))
    throw UsageError("option -shortlist: does not go with -exhaustive, which compares with all");
  line.requireFiles(o.classes.empty() ? 1 : 0,
                    o.classes.empty() ? std::numeric_limits<std::size_t>::max() : 0);
  o.files = line.files();
  return true;
}

ModelSearch
searchFor(const Options& o, const ModelDatabase& database)
{
  ModelSearch search(database);
  search.setNumberOfFeatures(o.features);
  search.setSeed(o.seed);
  if (o.shortlist > 0)
    search.setShortlist(o.shortlist);
  return search;
}

void
searchFile(const Options& o, const ModelSearch& search, const std::string& path)
{
  const SurfletSet query = queryFrom(path, o, o.threads);
  const auto hits = o.exhaustive ? search.searchAll(query, o.top) : search.search(query, o.top);
  if (hits.empty())
    refuseQueryWithoutPairs();
  if (!o.csv)
    std::cout << path << ":\n";
  for (std::size_t r = 0; r < hits.size(); ++r)
    if (o.csv)
      std::cout << csvField(path) << "," << r + 1 << "," << csvField(hits[r].label) << ","
                << number(hits[r].score) << "\n";
    else
      std::cout << "  " << r + 1 << " " << hits[r].label << "  score " << number(hits[r].score)
                << "\n";
}

/** \brief Class of every label. */
std::map<std::string, std::string>
readClasses(const std::string& path)
{
  std::istringstream file(readTextFile(path));
  std::map<std::string, std::string> classes;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    if (line.empty())
      continue;
    const auto comma = line.rfind(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == line.size())
      throw DataError("'" + path + "', line " + std::to_string(number) +
                      ": not a label and a class with a comma between them");
    classes[line.substr(0, comma)] = line.substr(comma + 1);
  }
  return classes;
}

/** \brief The class of every model, in order. */
std::vector<std::string>
classesOf(const ModelDatabase& database, const std::string& path)
{
  const auto classes = readClasses(path);
  std::vector<std::string> all;
  for (std::size_t i = 0; i < database.size(); ++i) {
    const auto at = classes.find(database[i].label);
    if (at == classes.end())
      throw DataError("'" + path + "' has no class for the model '" + database[i].label +
                      "'; add a line");
    all.push_back(at->second);
  }
  return all;
}

void
printFigures(const RetrievalFigures& figures)
{
  std::cout << "figure,value\nqueries," << figures.queries << "\nnearest neighbour,"
            << number(figures.nearest_neighbour) << "\nfirst tier," << number(figures.first_tier)
            << "\nsecond tier," << number(figures.second_tier) << "\n";
  for (std::size_t i = 0; i < figures.precision.size(); ++i)
    std::cout << "precision at recall " << number(static_cast<double>(i + 1) / 10.0) << ","
              << number(figures.precision[i]) << "\n";
}

/** \brief Every model's first histogram searches the whole collection, itself left out. */
void
scoreCollection(const Options& o, const ModelDatabase& database, const ModelSearch& search)
{
  const auto classes = classesOf(database, o.classes);
  std::map<std::string, std::size_t> sizes;
  for (const auto& name : classes)
    ++sizes[name];
  std::vector<std::vector<std::string>> ranked(classes.size());
  std::vector<std::size_t> class_sizes;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    class_sizes.push_back(sizes[classes[i]]);
    for (const auto& hit : search.searchAll(database[i].members.front().histogram, classes.size()))
      if (hit.model != i)
        ranked[i].push_back(classes[hit.model]);
  }
  const auto figures = retrievalFigures(classes, ranked, class_sizes);
  if (figures.queries == 0)
    throw DataError("'" + o.classes + "': no class has two models; there is nothing to score");
  printFigures(figures);
}

int
searchFiles(const Options& o, const ModelSearch& search)
{
  if (o.csv)
    std::cout << "file,rank,label,score\n";
  std::size_t failed = 0;
  for (const auto& path : o.files) {
    try {
      searchFile(o, search, path);
    }
    catch (const std::exception& error) {
      complain(std::string(kProgram) + ": " + about(path, error.what()));
      ++failed;
    }
  }
  return failed > 0 ? kBadData : kOk;
}

int
search(int argc, char** argv)
{
  Options o;
  if (!readOptions(argc, argv, o))
    return kOk;
  const ModelDatabase database = readDatabase(o.database);
  const ModelSearch index = searchFor(o, database);
  if (o.classes.empty())
    return searchFiles(o, index);
  scoreCollection(o, database, index);
  return kOk;
}

} // namespace

int
main(int argc, char** argv)
{
  return runMain(kProgram, [&] { return search(argc, argv); });
}
