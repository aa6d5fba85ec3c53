#include "pcl_adapters/pcd_guard.h"

#include "core/off_scanner.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

namespace pcl_surflet {
namespace detail {
namespace {

constexpr std::size_t kLongestHeader = 1 << 20;
constexpr std::uint64_t kLargestCount = 1 << 26;

/** \brief The entries of a header in the order that the format prescribes. */
const char* const kEntries[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

struct Header {
  std::size_t next = 0; ///< first entry that may come
  std::size_t types = 0;
  std::size_t fields = 0;
  std::vector<std::uint64_t> sizes, counts;
  std::uint64_t width = 0, height = 1;
  std::uint64_t points = 0;
  bool has_width = false, has_points = false;
  std::string data;
  std::uint64_t end = 0; ///< offset of the first byte behind the header

  std::uint64_t
  values() const
  {
    std::uint64_t sum = 0;
    for (const auto c : counts)
      sum += c;
    return sum;
  }
  std::uint64_t
  step() const
  {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      sum += sizes[i] * counts[i];
    return sum;
  }
};

bool
parseNumber(const std::string& token, std::uint64_t& value)
{
  const auto* end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  return result.ec == std::errc() && result.ptr == end &&
         value <= std::numeric_limits<std::uint32_t>::max();
}

bool
parseNumbers(std::istringstream& line, std::vector<std::uint64_t>& values)
{
  std::string token;
  std::uint64_t value = 0;
  while (line >> token) {
    if (!parseNumber(token, value))
      return false;
    values.push_back(value);
  }
  return true;
}

bool
parseOne(std::istringstream& line, std::uint64_t& value)
{
  std::string token;
  return (line >> token) && parseNumber(token, value);
}

/** \brief Each entry once, in order: PCL writes beyond its memory if FIELDS comes again behind
 * SIZE. */
std::string
orderProblem(const std::string& key, Header& header)
{
  const auto* const entry =
      std::find(std::begin(kEntries), std::end(kEntries), key == "COLUMNS" ? "FIELDS" : key);
  if (entry == std::end(kEntries))
    return "it has an unknown header entry " + forMessage(key) + "; is it a PCD file?";
  const auto number = static_cast<std::size_t>(entry - std::begin(kEntries));
  if (number < header.next)
    return "its header entry " + key + " comes twice or too late";
  header.next = number + 1;
  return {};
}

/** \brief Takes in one header line. \return what is wrong with it */
std::string
parseLine(const std::string& text, Header& header)
{
  std::istringstream line(text);
  std::string key, token;
  if (!(line >> key) || key[0] == '#')
    return {};
  if (auto problem = orderProblem(key, header); !problem.empty())
    return problem;
  bool good = true;
  if (key == "FIELDS" || key == "COLUMNS") {
    while (line >> token)
      ++header.fields;
  }
  else if (key == "SIZE")
    good = parseNumbers(line, header.sizes);
  else if (key == "COUNT")
    good = parseNumbers(line, header.counts);
  else if (key == "WIDTH")
    header.has_width = good = parseOne(line, header.width);
  else if (key == "HEIGHT")
    good = parseOne(line, header.height);
  else if (key == "POINTS")
    header.has_points = good = parseOne(line, header.points);
  else if (key == "DATA")
    good = static_cast<bool>(line >> header.data);
  else if (key == "TYPE")
    while (line >> token)
      ++header.types;
  return good ? "" : "its header entry " + key + " is damaged";
}

std::string
readHeader(std::istream& in, Header& header)
{
  std::string line;
  while (header.data.empty()) {
    if (!std::getline(in, line) || in.tellg() < 0 ||
        static_cast<std::size_t>(in.tellg()) > kLongestHeader)
      return "it has no complete PCD header; is it a PCD file?";
    if (auto problem = parseLine(line, header); !problem.empty())
      return problem;
  }
  header.end = static_cast<std::uint64_t>(in.tellg());
  if (header.counts.empty())
    header.counts.assign(header.fields, 1);
  if (!header.has_points)
    header.points = header.width * header.height;
  return {};
}

std::string
headerProblem(const Header& h)
{
  if (h.fields == 0 || h.sizes.size() != h.fields || h.counts.size() != h.fields ||
      h.types != h.fields)
    return "its header names " + std::to_string(h.fields) + " fields, but " +
           std::to_string(h.sizes.size()) + " sizes, " + std::to_string(h.types) + " types and " +
           std::to_string(h.counts.size()) + " counts";
  for (std::size_t i = 0; i < h.fields; ++i)
    if ((h.sizes[i] != 1 && h.sizes[i] != 2 && h.sizes[i] != 4 && h.sizes[i] != 8) ||
        h.counts[i] > kLargestCount)
      return "its header has an impossible field size or count";
  if (!h.has_width)
    return "its header has no WIDTH";
  if (h.width * h.height != h.points)
    return "its header claims " + std::to_string(h.points) + " points, but width times height is " +
           std::to_string(h.width * h.height);
  return {};
}

/** \brief PCL reads on behind DATA for as long as lines look like entries of a header, and takes
 * what they say: data that begins like one would change the fields under its feet. */
std::string
bodyProblem(std::istream& in)
{
  std::string line;
  while (std::getline(in, line)) {
    const auto begin = line.find_first_not_of(" \t\r\v\f");
    if (begin == std::string::npos || line[begin] == '#')
      continue; // PCL reads the next line
    for (const std::string entry : kEntries)
      if (line.compare(begin, entry.size(), entry) == 0)
        return "its data begins with the header entry " + entry;
    if (line.compare(begin, 7, "COLUMNS") == 0)
      return "its data begins with the header entry COLUMNS";
    break;
  }
  return {};
}

std::string
truncated(std::uint64_t needed, std::uint64_t there)
{
  return "it is truncated or its header is wrong: " + std::to_string(needed) +
         " bytes of data are needed, " + std::to_string(there) + " are there";
}

/** \brief Compressed data: two 32-bit sizes, then LZF, which shrinks by less than 1:128. */
std::string
compressedProblem(std::istream& in, const Header& h, std::uint64_t left)
{
  std::uint32_t sizes[2] = {0, 0};
  in.seekg(static_cast<std::streamoff>(h.end));
  if (!in.read(reinterpret_cast<char*>(sizes), sizeof(sizes)))
    return truncated(sizeof(sizes), left);
  if (sizes[0] > left - sizeof(sizes))
    return truncated(sizes[0] + sizeof(sizes), left);
  if (sizes[1] != h.points * h.step() || sizes[1] > 128 * std::uint64_t{sizes[0]} + 1024)
    return "the size of its compressed data is wrong";
  return {};
}

std::string
dataProblem(std::istream& in, const Header& h, std::uint64_t file_size)
{
  const std::uint64_t left = file_size - std::min(file_size, h.end);
  // No product can overflow: counts and sizes are bounded, and points fit 32 bits when width does.
  const double needed = static_cast<double>(h.points) * static_cast<double>(h.step());
  if (needed > 1e15)
    return "its header claims an absurd amount of data";
  if (h.data == "binary" && h.points * h.step() > left)
    return truncated(h.points * h.step(), left);
  if (h.data == "ascii" && h.points * h.values() * 2 > left + 1) // a digit and a separator each
    return truncated(h.points * h.values() * 2, left);
  if (h.data == "binary_compressed")
    return compressedProblem(in, h, left);
  if (h.data != "binary" && h.data != "ascii")
    return "its data kind " + forMessage(h.data) + " is unknown";
  return {};
}

} // namespace

std::string
pcdProblem(const std::string& path, PcdClaim& claim)
{
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return "it does not exist";
  if (std::filesystem::is_directory(status))
    return "it is a directory";
  if (!std::filesystem::is_regular_file(status)) // opening a pipe would wait for ever
    return "it is no regular file";
  std::ifstream in(path, std::ios::binary);
  if (!in)
    return "it cannot be read";
  const auto size = std::filesystem::file_size(path, error);
  if (error)
    return "it is not a regular file";
  if (size == 0)
    return "it is empty";
  Header header;
  if (auto problem = readHeader(in, header); !problem.empty())
    return problem;
  if (auto problem = headerProblem(header); !problem.empty())
    return problem;
  if (auto problem = bodyProblem(in); !problem.empty())
    return problem;
  claim = {header.fields, header.points, header.step(), header.end};
  in.clear();
  in.seekg(static_cast<std::streamoff>(header.end));
  return dataProblem(in, header, size);
}

} // namespace detail
} // namespace pcl_surflet
