/** \file
 * A fuzzer's input as a file in memory, for readers that take a path. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace pcl_surflet {
namespace fuzz {

/** \brief Holds one input at a time under one name that ends as asked for. */
class InputFile {
public:
  explicit InputFile(const std::string& ending)
      : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)),
        link_("/tmp/pcl_surflet_fuzz" + std::to_string(::getpid()) + ending)
  {
    const std::string target = "/proc/self/fd/" + std::to_string(descriptor_);
    if (descriptor_ < 0 || ::symlink(target.c_str(), link_.c_str()) != 0)
      throw std::runtime_error("cannot make " + link_);
  }
  ~InputFile()
  {
    ::unlink(link_.c_str());
    ::close(descriptor_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /** \return the path of a file that holds \p size bytes at \p data */
  const std::string&
  hold(const std::uint8_t* data, std::size_t size) const
  {
    if (::ftruncate(descriptor_, 0) != 0 ||
        ::pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size))
      throw std::runtime_error("cannot fill " + link_);
    return link_;
  }

private:
  int descriptor_;
  std::string link_;
};

} // namespace fuzz
} // namespace pcl_surflet
