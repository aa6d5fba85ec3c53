// Compares the library with the results of an independent double-precision implementation, given as
// CSV files in a directory. Not part of the plain test run: it needs those files.

#include "pcl_surflet/core/geometry.h"
#include "pcl_surflet/core/instruction_set.h"
#include "pcl_surflet/core/pair_counting.h"
#include "pcl_surflet/core/similarity.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace pcl_surflet;

namespace {

using Table = std::vector<std::vector<std::string>>;

int failures = 0;

void
check(bool good, const std::string& what)
{
  if (good)
    return;
  ++failures;
  std::fprintf(stderr, "FAILED: %s\n", what.c_str());
}

void
checkNear(double value, double expected, double tolerance, const std::string& what)
{
  check(std::abs(value - expected) <= tolerance * std::max(1.0, std::abs(expected)),
        what + ": " + std::to_string(value) + " instead of " + std::to_string(expected));
}

Table
read(const std::string& path)
{
  Table table;
  std::ifstream in(path);
  check(static_cast<bool>(in), "cannot read " + path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    table.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');)
      table.back().push_back(cell);
  }
  return table;
}

Surflet
surfletAt(const std::vector<std::string>& row, std::size_t first)
{
  const auto at = [&](std::size_t k) { return std::stof(row[first + k]); };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

/** \brief Bin by the counting kernels, -1 for a rejected pair. */
int
kernelBin(const Surflet& a, const Surflet& b, double delta_max)
{
  SurfletSet two;
  two.push_back(a);
  two.push_back(b);
  const auto h = countAllPairs(PairSource(two), {}, delta_max, 1);
  for (std::size_t k = 0; k < h.counts.size(); ++k)
    if (h.counts[k] > 0)
      return static_cast<int>(k);
  return -1;
}

void
checkPairs(const std::string& directory)
{
  const auto table = read(directory + "/pairs.csv");
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto& row = table[i];
    const std::string where = "pairs.csv row " + std::to_string(i);
    const Surflet a = surfletAt(row, 0), b = surfletAt(row, 6);
    const auto f = computePairFeature(a, b);
    const bool valid = row[12] == "1";
    check(f.has_value() == valid, where + " valid");
    if (!f || !valid)
      continue;
    checkNear(std::remainder(f->alpha - std::stod(row[13]), 2 * M_PI), 0, 1e-5, where + " alpha");
    checkNear(f->beta, std::stod(row[14]), 1e-5, where + " beta");
    checkNear(f->gamma, std::stod(row[15]), 1e-5, where + " gamma");
    checkNear(f->delta, std::stod(row[16]), 1e-5, where + " delta");
    const bool near_edge = row[18] == "1";
    check(near_edge || binIndex(*f, {}, 2.0) == std::stoi(row[17]), where + " bin");
    check(near_edge || kernelBin(a, b, 2.0) == std::stoi(row[17]), where + " bin of the kernel");
  }
  std::printf("pairs.csv: %zu pairs\n", table.size() - 1);
}

void
checkCloud(const std::string& directory)
{
  SurfletSet set;
  const auto cloud = read(directory + "/cloud.csv");
  for (std::size_t i = 1; i < cloud.size(); ++i)
    set.push_back(surfletAt(cloud[i], 0));
  std::map<std::size_t, std::uint64_t> expected;
  const auto histogram = read(directory + "/cloud_histogram_5555_dmax2.2.csv");
  for (std::size_t i = 1; i < histogram.size(); ++i)
    expected[std::stoul(histogram[i][0])] = std::stoull(histogram[i][1]);
  const auto h = countAllPairs(PairSource(set), {}, 2.2);
  for (std::size_t b = 0; b < h.counts.size(); ++b)
    check(h.counts[b] == (expected.count(b) ? expected[b] : 0),
          "cloud histogram bin " + std::to_string(b));
  const auto model = read(directory + "/cloud_model.csv")[1];
  const Extent e = computeExtent(set);
  checkNear(farthestDistance(set), std::stod(model[0]), 1e-6, "delta_max");
  checkNear(e.r_mean, std::stod(model[1]), 1e-6, "r_mean");
  checkNear(e.r_max, std::stod(model[2]), 1e-6, "r_max");
  checkNear(e.r_min, std::stod(model[3]), 1e-6, "r_min");
  check(h.features + h.rejected == std::stoull(model[4]), "number of pairs");
  std::printf("cloud.csv: %zu surflets, %llu features\n", set.size(),
              static_cast<unsigned long long>(h.features));
}

Histogram
numbers(const std::vector<std::string>& row)
{
  Histogram values;
  for (std::size_t i = 1; i < row.size(); ++i)
    values.push_back(std::stod(row[i]));
  return values;
}

void
checkCriteria(const std::string& directory)
{
  const auto table = read(directory + "/criteria.csv");
  std::vector<Histogram> models, penalised;
  Histogram query, log_h;
  double smallest = 1;
  for (const auto& row : table) {
    if (row.empty())
      continue;
    if (row[0].rfind("model", 0) == 0 && row[0] != "model") {
      models.push_back(numbers(row));
      smallest = std::min(smallest, smallestPositive(models.back()));
    }
    else if (row[0].rfind("penalised", 0) == 0)
      penalised.push_back(numbers(row));
    else if (row[0] == "query_counts")
      query = numbers(row);
  }
  double features = 0;
  for (const double c : query)
    features += c;
  for (double& c : query)
    c /= features;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const auto h = penalize(models[m], 0.5 * smallest);
    const std::string where = "criteria model " + std::to_string(m);
    for (std::size_t b = 0; b < h.size(); ++b)
      check(std::abs(h[b] - penalised[m][b]) < 1e-9, where + " penalty bin " + std::to_string(b));
    log_h = h;
    double log_sum = 0;
    for (double& v : log_h)
      log_sum += v = std::log(v);
    const auto expected = numbers(table[table.size() - models.size() + m]);
    const double likelihood = meanLogLikelihood(log_h, query);
    const double values[] = {squaredEuclidean(h, query),
                             intersection(h, query),
                             chiSquared1(h, query),
                             chiSquared2(h, query),
                             likelihood,
                             likelihood * features / log_sum};
    for (std::size_t k = 0; k < 6; ++k)
      checkNear(values[k], expected[k], 1e-6, where + " criterion " + std::to_string(k));
  }
  std::printf("criteria.csv: %zu models\n", models.size());
}

} // namespace

int
main(int argc, char** argv)
{
  if (argc != 2) {
    std::fprintf(stderr, "usage: check_vectors DIRECTORY\n");
    return 1;
  }
  for (const auto set : {InstructionSet::Scalar, InstructionSet::Baseline, InstructionSet::Avx2,
                         InstructionSet::Avx512}) {
    if (!selectInstructionSet(set))
      continue;
    std::printf("%s\n", activeInstructionSet());
    checkPairs(argv[1]);
    checkCloud(argv[1]);
  }
  checkCriteria(argv[1]);
  std::printf("%d failures\n", failures);
  return failures == 0 ? 0 : 2;
}
