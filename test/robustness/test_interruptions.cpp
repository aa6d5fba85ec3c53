// What ends in the middle: programs that are killed while they write, callbacks that throw, and
// locales that write numbers otherwise.
#include "../comma_locale.h"
#include "../full_disk.h"
#include "../recognition/failing_allocation.h"
#include "../test_files.h"

#include "core/atomic_file.h"
#include "pcl_surflet/core/parallel.h"
#include "pcl_surflet/core/shapes.h"
#include "pcl_surflet/database_file.h"
#include "pcl_surflet/recognition/histogram_model_trainer.h"
#include "pcl_surflet/scene_interpreter.h"
#include "pcl_surflet/surface_file.h"

#include <pcl/io/pcd_io.h>

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace pcl_surflet;
using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

using Interruptions = FileTest;

SurfletSet
torus()
{
  return sampleShape(*shapeByName("torus"), 2000, 9);
}

ModelDatabase
someModels()
{
  HistogramModelTrainer trainer;
  trainer.setNumberOfPairs(50000);
  ModelDatabase database;
  database.add(trainer.train("torus", torus()));
  return database;
}

} // namespace

TEST_F(Interruptions, AWriterThatDiesInTheMiddleLeavesTheOldFile)
{
  const std::string file = path("file"), old(1000, 'a'), fresh(1000000, 'b');
  ASSERT_EQ(detail::replaceFile(file, old), "");
  for (const rlim_t bytes : {rlim_t{1}, rlim_t{4096}, rlim_t{500000}, rlim_t{999999}}) {
    const pid_t child = ::fork();
    if (child == 0) { // the system kills who writes a byte more
      const rlimit no_core{0, 0};
      ::setrlimit(RLIMIT_CORE, &no_core);
      const FullDisk full(bytes);
      std::signal(SIGXFSZ, SIG_DFL);
      detail::replaceFile(file, fresh);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) << bytes << " " << status;
    EXPECT_EQ(readFile(file), old) << bytes;
    std::uintmax_t left = 0; // in a temporary file, in nobody's way
    for (const auto& entry : fs::directory_iterator(directory_))
      left += entry.path() == file ? 0 : entry.file_size();
    EXPECT_GE(left, bytes);
    ASSERT_EQ(detail::replaceFile(file, old), "");
  }
  ASSERT_EQ(detail::replaceFile(file, fresh), "");
  EXPECT_EQ(readFile(file), fresh);
}

TEST_F(Interruptions, AKilledWriterLeavesTheOldFileOrTheNew)
{
  const std::string file = path("file"), old(1000000, 'a'), fresh(1000000, 'b');
  ASSERT_EQ(detail::replaceFile(file, old), "");
  for (int i = 0; i < 8; ++i) {
    const pid_t child = ::fork();
    if (child == 0)
      for (;;)
        for (const auto* content : {&fresh, &old})
          detail::replaceFile(file, *content);
    ::usleep(static_cast<useconds_t>(3000 + 4100 * i)); // somewhere
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::string content = readFile(file);
    ASSERT_TRUE(content == old || content == fresh) << "after kill " << i;
  }
}

TEST_F(Interruptions, NamesMayBeAsLongAsTheSystemAllows)
{
  const std::string longest = std::string(251, 'a') + ".pcd";
  ASSERT_EQ(detail::replaceFile(path(longest), "content"), "");
  EXPECT_EQ(readFile(path(longest)), "content");
  EXPECT_NE(detail::replaceFile(path("a" + longest), "content"), "");
}

TEST_F(Interruptions, WhatAWorkerThrowsReachesTheCaller)
{
  for (const unsigned threads : {1U, 2U, 7U}) {
    std::atomic<int> done{0};
    const auto work = [&](std::size_t item, unsigned) {
      if (item == 50)
        throw std::domain_error("item 50");
      ++done;
    };
    EXPECT_THROW(parallelFor(1000, threads, work), std::domain_error) << threads;
    EXPECT_LT(done, 1000);
    EXPECT_THROW(parallelFor(100, threads, [](auto, auto) { throw 7; }), int) << "all at once";
  }
}

TEST_F(Interruptions, WithoutMemoryForThreadsThoseThereAreDoAllTheWork)
{
  bool ended = false;
  for (long left = 0; left < 20 && !ended; ++left) {
    std::atomic<std::size_t> sum{0};
    allocations_left = left;
    try {
      parallelFor(100, 4, [&](std::size_t item, unsigned) { sum += item; });
      ended = left > 12;
      allocations_left = -1;
      EXPECT_EQ(sum, 4950u) << left;
    }
    catch (const std::bad_alloc&) { // before the first thread
      allocations_left = -1;
    }
  }
}

TEST_F(Interruptions, WhatTheProgressCallbackThrowsReachesTheCaller)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  const SurfletSet set = torus();
  for (std::size_t i = 0; i < set.size(); ++i)
    cloud->push_back({set.x[i], set.y[i], set.z[i], set.nx[i], set.ny[i], set.nz[i]});
  for (const auto method : {Method::Explanation, Method::Dissertation}) {
    SceneInterpreter<pcl::PointNormal> interpreter;
    interpreter.setInputCloud(cloud);
    interpreter.setDatabase(someModels());
    interpreter.setMethod(method);
    interpreter.setLeafSize(0.02);
    interpreter.setNumberOfThreads(4);
    interpreter.setProgressCallback([](double) -> bool { throw std::domain_error("enough"); });
    EXPECT_THROW(interpreter.interpret(), std::domain_error);
    // The object can be used again.
    interpreter.setProgressCallback(nullptr);
    EXPECT_NO_THROW(interpreter.interpret());
  }
}

TEST_F(Interruptions, FilesAreTheSameInEveryLocale)
{
  const ModelDatabase models = someModels();
  saveDatabase(models, path("classic.pcd"));
  pcl::PointCloud<pcl::PointNormal> cloud;
  for (int i = 0; i < 1234; ++i)
    cloud.push_back({0.5F * static_cast<float>(i), 1.25F, 1e-3F, 0, 0, 1});
  cloud.sensor_origin_ << 1.5F, 2.5F, 3.5F, 0;
  pcl::io::savePCDFileASCII(path("ascii.pcd"), cloud);
  const auto before = loadSurface(path("ascii.pcd")).surflets;
  ASSERT_EQ(before.size(), 1234U);
  ASSERT_EQ(before.x[1], 0.5F);
  {
    const CommaLocale comma;
    saveDatabase(models, path("comma.pcd"));
    EXPECT_EQ(loadDatabase(path("classic.pcd"))[0].delta_max, models[0].delta_max);
    const auto after = loadSurface(path("ascii.pcd")).surflets;
    ASSERT_EQ(after.size(), before.size());
    EXPECT_EQ(after.x, before.x);
    EXPECT_EQ(after.z, before.z);
  }
  EXPECT_EQ(readFile(path("comma.pcd")), readFile(path("classic.pcd")));
}
