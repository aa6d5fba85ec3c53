#include "app_common.h"

#include "pcl_surflet/config.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>

namespace pcl_surflet {
namespace apps {

namespace {

/** \brief The words of the command line that may be names of files. */
std::vector<std::string>&
words()
{
  static std::vector<std::string> all;
  return all;
}

} // namespace

void
refuseOverwriting(const std::string& path)
{
  const auto is_path = [&](const std::string& word) {
    std::error_code not_there;
    return std::filesystem::is_regular_file(word, not_there) &&
           std::filesystem::equivalent(word, path, not_there);
  };
  if (std::count_if(words().begin(), words().end(), is_path) > 1)
    throw DataError("not written: '" + path +
                    "' is named twice, and what it holds would be lost; "
                    "give another name for what is written");
}

CommandLine::CommandLine(std::string program, std::string arguments, std::string description)
    : program_(std::move(program)), arguments_(std::move(arguments)),
      description_(std::move(description))
{
}

void
CommandLine::option(const std::string& name, const std::string& value, const std::string& help,
                    std::function<void(const std::string&)> take)
{
  options_.push_back({name, value, help, std::move(take), false});
}

void
CommandLine::flag(const std::string& name, const std::string& help, bool& target)
{
  option(name, "", help, [&target](const std::string&) { target = true; });
}

void
CommandLine::text(const std::string& name, const std::string& value, const std::string& help,
                  std::string& target)
{
  option(name, value, help, [&target, name](const std::string& text) {
    if (text.empty())
      throw UsageError("option " + name + ": the value is empty");
    target = text;
  });
}

void
CommandLine::count(const std::string& name, const std::string& value, const std::string& help,
                   std::uint64_t& target, std::uint64_t low, std::uint64_t high)
{
  option(name, value, help, [&target, name, low, high](const std::string& text) {
    target = parseCount(name, text, low, high);
  });
}

void
CommandLine::real(const std::string& name, const std::string& value, const std::string& help,
                  double& target, double low, double high)
{
  option(name, value, help, [&target, name, low, high](const std::string& text) {
    target = parseReal(name, text, low, high);
  });
}

CommandLine::Option*
CommandLine::find(const std::string& name)
{
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const Option& o) { return o.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

bool
CommandLine::answer(const std::vector<std::string>& options) const
{
  const auto asked_for = [&](const char* short_name, const char* long_name) {
    return std::any_of(options.begin(), options.end(),
                       [&](const std::string& s) { return s == short_name || s == long_name; });
  };
  const bool help_wanted = asked_for("-h", "--help");
  const bool version_wanted = asked_for("-version", "--version");
  if (help_wanted)
    std::cout << help();
  else if (version_wanted)
    std::cout << program_ << " (pcl_surflet) " << PCL_SURFLET_VERSION << "\n";
  return help_wanted || version_wanted;
}

bool
CommandLine::parse(int argc, char** argv)
{
  const std::vector<std::string> given(argv + std::min(argc, 1), argv + argc);
  words() = given;
  const auto end_of_options = std::find(given.begin(), given.end(), "--");
  // Whoever asks for help gets it, whatever else is wrong with the line.
  if (answer({given.begin(), end_of_options}))
    return false;
  for (auto at = given.begin(); at != end_of_options; ++at) {
    if (at->size() < 2 || (*at)[0] != '-') {
      files_.push_back(*at);
      continue;
    }
    Option* option = find(*at);
    if (option == nullptr)
      throw UsageError("unknown option " + *at);
    if (option->given)
      throw UsageError("option " + *at + " is given twice");
    option->given = true;
    const bool takes_value = !option->value.empty();
    if (takes_value && (at + 1 == end_of_options || find(*(at + 1)) != nullptr))
      throw UsageError("option " + *at + " needs a value: " + option->value);
    option->take(takes_value ? *++at : std::string());
  }
  if (end_of_options != given.end())
    files_.insert(files_.end(), end_of_options + 1, given.end());
  return true;
}

bool
CommandLine::given(const std::string& name) const
{
  return std::any_of(options_.begin(), options_.end(),
                     [&](const Option& o) { return o.name == name && o.given; });
}

void
CommandLine::require(const std::string& name) const
{
  if (!given(name))
    throw UsageError("option " + name + " is missing");
}

void
CommandLine::requireFiles(std::size_t fewest, std::size_t most) const
{
  if (files_.size() < fewest)
    throw UsageError("arguments are missing: " + arguments_);
  if (files_.size() > most)
    throw UsageError("too many arguments: '" + files_[most] + "' is not expected");
}

std::string
CommandLine::help() const
{
  constexpr std::size_t kColumn = 24;
  std::string out =
      "Usage: " + program_ + " [options] " + arguments_ + "\n\n" + description_ + "\n\nOptions:\n";
  const auto line = [&](const std::string& left, const std::string& right) {
    const std::string gap = left.size() < kColumn ? std::string(kColumn - left.size(), ' ')
                                                  : "\n" + std::string(kColumn + 2, ' ');
    out += "  " + left + gap + right + "\n";
  };
  for (const auto& o : options_)
    line(o.name + (o.value.empty() ? "" : " " + o.value), o.help);
  line("-h, --help", "print this and stop");
  line("-version, --version", "print the version and stop");
  return out + "\nExit codes: 0 all went well, 1 wrong usage, 2 bad data or I/O.\n";
}

void
addSeed(CommandLine& line, std::uint64_t& target)
{
  line.count("-seed", "S", "random seed, default " + std::to_string(target), target, 0,
             std::numeric_limits<std::uint64_t>::max());
}

void
addThreads(CommandLine& line, std::uint64_t& target)
{
  line.count("-threads", "T", "threads, default 0: all; the result does not depend on it", target,
             0, 1024);
}

void
addMissingNormals(CommandLine& line, MissingNormals& target)
{
  line.count("-k", "K",
             "estimate missing normals from K neighbours, turned to the sensor; organised clouds "
             "have theirs from neighbouring pixels without this option",
             target.neighbours, 3, 10000);
  line.option(
      "-sensor_at", "X,Y,Z",
      "where the sensor was, for missing normals, in the coordinates of the points; default "
      "the file's VIEWPOINT. 0,0,0 if that tells the pose of the sensor in a world",
      [&target](const std::string& text) { target.sensor = parsePlace("-sensor_at", text); });
}

} // namespace apps
} // namespace pcl_surflet
