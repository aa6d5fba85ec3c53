/** \file
 * Runs the pcl_surflet_* programs as a user's shell would. */
#pragma once

#include "../test_files.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace test {

/** \brief What a program said and returned. */
struct AppRun {
  int code = -1; ///< exit code, or -1 if it was killed by a signal (a crash, or a minute is over)
  std::string out, err;
};

/** \brief Where \p app ("train" for pcl_surflet_train) lies. */
std::string appPath(const std::string& app);

/** \brief A program at work, for at most a minute and with 3 GiB; one at a time. */
class Running {
public:
  /** \param command path and arguments \param out where stdout goes instead of into the result */
  explicit Running(const std::vector<std::string>& command, const std::string& out = {});

  int
  pid() const
  {
    return pid_;
  }
  /** \brief What it has said on stderr so far. */
  std::string err() const;
  /** \brief Waits for its end. */
  AppRun wait();

private:
  int pid_ = -1;
  bool keep_out_ = false;
  std::string out_file_, err_file_;
};

/** \brief Runs \p app ("train" for pcl_surflet_train) with at most a minute and 3 GiB.
 * \param out where stdout goes instead of into the result */
AppRun run(const std::string& app, const std::vector<std::string>& arguments,
           const std::string& out = {});

/** \brief Rows and fields of a CSV text. */
std::vector<std::vector<std::string>> parseCsv(const std::string& text);

/** \brief Every test has a directory of its own, with a few shapes and a database of them. */
class Apps : public FileTest {
protected:
  /** \brief Makes ball.pcd, die.ply and cup.off. */
  void makeShapes();
  /** \brief makeShapes() and db.pcd of the three. */
  void makeDatabase();
  /** \brief Makes SHAPE.pcd of so many points for each, and db.pcd of them for scenes. */
  void makeSceneDatabase(const std::vector<std::string>& shapes, const std::string& points);
};

/** \brief The run ended with \p code and said every one of \p words on stderr. */
testing::AssertionResult ended(const AppRun& run, int code, const std::vector<std::string>& words);

} // namespace test
} // namespace pcl_surflet
