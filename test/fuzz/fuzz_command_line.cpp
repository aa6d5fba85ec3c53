// The option parser of the apps with an option of every kind: it takes a line or throws UsageError
// naming the option, and what it takes lies in the range.
#include "app_common.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>

using namespace pcl_surflet::apps;

namespace {

/** \brief Words of the input, parted by NUL; the first byte is left to other uses. */
std::vector<std::string>
wordsOf(const std::uint8_t* data, std::size_t size)
{
  std::vector<std::string> words = {"program"};
  for (std::size_t begin = 1; begin < size;) {
    std::size_t end = begin;
    while (end < size && data[end] != 0)
      ++end;
    words.emplace_back(data + begin, data + end);
    begin = end + 1;
  }
  return words;
}

bool
isUsable(const MissingNormals& normals)
{
  const auto isFinite = [](double v) { return std::isfinite(v); };
  return (normals.neighbours == 0 || normals.neighbours >= 3) &&
         (!normals.sensor || std::all_of(normals.sensor->begin(), normals.sensor->end(), isFinite));
}

} // namespace

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  auto words = wordsOf(data, size);
  std::vector<char*> argv;
  for (auto& word : words)
    argv.push_back(word.data());
  bool flag = false;
  std::uint64_t count = 5, seed = 1, threads = 0;
  MissingNormals normals;
  double real = 0.5;
  std::string text = "x";
  CommandLine line("program", "FILE...", "For the fuzzer.");
  line.flag("-flag", "a flag", flag);
  line.count("-count", "N", "a number", count, 1, 1000);
  line.real("-real", "R", "a number", real, -1, 1e30);
  line.text("-text", "T", "a text", text);
  addSeed(line, seed);
  addThreads(line, threads);
  addMissingNormals(line, normals);
  std::cout.setstate(std::ios::failbit); // the help is long
  try {
    line.parse(static_cast<int>(argv.size()), argv.data());
    line.requireFiles(0, 3);
    line.require("-text");
  }
  catch (const UsageError& error) {
    if (error.what()[0] == '\0')
      std::abort();
  }
  if (count < 1 || count > 1000 || !(real >= -1 && real <= 1e30) || text.empty() ||
      threads > 1024 || !isUsable(normals) || line.files().size() > words.size())
    std::abort();
  return 0;
}
