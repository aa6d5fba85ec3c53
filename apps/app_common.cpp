#include "app_common.h"

#include "core/atomic_file.h"
#include "core/file_content.h"
#include "core/number_text.h"
#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/database_file.h"

#include <pcl/console/print.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

template <typename Number>
Number
parseNumber(const std::string& option, const std::string& text, const char* kind, Number low,
            Number high)
{
  Number value{};
  const auto* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  const bool is_number = result.ec != std::errc::invalid_argument && result.ptr == end;
  const bool negative = std::is_unsigned_v<Number> && !text.empty() && text[0] == '-';
  if (!is_number && !negative)
    throw UsageError("option " + option + ": '" + text + "' is not " + kind);
  if (negative || result.ec != std::errc{} || !(value >= low && value <= high)) {
    const auto shown = [](Number v) {
      return std::is_integral_v<Number> ? std::to_string(v) : number(static_cast<double>(v));
    };
    throw UsageError("option " + option + ": " + text + " is outside the range " + shown(low) +
                     " to " + shown(high));
  }
  return value;
}

} // namespace

std::uint64_t
parseCount(const std::string& option, const std::string& text, std::uint64_t low,
           std::uint64_t high)
{
  return parseNumber<std::uint64_t>(option, text, "a whole number", low, high);
}

std::array<double, 3>
parsePlace(const std::string& option, const std::string& text)
{
  std::array<double, 3> place{};
  std::size_t from = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t comma = text.find(',', from);
    if ((comma == std::string::npos) != (a == 2))
      throw UsageError("option " + option + ": '" + text + "' is not like 0,0,1.5");
    place[a] = parseReal(option, text.substr(from, comma - from), -1e9, 1e9);
    from = comma + 1;
  }
  return place;
}

double
parseReal(const std::string& option, const std::string& text, double low, double high)
{
  return parseNumber<double>(option, text, "a number", low, high);
}

int
runMain(const std::string& program, const std::function<int()>& body)
{
  // What PCL would say is said again, with the file's name, by our own messages.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  int code = kBadData;
  try {
    code = body();
  }
  catch (const UsageError& error) {
    complain(program + ": " + error.what() + "; see " + program + " -h");
    code = kWrongUsage;
  }
  catch (const std::bad_alloc&) {
    complain(program + ": not enough memory; give smaller files or fewer threads");
  }
  catch (const std::exception& error) {
    complain(program + ": " + error.what());
  }
  catch (...) {
    complain(program + ": unknown error");
  }
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0) {
    complain(program + ": cannot write to standard output; is the disk full?");
    return kBadData;
  }
  return code;
}

namespace {

/** \brief Makes room for a message where the progress bar may stand. */
void
clearLine()
{
  if (::isatty(STDERR_FILENO))
    std::fputs("\r\033[K", stderr);
}

} // namespace

void
note(const std::string& text)
{
  clearLine();
  pcl::console::print_highlight(stderr, "%s\n", text.c_str());
}

void
complain(const std::string& text)
{
  clearLine();
  pcl::console::print_color(stderr, pcl::console::TT_BRIGHT, pcl::console::TT_RED, "%s\n",
                            text.c_str());
}

Progress::Progress(std::size_t total) : total_(total), on_(total > 1 && ::isatty(STDERR_FILENO)) {}

Progress::~Progress() { clear(); }

void
Progress::clear()
{
  if (on_)
    clearLine();
}

void
Progress::show(std::size_t done, const std::string& item)
{
  constexpr std::size_t kWidth = 30, kNameWidth = 30;
  if (!on_)
    return;
  const std::size_t filled = kWidth * done / total_;
  clearLine();
  std::fprintf(stderr, "[%s%s] %zu/%zu %s", std::string(filled, '#').c_str(),
               std::string(kWidth - filled, ' ').c_str(), done, total_,
               stemOf(item).substr(0, kNameWidth).c_str());
}

std::string
csvField(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos)
    return text;
  std::string out = "\"";
  for (const char c : text)
    out.append(c == '"' ? 2 : 1, c);
  return out + '"';
}

std::string
number(double value)
{
  return detail::numberText(value);
}

std::string
stemOf(const std::string& path)
{
  return std::filesystem::path(path).stem().string();
}

void
requirePcdName(const std::string& path)
{
  if (std::filesystem::path(path).has_extension() && !hasEnding(path, ".pcd"))
    throw UsageError("'" + path + "' does not end in .pcd, which is what is written");
}

void
requirePngName(const std::string& path)
{
  if (!path.empty() && !hasEnding(path, ".png"))
    throw UsageError("option -picture: '" + path + "' does not end in .png");
}

bool
hasEnding(const std::string& path, const std::string& ending)
{
  const std::string own = std::filesystem::path(path).extension().string();
  return std::equal(own.begin(), own.end(), ending.begin(), ending.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

std::string
about(const std::string& path, const std::string& message)
{
  return message.find(path) == std::string::npos ? path + ": " + message : message;
}

ModelDatabase
readDatabase(const std::string& path)
{
  try {
    return loadDatabase(path);
  }
  catch (const DatabaseFileError& error) {
    throw DataError(about(path, error.what()) + "; give a database made by pcl_surflet_train");
  }
}

std::string
readTextFile(const std::string& path)
{
  constexpr std::uint64_t kLongest = 1 << 20;
  try {
    if (detail::checkedFileSize(path) > kLongest)
      throw DataError(path + ": is longer than a mebibyte; give a text");
    return detail::fileContent(path);
  }
  catch (const MeshFileError& error) {
    throw DataError(error.what());
  }
}

void
checkOutput(const std::string& path)
{
  const auto status = std::filesystem::status(path);
  const bool is_device = std::filesystem::exists(status) && std::filesystem::is_other(status);
  if (path.empty() || is_device)
    return;
  refuseOverwriting(path);
  const auto directory = std::filesystem::absolute(path).parent_path();
  std::string cause;
  if (std::filesystem::is_directory(status))
    cause = "it is a directory";
  else if (::access(directory.c_str(), W_OK) != 0)
    cause = std::strerror(errno);
  if (!cause.empty())
    throw DataError("cannot write '" + path + "': " + cause +
                    "; check its directory and the permissions");
}

void
writeFile(const std::string& path, const std::string& content)
{
  refuseOverwriting(path);
  if (const auto problem = detail::replaceFile(path, content); !problem.empty())
    throw DataError("cannot write '" + path + "': " + problem);
}

} // namespace apps
} // namespace pcl_surflet
