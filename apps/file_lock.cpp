#include "file_lock.h"

#include "app_common.h"

#include <cerrno>
#include <filesystem>
#include <memory>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

class FileLock {
public:
  explicit FileLock(std::string side_file) : name_(std::move(side_file))
  {
    while (open() && !lock())
      release(false);
  }
  ~FileLock() { release(true); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

private:
  bool
  open()
  {
    descriptor_ = ::open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    return descriptor_ >= 0;
  }

  /** \return false if whoever had the lock before removed the file: a newer one counts. */
  bool
  lock()
  {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK)
        note("waiting for another program that changes the same file ('" + name_ + "')");
      int failed = 0;
      do
        failed = ::flock(descriptor_, LOCK_EX);
      while (failed != 0 && errno == EINTR);
      if (failed != 0)
        return true; // there are no locks here
    }
    struct stat held {
    }, named{};
    return ::fstat(descriptor_, &held) == 0 && ::stat(name_.c_str(), &named) == 0 &&
           held.st_ino == named.st_ino && held.st_dev == named.st_dev;
  }

  /** \param remove while the lock is still held, so that nobody's new file is removed */
  void
  release(bool remove)
  {
    if (descriptor_ < 0)
      return;
    if (remove)
      ::unlink(name_.c_str());
    ::close(descriptor_);
    descriptor_ = -1;
  }

  std::string name_;
  int descriptor_ = -1;
};

} // namespace

void
lockUntilExit(const std::string& path)
{
  static std::unique_ptr<FileLock> held;
  std::error_code failure;
  const auto target = std::filesystem::weakly_canonical(path, failure); // links lead to one file
  held.reset();
  held = std::make_unique<FileLock>((failure ? path : target.string()) + ".lock");
}

} // namespace apps
} // namespace pcl_surflet
