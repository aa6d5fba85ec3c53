#include "experiment/chapter3.h"
#include "experiment/collection.h"
#include "experiment/output.h"
#include "experiment/plots.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/model_search.h"
#include "pcl_surflet/recognition/retrieval_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief A figure of one collection. */
struct Figure {
  std::string name;
  CurvePoint value; ///< x: the recall in percent, of precisions
};

/** \brief For every model the classes of all others, the most similar first. */
std::vector<std::vector<std::string>>
rankings(const Collection& collection, unsigned threads)
{
  const ModelSearch search(collection.database);
  std::vector<std::vector<std::string>> ranked(search.size());
  parallelFor(ranked.size(), threads, [&](std::size_t i, unsigned) {
    const auto& query = collection.database[i].members.front().histogram;
    for (const auto& hit : search.searchAll(query, search.size()))
      if (hit.model != i)
        ranked[i].push_back(collection.classes[hit.model]);
  });
  return ranked;
}

/** \brief The figures of each class by itself: queries of one class are much alike, so classes, not
 * queries, are what the intervals may count. */
std::vector<RetrievalFigures>
figuresOfClasses(const Collection& collection, std::size_t members, unsigned threads)
{
  const auto ranked = rankings(collection, threads);
  std::vector<RetrievalFigures> all;
  for (auto first = ranked.begin(); first != ranked.end();) {
    const auto end = first + static_cast<std::ptrdiff_t>(members);
    const std::vector<std::string> own(members, collection.classes[all.size() * members]);
    all.push_back(retrievalFigures(own, {first, end}, std::vector<std::size_t>(members, members)));
    first = end;
  }
  return all;
}

/** \brief Mean of \p values with 1.96 standard errors on both sides, within [0, 1]. */
CurvePoint
meanOf(double x, const std::vector<double>& values)
{
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values)
    mean += v / n;
  for (const double v : values)
    squares += (v - mean) * (v - mean);
  const double error = n > 1 ? 1.96 * std::sqrt(squares / (n - 1) / n) : 1;
  return {x, mean, std::max(0.0, mean - error), std::min(1.0, mean + error)};
}

template <class Get>
Figure
figure(const std::string& name, double x, const std::vector<RetrievalFigures>& classes,
       const Get& get)
{
  std::vector<double> values;
  values.reserve(classes.size());
  for (const auto& c : classes)
    values.push_back(get(c));
  return {name, meanOf(x, values)};
}

std::vector<Figure>
figuresOf(const std::vector<RetrievalFigures>& classes)
{
  std::vector<Figure> all = {
      figure("nearest neighbour", 0, classes, [](const auto& f) { return f.nearest_neighbour; }),
      figure("first tier", 0, classes, [](const auto& f) { return f.first_tier; }),
      figure("second tier", 0, classes, [](const auto& f) { return f.second_tier; })};
  for (std::size_t i = 0; i < RetrievalFigures::kRecallLevels; ++i) {
    const double recall =
        100 * static_cast<double>(i + 1) / static_cast<double>(RetrievalFigures::kRecallLevels);
    all.push_back(figure(formatted("precision at recall %g %%", recall), recall, classes,
                         [i](const auto& f) { return f.precision[i]; }));
  }
  return all;
}

/** \brief Prints the figures and adds them to the table and the curves. */
void
report(double variety, const std::vector<Figure>& figures, std::string& csv,
       std::vector<Curve>& curves)
{
  std::printf("variety %g\n", variety);
  curves.push_back({formatted("variety %g", variety), {}});
  for (const auto& f : figures) {
    const CurvePoint& v = f.value;
    std::printf("  %-26s %5.1f (%.1f-%.1f)\n", f.name.c_str(), 100 * v.rate, 100 * v.low,
                100 * v.high);
    csv += number(variety) + ',' + csvField(f.name) + ',' + number(v.rate) + ',' + number(v.low) +
           ',' + number(v.high) + '\n';
    if (v.x > 0)
      curves.back().points.push_back(v);
  }
}

} // namespace

std::vector<std::string>
allLabels()
{
  auto all = experimentLabels();
  const auto others = namesIn(strangerNames());
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

int
runRetrieval(const ChapterOptions& options)
{
  const auto& o = options.rates;
  if (o.labels.size() < 2 || o.tests < 2)
    throw UsageError("retrieval needs two classes (-objects) of two models (-tests) at least");
  makeDirectory(o.out);
  const auto objects = loadObjects(o.meshes, o.labels);
  const auto threads = static_cast<unsigned>(o.threads);
  std::printf("Retrieval: %zu classes of %llu models of different size, every model a query, seed "
              "%llu; %% (95 %%, over the classes)\n",
              objects.size(), static_cast<unsigned long long>(o.tests),
              static_cast<unsigned long long>(o.seed));
  std::string csv = "variety,figure,value,low,high\n";
  std::vector<Curve> curves;
  for (const double variety : {0.1, 0.2, 0.4}) {
    const auto collection = withProgress<Collection>(objects.size(), [&](const auto& show) {
      return makeCollection(objects, {o.tests, variety, o.seed, threads}, show);
    });
    report(variety, figuresOf(figuresOfClasses(collection, o.tests, threads)), csv, curves);
    writeFile(o.out + "/retrieval.csv", csv);
  }
  std::printf("\nwrote %s/retrieval.csv\n", o.out.c_str());
  const auto no_picture = drawPanels(
      o.out, "retrieval",
      {{"Retrieval of models with classes", "recall in %", curves, {}, "precision in %"}}, 1);
  if (!no_picture.empty())
    complain("no picture: " + no_picture);
  return kOk;
}

} // namespace apps
} // namespace pcl_surflet
