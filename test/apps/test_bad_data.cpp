// Files that are missing, damaged or hostile, and disks that are full.
#include "app_runner.h"

#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <sstream>

#include <sys/stat.h>
#include <unistd.h>

using namespace pcl_surflet::test;

namespace fs = std::filesystem;

namespace {

class BadData : public Apps {
protected:
  AppRun
  train(std::vector<std::string> files)
  {
    files.insert(files.begin(), {"-database", path("new.pcd"), "-pairs", "50000"});
    return run("train", files);
  }
};

/** \brief Where the fields of a binary PCD of one point or more begin. */
std::map<std::string, std::size_t>
fieldOffsets(const std::string& pcd)
{
  const auto words = [&](const std::string& key) {
    std::istringstream line(pcd.substr(pcd.find("\n" + key + " ") + key.size() + 2));
    std::string text, word;
    std::getline(line, text);
    std::istringstream in(text);
    std::vector<std::string> out;
    while (in >> word)
      out.push_back(word);
    return out;
  };
  const auto names = words("FIELDS"), sizes = words("SIZE"), counts = words("COUNT");
  std::map<std::string, std::size_t> offsets;
  std::size_t at = pcd.find("DATA binary\n") + 12;
  for (std::size_t i = 0; i < names.size(); ++i) {
    offsets[names[i]] = at;
    at += std::stoul(sizes[i]) * std::stoul(counts[i]);
  }
  return offsets;
}

template <typename T>
std::string
bytes(T value)
{
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  return out;
}

} // namespace

TEST_F(BadData, EveryProgramNamesTheFileItCannotUse)
{
  makeDatabase();
  const std::string good = readFile(path("ball.pcd"));
  writeFile(path("empty.pcd"), "");
  writeFile(path("garbage.pcd"), std::string(5000, '\xfe'));
  writeFile(path("truncated.pcd"), good.substr(0, good.size() / 2));
  writeFile(path("kind.xyz"), good);
  fs::create_directory(path("directory.pcd"));
  ASSERT_EQ(::mkfifo(path("pipe.pcd").c_str(), 0600), 0);
  for (const std::string name : {"missing.pcd", "empty.pcd", "garbage.pcd", "truncated.pcd",
                                 "kind.xyz", "directory.pcd", "pipe.pcd"}) {
    const std::string file = path(name);
    EXPECT_TRUE(ended(train({file}), 2, {file, ";"})) << name;
    EXPECT_FALSE(fs::exists(path("new.pcd"))) << name;
    EXPECT_TRUE(ended(run("classify", {"-database", path("db.pcd"), file}), 2, {file, ";"}))
        << name;
    EXPECT_TRUE(ended(run("feature", {file, path("out.pcd")}), 2, {file, ";"})) << name;
    EXPECT_FALSE(fs::exists(path("out.pcd"))) << name;
    if (name == "kind.xyz")
      continue; // a database may be called anything
    EXPECT_TRUE(ended(run("info", {file}), 2, {file, "pcl_surflet_train"})) << name;
    EXPECT_TRUE(ended(run("classify", {"-database", file, path("ball.pcd")}), 2, {file})) << name;
  }
}

TEST_F(BadData, HostileHeadersAreRefusedAtOnce)
{
  const std::string pcd = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\n"
                          "SIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
                          "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\n";
  writeFile(path("ascii.pcd"), pcd + "DATA ascii\n0 0 0 0 0 1\n");
  writeFile(path("binary.pcd"), pcd + "DATA binary\n0 0 0 0 0 1\n");
  writeFile(path("packed.pcd"),
            pcd + "DATA binary_compressed\n" + bytes(4u) + bytes(4000000000u) + "abcd");
  writeFile(path("vertices.ply"), "ply\nformat ascii 1.0\nelement vertex 4000000000\n"
                                  "property float x\nproperty float y\nproperty float z\n"
                                  "end_header\n1 2 3\n");
  writeFile(path("off.off"), "OFF 4000000000 4000000000 0\n0 0 0\n");
  writeFile(path("stl.stl"), std::string(80, 'x') + bytes(4000000000u) + std::string(100, '\0'));
  for (const std::string name :
       {"ascii.pcd", "binary.pcd", "packed.pcd", "vertices.ply", "off.off", "stl.stl"})
    EXPECT_TRUE(ended(train({path(name)}), 2, {path(name), ";"})) << name;
}

TEST_F(BadData, CloudsWithoutAnyUsablePointOrPair)
{
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nproperty float nx\n"
                          "property float ny\nproperty float nz\nend_header\n";
  writeFile(path("nan.ply"), ply + "nan nan nan 0 0 1\nnan 0 0 0 0 1\n0 nan 0 0 0 1\n");
  writeFile(path("same.ply"), ply + "1 2 3 0 0 1\n1 2 3 0 0 1\n1 2 3 0 0 1\n");
  makeDatabase();
  for (const std::string name : {"nan.ply", "same.ply"}) {
    EXPECT_TRUE(ended(train({path(name)}), 2, {path(name)})) << name;
    EXPECT_TRUE(ended(run("classify", {"-database", path("db.pcd"), path(name)}), 2, {path(name)}))
        << name;
    EXPECT_TRUE(ended(run("feature", {path(name), path("out.pcd")}), 2, {path(name)})) << name;
  }
}

TEST_F(BadData, NamesTooLongForALabel)
{
  makeShapes();
  const std::string file = path(std::string(64, 'x') + ".pcd");
  fs::copy_file(path("ball.pcd"), file);
  EXPECT_TRUE(ended(train({file}), 2, {file, "-label"}));
  EXPECT_TRUE(ended(train({"-label", "x", file}), 0, {"added 'x'"}));
}

TEST_F(BadData, BatchesGoOnPastBadFiles)
{
  makeDatabase();
  writeFile(path("bad.ply"), "ply\nnonsense\n");
  AppRun r = train({path("bad.ply"), path("ball.pcd"), path("missing.off"), path("cup.off")});
  EXPECT_TRUE(ended(
      r, 2, {path("bad.ply"), "added 'ball'", path("missing.off"), "added 'cup'", "2 of 4 files"}));
  EXPECT_EQ(parseCsv(run("info", {path("new.pcd"), "-csv"}).out).size(), 3u);
  r = run("classify", {"-database", path("db.pcd"), "-csv", "-top", "1", path("bad.ply"),
                       path("ball.pcd"), path("missing.off"), path("cup.off")});
  EXPECT_TRUE(ended(r, 2, {path("bad.ply"), path("missing.off"), "2 of 4 files"}));
  const auto rows = parseCsv(r.out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][0], path("ball.pcd"));
  EXPECT_EQ(rows[2][1], "cup");
}

TEST_F(BadData, FullStandardOutput)
{
  makeDatabase();
  EXPECT_TRUE(ended(run("info", {path("db.pcd")}, "/dev/full"), 2, {"standard output"}));
  EXPECT_TRUE(ended(run("info", {"-h"}, "/dev/full"), 2, {"standard output"}));
  EXPECT_TRUE(ended(run("classify", {"-database", path("db.pcd"), path("ball.pcd")}, "/dev/full"),
                    2, {"standard output"}));
}

TEST_F(BadData, UnwritablePlaces)
{
  makeShapes();
  const std::string nowhere = path("no/such/directory/out.pcd");
  EXPECT_TRUE(ended(run("feature", {path("ball.pcd"), nowhere}), 2, {nowhere, "directory"}));
  EXPECT_TRUE(ended(run("generate_shape", {"cone", nowhere}), 2, {nowhere, "directory"}));
  EXPECT_TRUE(
      ended(run("train", {"-database", nowhere, path("ball.pcd")}), 2, {nowhere, "directory"}));
  const std::string directory = directory_.string();
  EXPECT_TRUE(ended(run("feature", {path("ball.pcd"), directory}), 2, {directory, "directory"}));
  EXPECT_TRUE(ended(run("train", {"-database", directory, path("ball.pcd")}), 2, {directory}));
}

TEST_F(BadData, TextsThatAreNoFilesAreRefusedWithoutWaiting)
{
  makeDatabase();
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_directory(path("d"));
  const std::vector<std::pair<std::string, std::string>> wrong = {{path("pipe"), "no regular file"},
                                                                  {path("d"), "directory"},
                                                                  {"/dev/zero", "no regular file"},
                                                                  {path("none"), "no such file"}};
  for (const auto& [text, cause] : wrong) {
    EXPECT_TRUE(ended(run("train", {"-database", path("new.pcd"), "-bank", text, path("ball.pcd")}),
                      2, {text, cause}));
    EXPECT_TRUE(
        ended(run("search", {"-database", path("db.pcd"), "-classes", text}), 2, {text, cause}));
  }
}

TEST_F(BadData, WhatCannotBeWrittenIsKnownBeforeTheWork)
{
  const auto generated = [&](const std::string& option, const std::string& file) {
    return run("generate", {"-out", path("s.pcd"), "-density", "5000", option, file, "cube"});
  };
  EXPECT_TRUE(ended(generated("-empty", path("s.pcd")), 2, {path("s.pcd"), "named twice"}));
  EXPECT_TRUE(ended(generated("-poses", path("none/p.csv")), 2, {path("none/p.csv"), "directory"}));
  EXPECT_FALSE(fs::exists(path("s.pcd"))) << "nothing is left half done";
}

TEST_F(BadData, ReadOnlyDirectory)
{
  std::vector<std::string> command;
  if (::geteuid() == 0) { // root may write everywhere, but for what is asked for here
    command = {"/usr/bin/setpriv", "--bounding-set", "-dac_override"};
    if (Running({command[0], command[1], command[2], "/bin/true"}).wait().code != 0)
      GTEST_SKIP() << "root cannot give up its rights here";
  }
  makeDatabase();
  const std::string before = readFile(path("db.pcd"));
  command.insert(command.end(), {appPath("train"), "-database", path("db.pcd"), path("ball.pcd")});
  fs::permissions(directory_, fs::perms::owner_read | fs::perms::owner_exec);
  const AppRun r = Running(command).wait();
  fs::permissions(directory_, fs::perms::owner_all);
  EXPECT_TRUE(ended(r, 2, {path("db.pcd"), "permissions"}));
  EXPECT_EQ(readFile(path("db.pcd")), before);
}

TEST_F(BadData, ADamagedDatabaseIsNeitherUsedNorOverwritten)
{
  makeDatabase();
  const std::string good = readFile(path("db.pcd"));
  const auto at = fieldOffsets(good);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"format_version", bytes(2u)},
      {"label", std::string(64, 'a')},
      {"label", std::string(64, '\0')},
      {"condition", std::string(64, 'a')},
      {"role", bytes(2u)},
      {"member", bytes(7u)},
      {"resolution", bytes(0u)},
      {"resolution", bytes(6u)},
      {"resolution", bytes(4000000000u)},
      {"delta_max", bytes(nan)},
      {"delta_max", bytes(-1.0)},
      {"r_mean", bytes(1e9)},
      {"r_max", bytes(nan)},
      {"r_min", bytes(1e9)},
      {"surface_area", bytes(-1.0)},
      {"features", bytes(nan)},
      {"tau", bytes(2.0)},
      {"floor", bytes(nan)},
      {"histogram", bytes(std::numeric_limits<float>::quiet_NaN())},
      {"histogram", bytes(-1.0f)},
      {"histogram", bytes(100.0f)}};
  for (const auto& [field, damage] : damages) {
    std::string bad = good;
    bad.replace(at.at(field), damage.size(), damage);
    writeFile(path("bad.pcd"), bad);
    EXPECT_TRUE(ended(run("info", {path("bad.pcd")}), 2, {path("bad.pcd"), ";"})) << field;
    EXPECT_TRUE(
        ended(run("train", {"-database", path("bad.pcd"), path("ball.pcd")}), 2, {path("bad.pcd")}))
        << field;
    EXPECT_TRUE(readFile(path("bad.pcd")) == bad) << field;
  }
}

TEST_F(BadData, ATruncatedDatabaseIsRefusedAtEveryLength)
{
  makeDatabase();
  const std::string good = readFile(path("db.pcd"));
  for (std::size_t length = 0; length < good.size(); length += 1 + length / 4) {
    writeFile(path("bad.pcd"), good.substr(0, length));
    EXPECT_TRUE(ended(run("info", {path("bad.pcd")}), 2, {path("bad.pcd"), ";"})) << length;
  }
}
