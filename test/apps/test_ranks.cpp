// Several processes at one job: the same bytes as one process writes, whatever happens.
#include "app_runner.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <thread>

#include <unistd.h>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words
operator+(Words left, const Words& right)
{
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/** \brief The process of one rank under the launcher \p launcher, 0 if there is none. */
pid_t
processOf(int rank, pid_t launcher)
{
  const std::string mark = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank) + '\0';
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos)
      continue;
    const std::string stat = readFile(entry.path() / "stat");
    const auto end_of_name = stat.rfind(')'); // then state and parent
    if (end_of_name == std::string::npos ||
        std::atoi(stat.c_str() + std::min(end_of_name + 4, stat.size())) != launcher)
      continue;
    if (readFile(entry.path() / "environ").find(mark) != std::string::npos)
      return std::stoi(name);
  }
  return 0;
}

class RanksTest : public Apps {
protected:
  void
  SetUp() override
  {
    const std::string mpirun = PCL_SURFLET_MPIEXEC;
    if (mpirun.empty())
      GTEST_SKIP() << "built without MPI";
    if (::access(mpirun.c_str(), X_OK) != 0)
      GTEST_SKIP() << "there is no " << mpirun;
    // As root, and with more ranks than processors.
    for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                             "OMPI_MCA_rmaps_base_oversubscribe"})
      ::setenv(name, "1", 1);
    ::setenv("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe", 1); // Open MPI 5
  }

  static Words
  launched(int ranks, const std::string& app, const Words& arguments)
  {
    return Words{PCL_SURFLET_MPIEXEC, "-n", std::to_string(ranks), appPath(app)} + arguments;
  }

  static AppRun
  runOn(int ranks, const std::string& app, const Words& arguments)
  {
    return Running(launched(ranks, app, arguments)).wait();
  }

  /** \brief Copies of a cloud under other names. */
  Words
  copies(const std::string& name, int count)
  {
    Words files;
    for (int i = 0; i < count; ++i) {
      files.push_back(path("copy" + std::to_string(i) + ".pcd"));
      fs::copy_file(path(name), files.back());
    }
    return files;
  }

  /** \brief A training that takes a few tenths of a second a file. */
  Words
  longTraining(const std::string& database, int files)
  {
    writeFile(path("bank.txt"), "noise 1\nnoise 2\nnoise 4\n");
    return Words{"-database", path(database), "-bank", path("bank.txt"), "-threads", "1"} +
           copies("ball.pcd", files);
  }

  Words
  filesBeside(const std::string& name) const
  {
    Words names;
    for (const auto& entry : fs::directory_iterator(directory_))
      if (entry.path().filename().string().find(name) == 0)
        names.push_back(entry.path().filename());
    return names;
  }
};

/** \brief For half a minute at most. */
void
waitUntilSaid(const Running& program, const std::string& word)
{
  for (int i = 0; i < 1500 && program.err().find(word) == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

/** \brief The launcher has a few words of its own to say after ours, and where there is no /sys
 * also before them. */
testing::AssertionResult
saysInOnePiece(const std::string& all, const std::string& expected)
{
  if (all.find(expected) != std::string::npos)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << all << "\ndoes not have in one piece\n" << expected;
}

} // namespace

TEST_F(RanksTest, TrainTheSameDatabase)
{
  makeShapes();
  writeFile(path("bad.ply"), "ply\nnonsense\n");
  const Words files =
      Words{path("ball.pcd"), path("bad.ply"), path("cup.off"), path("none.pcd"), path("die.ply")} +
      copies("ball.pcd", 6);
  const auto line = [&](const std::string& name) {
    return Words{"-database", path(name), "-pairs", "200000"} + files;
  };
  const AppRun alone = run("train", line("alone.pcd"));
  ASSERT_TRUE(ended(alone, 2, {path("bad.ply"), path("none.pcd"), "2 of 11 files"}));
  for (const int ranks : {1, 2, 4}) {
    const AppRun r = runOn(ranks, "train", line("ranks.pcd"));
    EXPECT_EQ(r.code, 2) << ranks;
    EXPECT_TRUE(saysInOnePiece(r.err, alone.err)) << ranks;
    EXPECT_EQ(r.out, "") << ranks;
    EXPECT_TRUE(readFile(path("ranks.pcd")) == readFile(path("alone.pcd"))) << ranks;
    fs::remove(path("ranks.pcd"));
  }
}

TEST_F(RanksTest, ShareThePairsOfOneFile)
{
  makeShapes();
  writeFile(path("same.ply"), "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nproperty float nx\n"
                              "property float ny\nproperty float nz\nend_header\n"
                              "1 2 3 0 0 1\n1 2 3 0 0 1\n1 2 3 0 0 1\n");
  const auto line = [&](const std::string& name) {
    return Words{"-database",      path(name),       "-pairs",         "1000000000",
                 path("ball.pcd"), path("none.pcd"), path("same.ply"), path("cup.off")};
  };
  const AppRun alone = run("train", line("alone.pcd"));
  ASSERT_TRUE(ended(alone, 2, {path("none.pcd"), "coincide", "2 of 4 files"}));
  for (const int ranks : {2, 3}) {
    const AppRun r = runOn(ranks, "train", line("ranks.pcd"));
    EXPECT_EQ(r.code, 2) << ranks;
    EXPECT_TRUE(saysInOnePiece(r.err, alone.err)) << ranks;
    EXPECT_TRUE(readFile(path("ranks.pcd")) == readFile(path("alone.pcd"))) << ranks;
    fs::remove(path("ranks.pcd"));
  }
}

TEST_F(RanksTest, InterpretTheSame)
{
  Words scenes;
  for (const std::string seed : {"1", "2", "3"}) {
    scenes.push_back(path("s" + seed + ".pcd"));
    ASSERT_EQ(
        run("generate", {"-out", scenes.back(), "-poses", path("p.csv"), "-empty", path("e.pcd"),
                         "-seed", seed, "-density", "40000", "bottle", "torus"})
            .code,
        0);
  }
  ASSERT_NO_FATAL_FAILURE(makeSceneDatabase({"bottle", "torus"}, "8000"));
  writeFile(path("bad.pcd"), "nonsense");
  scenes.insert(scenes.begin() + 1, path("bad.pcd"));
  const auto line = [&](const std::string& directory) {
    return Words{"-database", path("db.pcd"), "-background",  "exclude",
                 "-empty",    path("e.pcd"),  "-leaf",        "0.012",
                 "-csv",      "-verbose",     "-objects_dir", path(directory)} +
           scenes;
  };
  const AppRun alone = run("interpret", line("alone"));
  ASSERT_TRUE(ended(alone, 2, {path("bad.pcd"), "promising"}));
  ASSERT_GT(parseCsv(alone.out).size(), 3u) << "something is found";
  for (const int ranks : {1, 2, 4}) {
    const AppRun r = runOn(ranks, "interpret", line("ranks"));
    EXPECT_EQ(r.code, 2) << ranks;
    EXPECT_EQ(r.out, alone.out) << ranks;
    EXPECT_TRUE(saysInOnePiece(r.err, alone.err)) << ranks;
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(path("alone"))) {
      const std::string twin = path("ranks/" + entry.path().filename().string());
      EXPECT_TRUE(readFile(entry.path()) == readFile(twin)) << ranks << ": " << twin;
      ++files;
    }
    EXPECT_EQ(files + 1, parseCsv(alone.out).size()) << "one file an object";
    fs::remove_all(path("ranks"));
  }
}

TEST_F(RanksTest, ARankThatDiesLeavesTheOldDatabase)
{
  makeDatabase();
  const std::string before = readFile(path("db.pcd"));
  const Words line = longTraining("db.pcd", 200);
  for (const int victim : {1, 0}) {
    Running training(launched(2, "train", line));
    waitUntilSaid(training, "added 'copy0'");
    const pid_t process = processOf(victim, training.pid());
    ASSERT_GT(process, 0) << training.err();
    ASSERT_EQ(::kill(process, SIGKILL), 0);
    const AppRun r = training.wait(); // for a minute at most
    EXPECT_GT(r.code, 0) << r.err;
    EXPECT_NE(r.err.find("signal 9"), std::string::npos) << r.err;
    EXPECT_TRUE(readFile(path("db.pcd")) == before);
    // The lock of who was killed stays: it holds nobody up.
    for (const auto& file : filesBeside("db.pcd"))
      EXPECT_TRUE(file == "db.pcd" || file == "db.pcd.lock") << file;
  }
}

TEST_F(RanksTest, ErrorsAreSaidOnce)
{
  makeDatabase();
  const auto times = [](const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++count;
    return count;
  };
  AppRun r = runOn(2, "train", {"-nonsense", path("ball.pcd")});
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(times(r.err, "unknown option -nonsense"), 1u) << r.err;
  const std::string nowhere = path("no/such/directory/db.pcd");
  r = runOn(2, "train", {"-database", nowhere, path("ball.pcd")});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(times(r.err, "cannot write '" + nowhere), 1u) << r.err;
  r = runOn(2, "interpret", {"-database", path("none.pcd"), path("ball.pcd")});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(times(r.err, "give a database made by"), 1u) << r.err;
  r = runOn(2, "interpret", {"-h"});
  EXPECT_EQ(r.code, 0);
  EXPECT_EQ(times(r.out, "Usage:"), 1u) << r.out;
}

TEST_F(RanksTest, AnErrorOfAnotherRankIsNamed)
{
  makeDatabase();
  // To the other rank the relative names mean nothing.
  const AppRun r =
      Running({PCL_SURFLET_MPIEXEC, "-n", "2", "/bin/sh", "-c",
               "[ $OMPI_COMM_WORLD_RANK = 0 ] && cd \"$1\"; exec \"$0\" -database db.pcd "
               "ball.pcd",
               appPath("interpret"), directory_.string()})
          .wait();
  EXPECT_TRUE(ended(r, 2, {"rank 1", "db.pcd"}));
}

TEST_F(RanksTest, DifferentArgumentsAreRefused)
{
  makeDatabase();
  const Words database = {"-database", path("db.pcd")};
  const AppRun r =
      Running(launched(1, "interpret", database + Words{path("ball.pcd")}) +
              Words{":", "-n", "1", appPath("interpret")} + database + Words{path("die.ply")})
          .wait();
  EXPECT_TRUE(ended(r, 2, {"rank 1", "other arguments", "PCL_SURFLET_MPI=off"}));
}

TEST_F(RanksTest, ADirectoryThatIsGoneIsSaidOnceAndTheOldDatabaseStays)
{
  makeDatabase();
  fs::create_directory(path("here"));
  fs::rename(path("db.pcd"), path("here/db.pcd"));
  const std::string before = readFile(path("here/db.pcd"));
  Running training(launched(2, "train", longTraining("here/db.pcd", 10)));
  waitUntilSaid(training, "added 'copy0'");
  fs::rename(path("here"), path("there"));
  const AppRun r = training.wait();
  EXPECT_TRUE(ended(r, 2, {path("here/db.pcd"), "No such file"}));
  EXPECT_EQ(r.err.find("all ranks end"), std::string::npos) << "an error like any other";
  EXPECT_TRUE(readFile(path("there/db.pcd")) == before);
  EXPECT_FALSE(fs::exists(path("here")));
}

// These need no launcher.
class StrangeLauncher : public Apps {
protected:
  void
  SetUp() override
  {
    for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"})
      ::setenv(name, "1", 1);
    ::setenv("PMI_SIZE", "2", 1);
  }
  void
  TearDown() override
  {
    ::unsetenv("PMI_SIZE");
    ::unsetenv("PCL_SURFLET_MPI");
  }
};

TEST_F(StrangeLauncher, IsRefusedUnlessEveryProcessIsToWorkForItself)
{
  EXPECT_TRUE(ended(run("train", {"-h"}), 2, {"PCL_SURFLET_MPI=off"}));
  ::setenv("PCL_SURFLET_MPI", "off", 1);
  EXPECT_TRUE(ended(run("train", {"-h"}), 0, {}));
}
