// Runs a fuzzer without libFuzzer: the files of a directory, cut short and with a few bytes
// changed, the same ones every time. So fuzzers are compiled and their seeds are read with every
// change.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kCuts = 64;
constexpr int kChanged = 400;

Bytes
contentOf(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void
replay(const Bytes& seed)
{
  LLVMFuzzerTestOneInput(seed.data(), seed.size());
  for (std::size_t k = 0; k < kCuts; ++k)
    LLVMFuzzerTestOneInput(seed.data(), seed.size() * k / kCuts);
  std::mt19937 random(static_cast<std::uint32_t>(seed.size()));
  for (int k = 0; k < kChanged && !seed.empty(); ++k) {
    Bytes changed = seed;
    for (std::uint32_t bytes = 1 + random() % 4; bytes > 0; --bytes)
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random() % 256);
    LLVMFuzzerTestOneInput(changed.data(), changed.size());
  }
}

} // namespace

int
main(int argc, char** argv)
{
  std::vector<std::filesystem::path> seeds;
  if (argc == 2)
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
      seeds.push_back(entry.path());
  std::sort(seeds.begin(), seeds.end());
  for (const auto& seed : seeds)
    replay(contentOf(seed));
  std::printf("%zu seeds\n", seeds.size());
  return seeds.empty() ? 1 : 0;
}
