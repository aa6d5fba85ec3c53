// Every file that a program writes, where it cannot be written: what was there stays, nothing else
// is left behind, and the message names the file.
#include "../full_disk.h"
#include "app_runner.h"

#include <cstdio>

#include <sys/wait.h>
#include <unistd.h>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

/** \brief Less than any output, more than the messages. */
constexpr rlim_t kSmall = 400;

class FullDisks : public Apps {
protected:
  std::size_t
  files() const
  {
    return static_cast<std::size_t>(
        std::distance(fs::recursive_directory_iterator(directory_), {}));
  }

  /** \brief Runs the program on a full disk, and where a directory has the name of the output. */
  void
  expectRefused(const std::string& app, const std::vector<std::string>& arguments,
                const std::string& output)
  {
    fs::create_directories(fs::path(output).parent_path());
    writeFile(output, "kept");
    const std::size_t before = files();
    const AppRun r = [&] {
      const FullDisk full(kSmall);
      return run(app, arguments);
    }();
    EXPECT_TRUE(ended(r, 2, {output, "space"}));
    EXPECT_EQ(readFile(output), "kept") << output;
    EXPECT_EQ(files(), before) << output << ": something was left behind";
    fs::remove(output);
    fs::create_directory(output);
    EXPECT_TRUE(ended(run(app, arguments), 2, {output, "directory"}));
    fs::remove(output);
  }
};

/** \brief An X server without screen, started before the disk is full: it needs files itself. */
class Screen {
public:
  Screen()
  {
    std::FILE* server = ::popen("Xvfb -displayfd 1 -noreset 2>/dev/null & echo $!", "r");
    int display = -1;
    if (std::fscanf(server, "%d %d", &pid_, &display) == 2)
      ::setenv("DISPLAY", (":" + std::to_string(display)).c_str(), 1);
    ::pclose(server);
  }
  ~Screen()
  {
    ::unsetenv("DISPLAY");
    ::kill(pid_, SIGTERM);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

private:
  pid_t pid_ = 0;
};

class FullDiskScenes : public FullDisks {
protected:
  void
  SetUp() override
  {
    ASSERT_NO_FATAL_FAILURE(makeSceneDatabase({"torus"}, "20000"));
    ASSERT_EQ(run("generate", {"-out", path("s.pcd"), "-density", "60000", "torus"}).code, 0);
  }
};

} // namespace

TEST_F(FullDisks, ShapesDescriptorsAndReducedClouds)
{
  makeShapes();
  const std::string in = path("ball.pcd");
  for (const std::string name : {"new.pcd", "new.ply", "new.off"})
    expectRefused("generate_shape", {"cone", path(name)}, path(name));
  expectRefused("feature", {in, path("new.pcd")}, path("new.pcd"));
  expectRefused("reduce", {in, path("new.pcd"), "-leaf", "0.01"}, path("new.pcd"));
}

TEST_F(FullDisks, ADatabaseKeepsItsModels)
{
  makeDatabase();
  const std::string before = readFile(path("db.pcd"));
  const std::size_t there = files();
  const AppRun r = [&] {
    const FullDisk full(kSmall);
    return run("train",
               {"-database", path("db.pcd"), "-pairs", "1000", "-label", "new", path("ball.pcd")});
  }();
  EXPECT_TRUE(ended(r, 2, {path("db.pcd")}));
  EXPECT_TRUE(readFile(path("db.pcd")) == before);
  EXPECT_EQ(files(), there) << "no temporary and no lock is left";
}

TEST_F(FullDisks, GeneratedScenes)
{
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"-density", "5000", "cube"});
    return more;
  };
  expectRefused("generate", with({"-out", path("s.pcd")}), path("s.pcd"));
  // The scene comes first: the others fail for want of a place.
  for (const std::string option : {"-poses", "-empty"}) {
    fs::create_directories(path("taken"));
    EXPECT_TRUE(ended(run("generate", with({"-out", path("s.pcd"), option, path("taken")})), 2,
                      {path("taken"), "directory"}))
        << option;
  }
  fs::create_directories(path("models/cube.off"));
  EXPECT_TRUE(ended(run("generate", with({"-out", path("s.pcd"), "-models", path("models")})), 2,
                    {path("models/cube.off"), "directory"}));
  fs::create_directories(path("scans/scan_00.pcd"));
  EXPECT_TRUE(ended(
      run("generate", with({"-out", path("s.pcd"), "-views", "one", "-scans", path("scans")})), 2,
      {path("scans/scan_00.pcd"), "directory"}));
}

TEST_F(FullDiskScenes, InterpretedScenes)
{
  const std::vector<std::string> arguments = {
      "-database", path("db.pcd"), "-background", "exclude", "-planes",
      "1",         "-leaf",        "0.008",       "-csv",    path("s.pcd")};
  const auto with = [&](const std::string& option, const std::string& value) {
    auto all = arguments;
    all.insert(all.end(), {option, value});
    return all;
  };
  expectRefused("interpret", with("-out", path("new.pcd")), path("new.pcd"));
  expectRefused("interpret", with("-objects_dir", path("o")), path("o/s_1_torus.pcd"));
  expectRefused(
      "replay",
      {"-database", path("db.pcd"), "-leaf", "0.008", "-out", path("new.pcd"), path("s.pcd")},
      path("new.pcd"));
}

// VTK and Mesa leak, and reserve what sanitisers count.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(FullDiskScenes, Pictures)
{
  const Screen screen;
  expectRefused("view", {"-picture", path("new.png"), path("s.pcd")}, path("new.png"));
  writeFile(path("new.png"), "kept");
  const AppRun r = [&] {
    const FullDisk full(kSmall);
    return run("interpret", {"-database", path("db.pcd"), "-leaf", "0.008", "-picture",
                             path("new.png"), path("s.pcd")});
  }();
  EXPECT_TRUE(ended(r, 2, {"s.pcd", "space"}));
  EXPECT_EQ(readFile(path("new.png")), "kept");
}
#endif

TEST_F(FullDisks, ResultsOfExperiments)
{
  for (const std::string shape : {"sphere", "cup"})
    ASSERT_EQ(run("generate_shape", {shape, path(shape + ".off"), "-points", "500"}).code, 0);
  const std::vector<std::string> arguments = {"classification", "-meshes", path("."), "-objects",
                                              "sphere,cup",     "-tests",  "1",       "-out",
                                              path("e")};
  expectRefused("experiment", arguments, path("e/objects.pcd"));
  for (const std::string result : {"e/classification.csv", "e/classification_confusion.csv"}) {
    fs::create_directories(path(result));
    EXPECT_TRUE(ended(run("experiment", arguments), 2, {path(result), "directory"}));
    fs::remove(path(result));
  }
}

TEST_F(FullDisks, PicturesOfExperimentsAreWholeOrNotThere)
{
  const std::string picture = path("e/experiment_46.svg");
  fs::create_directories(path("e"));
  writeFile(picture, "kept");
  const std::vector<std::string> arguments = {
      "space", "-out", path("e"), "-saturations", "1", "-radii", "2", "-queries", "1"};
  const AppRun r = [&] {
    const FullDisk full(2000); // more than the table and the script, less than the picture
    return run("experiment", arguments);
  }();
  if (r.err.find("no picture") != std::string::npos)
    GTEST_SKIP() << "no gnuplot";
  EXPECT_TRUE(ended(r, 2, {picture, "space"}));
  EXPECT_EQ(readFile(picture), "kept");
  ASSERT_EQ(run("experiment", arguments).code, 0);
  EXPECT_NE(readFile(picture).find("</svg>"), std::string::npos);
}

TEST_F(FullDisks, AnInputIsNotOverwritten)
{
  makeShapes();
  fs::create_symlink(path("ball.pcd"), path("link.pcd"));
  const std::string before = readFile(path("ball.pcd"));
  for (const auto& out : {path("ball.pcd"), path("link.pcd"), path("./ball.pcd")}) {
    EXPECT_TRUE(ended(run("feature", {path("ball.pcd"), out}), 2, {out, "named twice"}));
    EXPECT_TRUE(
        ended(run("reduce", {path("ball.pcd"), out, "-leaf", "0.01"}), 2, {out, "named twice"}));
    EXPECT_TRUE(readFile(path("ball.pcd")) == before) << out;
  }
  // What is there from before, but named once, is replaced.
  EXPECT_TRUE(ended(run("feature", {path("ball.pcd"), path("h.pcd")}), 0, {}));
  EXPECT_TRUE(ended(run("feature", {path("ball.pcd"), path("h.pcd")}), 0, {}));
}

TEST_F(FullDisks, NoModelMayBeCalledUnknown)
{
  makeShapes();
  EXPECT_TRUE(ended(run("train", {"-database", path("new.pcd"), "-pairs", "1000", "-label",
                                  "unknown", path("ball.pcd")}),
                    1, {"unknown", "-label", "another"}));
  EXPECT_FALSE(fs::exists(path("new.pcd")));
}

TEST_F(FullDisks, TrainingsAtOnceLoseNoModel)
{
  makeShapes();
  constexpr int kPrograms = 6;
  std::vector<pid_t> children;
  for (int i = 0; i < kPrograms; ++i) {
    const pid_t child = ::fork();
    if (child == 0)
      ::_exit(run("train", {"-database", path("new.pcd"), "-pairs", "1000", "-label",
                            "ball" + std::to_string(i), path("ball.pcd")})
                  .code);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(parseCsv(run("info", {path("new.pcd"), "-csv"}).out).size(), 1u + kPrograms);
  EXPECT_FALSE(fs::exists(path("new.pcd.lock")));
}
