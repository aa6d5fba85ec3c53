/** \file
 * Files that tests write and read. */
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace pcl_surflet {
namespace test {

inline std::string
readFile(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void
writeFile(const std::string& path, const std::string& content)
{
  std::ofstream(path, std::ios::binary) << content;
}

/** \brief An empty directory that vanishes with all that is in it. */
class TemporaryDirectory {
public:
  TemporaryDirectory() { std::filesystem::create_directories(place_); }
  ~TemporaryDirectory() { std::filesystem::remove_all(place_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path&
  place() const
  {
    return place_;
  }
  std::string
  path(const std::string& name) const
  {
    return (place_ / name).string();
  }

private:
  static std::string
  freshName()
  {
    static int made = 0;
    return "surflet_test_" + std::to_string(::getpid()) + "_" + std::to_string(made++);
  }

  std::filesystem::path place_ = std::filesystem::temp_directory_path() / freshName();
};

/** \brief Every test has a directory of its own. */
class FileTest : public testing::Test {
protected:
  std::string
  path(const std::string& name) const
  {
    return temporary_.path(name);
  }

private:
  const TemporaryDirectory temporary_;

protected:
  const std::filesystem::path directory_ = temporary_.place();
};

} // namespace test
} // namespace pcl_surflet
