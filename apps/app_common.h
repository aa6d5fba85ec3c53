/** \file
 * What the pcl_surflet_* programs share: options in PCL's single-dash style, exit codes, messages.
 *
 * Exit codes: 0 all went well, 1 wrong usage, 2 bad data or I/O. Results go to stdout, everything
 * else to stderr. */
#pragma once

#include "pcl_surflet/recognition/model_database.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

constexpr int kOk = 0, kWrongUsage = 1, kBadData = 2;

/** \brief The command line is wrong; what() names the option. Exit code 1. */
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/** \brief A file cannot be used or written; what() names file, cause and remedy. Exit code 2. */
class DataError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/** \brief Reads \p text as a whole number in [\p low, \p high].
 * \throws UsageError naming \p option */
std::uint64_t parseCount(const std::string& option, const std::string& text, std::uint64_t low,
                         std::uint64_t high);

/** \brief Reads \p text as a finite number in [\p low, \p high]. \throws UsageError naming
 * \p option */
double parseReal(const std::string& option, const std::string& text, double low, double high);

/** \brief Reads \p text, X,Y,Z, as a place. \throws UsageError naming \p option */
std::array<double, 3> parsePlace(const std::string& option, const std::string& text);

/** \brief The command line of one program: options with one dash, then files, in any order. */
class CommandLine {
public:
  /** \param arguments the positional ones for the first line of the help, e.g. "FILE..." */
  CommandLine(std::string program, std::string arguments, std::string description);

  void flag(const std::string& name, const std::string& help, bool& target);
  void text(const std::string& name, const std::string& value, const std::string& help,
            std::string& target);
  void count(const std::string& name, const std::string& value, const std::string& help,
             std::uint64_t& target, std::uint64_t low, std::uint64_t high);
  void real(const std::string& name, const std::string& value, const std::string& help,
            double& target, double low, double high);
  /** \brief An option whose value \p take understands; it may throw UsageError. */
  void option(const std::string& name, const std::string& value, const std::string& help,
              std::function<void(const std::string&)> take);

  /** \brief Takes in the command line. After "--" everything is a file. refuseOverwriting() knows
   * its words from then on.
   * \return false if help or version was asked for and has been printed. \throws UsageError */
  bool parse(int argc, char** argv);

  const std::vector<std::string>&
  files() const
  {
    return files_;
  }
  /** \brief Was option \p name given? */
  bool given(const std::string& name) const;
  /** \throws UsageError if the option \p name was not given */
  void require(const std::string& name) const;
  /** \throws UsageError unless the number of files is in [\p fewest, \p most] */
  void requireFiles(std::size_t fewest, std::size_t most) const;

  std::string help() const;

private:
  struct Option {
    std::string name, value, help;
    std::function<void(const std::string&)> take;
    bool given = false;
  };

  Option* find(const std::string& name);
  /** \brief Prints help or version if \p options ask for it. \return whether they do */
  bool answer(const std::vector<std::string>& options) const;

  std::string program_, arguments_, description_;
  std::vector<Option> options_;
  std::vector<std::string> files_;
};

/** \brief Runs \p body and turns what it throws into a message and an exit code. Also fails if
 * stdout could not be written. */
int runMain(const std::string& program, const std::function<int()>& body);

/** \brief A message about what was done, on stderr. */
void note(const std::string& text);
/** \brief A message about what went wrong, on stderr. */
void complain(const std::string& text);

/** \brief Shows how far a batch has come, if stderr is a terminal and there is more than one item.
 */
class Progress {
public:
  explicit Progress(std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::size_t done, const std::string& item);
  /** \brief Makes room for results; messages do so themselves. */
  void clear();

private:
  std::size_t total_;
  bool on_;
};

/** \brief \p text as a field of a CSV file: quoted if need be. */
std::string csvField(const std::string& text);

/** \brief \p value with six significant digits, as text that every locale reads alike. */
std::string number(double value);

/** \brief File name without directory and ending. */
std::string stemOf(const std::string& path);

/** \brief Does \p path end in \p ending (".png"), in capitals or not? */
bool hasEnding(const std::string& path, const std::string& ending);

/** \brief For programs that write PCD only. \throws UsageError if \p path has another ending */
void requirePcdName(const std::string& path);

/** \brief For pictures. \throws UsageError if \p path is given and does not end in .png */
void requirePngName(const std::string& path);

/** \brief Refuses to write to \p path if several words of the command line are names of that file,
 * so that it is read as well as written, or written twice.
 *
 * Names are the same file if the system says so: links and other spellings count.
 * \throws DataError that names the file, cause and remedy */
void refuseOverwriting(const std::string& path);

/** \brief Content of a text that people write: a regular file of 1 to 2^20 bytes.
 * \throws DataError */
std::string readTextFile(const std::string& path);

/** \brief What can be said before the work that gives \p path its content; nothing if it is empty.
 * \throws DataError as writeFile() does if its directory cannot be written, or it is one */
void checkOutput(const std::string& path);

/** \brief Replaces \p path by \p content as a whole. \throws DataError, also as
 * refuseOverwriting() does */
void writeFile(const std::string& path, const std::string& content);

/** \brief Reads a database. \throws DataError that names file, cause and remedy */
ModelDatabase readDatabase(const std::string& path);

/** \brief \p message, with \p path in front unless it names it already. */
std::string about(const std::string& path, const std::string& message);

/** \name Options that several programs have
 * \p target holds the default, which the help shows. */
///@{
void addSeed(CommandLine& line, std::uint64_t& target);
void addThreads(CommandLine& line, std::uint64_t& target);
/** \brief How normals that a file lacks are estimated. */
struct MissingNormals {
  std::uint64_t neighbours = 0;                ///< 0: they are not
  std::optional<std::array<double, 3>> sensor; ///< default: the file's VIEWPOINT
};
void addMissingNormals(CommandLine& line, MissingNormals& target);
///@}

} // namespace apps
} // namespace pcl_surflet
