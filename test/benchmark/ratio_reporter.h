/** \file
 * Google Benchmark with ratios: every benchmark named "group/..." is compared with the peer of its
 * group, "group/peer...", measured in the same run with interleaved repetitions. */
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace pcl_surflet_benchmark {

/** \brief Collects the time per item of every repetition and prints ratios of medians at the end.
 */
class RatioReporter : public benchmark::ConsoleReporter {
public:
  void
  ReportRuns(const std::vector<Run>& runs) override
  {
    for (const auto& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred)
        continue;
      const auto items = run.counters.find("items_per_second");
      const double seconds = items != run.counters.end()
                                 ? 1 / items->second.value
                                 : run.cpu_accumulated_time / static_cast<double>(run.iterations);
      auto name = run.run_name.function_name;
      if (!run.run_name.args.empty())
        name += "/" + run.run_name.args;
      if (times_.find(name) == times_.end())
        order_.push_back(name);
      times_[name].push_back(seconds);
    }
  }

  void
  Finalize() override
  {
    std::printf("\n%-58s %12s %10s\n", "benchmark (median of repetitions, CPU time per item)", "ns",
                "peer/this");
    for (const auto& name : order_) {
      const double peer = peerOf(name);
      std::printf("%-58s %12.2f ", name.c_str(), 1e9 * median(name));
      if (peer > 0)
        std::printf("%10.2f\n", peer / median(name));
      else
        std::printf("%10s\n", "-");
    }
  }

private:
  double
  median(const std::string& name) const
  {
    auto t = times_.at(name);
    std::nth_element(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2), t.end());
    return t[t.size() / 2];
  }

  /** \brief Median of the fastest benchmark "group/peer..." of the same group, 0 without one. */
  double
  peerOf(const std::string& name) const
  {
    const std::string prefix = name.substr(0, name.find('/')) + "/peer";
    double best = 0;
    for (const auto& other : order_)
      if (other.compare(0, prefix.size(), prefix) == 0)
        best = best == 0 ? median(other) : std::min(best, median(other));
    return best;
  }

  std::map<std::string, std::vector<double>> times_;
  std::vector<std::string> order_;
};

/** \brief Runs all registered benchmarks with 9 interleaved repetitions unless told otherwise. */
inline int
runWithRatios(int argc, char** argv)
{
  std::vector<char*> arguments(argv, argv + argc);
  char repetitions[] = "--benchmark_repetitions=9";
  char interleaving[] = "--benchmark_enable_random_interleaving=true";
  char min_time[] = "--benchmark_min_time=0.05";
  arguments.insert(arguments.begin() + 1, {repetitions, interleaving, min_time});
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data()))
    return 1;
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}

} // namespace pcl_surflet_benchmark
