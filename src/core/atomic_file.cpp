#include "atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace pcl_surflet {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxNames = 100;
constexpr std::size_t kKeptOfName = 200; ///< bytes: a name with an ending must still be allowed

/** \brief Writes all of \p content and closes \p descriptor; an errno value, 0 on success. */
int
writeAndClose(int descriptor, const std::string& content, bool synchronise)
{
  int error = 0;
  const char* from = content.data();
  std::size_t left = content.size();
  while (left > 0 && error == 0) {
    const auto written = ::write(descriptor, from, left);
    if (written < 0 && errno != EINTR)
      error = errno;
    if (written > 0) {
      from += written;
      left -= static_cast<std::size_t>(written);
    }
  }
  // Full network and quota-limited disks report their errors only here.
  if (error == 0 && synchronise && ::fsync(descriptor) != 0)
    error = errno;
  if (::close(descriptor) != 0 && error == 0)
    error = errno;
  return error;
}

/** \brief Opens a new file beside \p target and sets \p name to it; -1 and errno on failure. */
int
openBeside(const fs::path& target, std::string& name)
{
  const fs::path stem = target.parent_path() / target.filename().string().substr(0, kKeptOfName);
  for (int i = 0; i < kMaxNames; ++i) {
    name = stem.string() + ".tmp" + std::to_string(::getpid()) + "." + std::to_string(i);
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST)
      return descriptor;
  }
  return -1;
}

std::string
writeDirectly(const fs::path& target, const std::string& content)
{
  const int descriptor = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
  const int error = descriptor < 0 ? errno : writeAndClose(descriptor, content, false);
  return error == 0 ? std::string() : std::strerror(error);
}

std::string
causeOfNotReplacing(const std::string& path, const std::string& content)
{
  std::error_code ignored;
  fs::path target = path;
  if (fs::is_symlink(target, ignored)) {
    const auto resolved = fs::weakly_canonical(target, ignored);
    if (!resolved.empty())
      target = resolved;
  }
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status))
    return "it is a directory";
  const bool exists = fs::exists(status);
  if (exists && !fs::is_regular_file(status))
    return writeDirectly(target, content);

  // Renaming asks the directory alone.
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return std::strerror(errno);
  std::string temporary;
  const int descriptor = openBeside(target, temporary);
  if (descriptor < 0)
    return std::string("cannot create a file in its directory: ") + std::strerror(errno);
  int error = writeAndClose(descriptor, content, true);
  if (error == 0 && exists)
    fs::permissions(temporary, status.permissions(), ignored);
  if (error == 0 && std::rename(temporary.c_str(), target.c_str()) != 0)
    error = errno;
  if (error == 0)
    return {};
  ::unlink(temporary.c_str());
  return std::strerror(error);
}

} // namespace

std::string
detail::replaceFile(const std::string& path, const std::string& content)
{
  const std::string cause = causeOfNotReplacing(path, content);
  return cause.empty() ? cause
                       : cause + "; check the directory, its permissions and the free space";
}

} // namespace pcl_surflet
