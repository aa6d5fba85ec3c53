/** \file
 * A full disk for tests. A real /dev/full is no test object: a broken writer run as root would
 * replace it. */
#pragma once

#include <csignal>

#include <sys/resource.h>

namespace pcl_surflet {
namespace test {

/** \brief While it lives, no file of this process and of those it starts can grow beyond \p bytes:
 * writing fails in the middle, as on a full disk. */
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes)
  {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN); // programs that are started inherit it
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk()
  {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

} // namespace test
} // namespace pcl_surflet
