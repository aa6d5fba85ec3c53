#include "../comma_locale.h"
#include "../full_disk.h"
#include "../test_files.h"

#include "pcl_surflet/core/mesh_file.h"
#include "pcl_surflet/core/shapes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

using namespace pcl_surflet;
namespace fs = std::filesystem;

namespace {

class MeshFile : public test::FileTest {
protected:
  TriangleMesh
  load(const std::string& text)
  {
    test::writeFile(path("mesh.off"), text);
    return loadOff(path("mesh.off"));
  }

  /** \brief The message loading \p text fails with. */
  std::string
  failure(const std::string& text)
  {
    try {
      load(text);
    }
    catch (const MeshFileError& e) {
      return e.what();
    }
    return "no exception";
  }

  static std::string
  saveFailure(const TriangleMesh& mesh, const std::string& where)
  {
    try {
      saveOff(mesh, where);
    }
    catch (const MeshFileError& e) {
      return e.what();
    }
    return "no exception";
  }

  std::size_t
  filesInDirectory() const
  {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
};

const std::string kTriangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string
replaced(std::string text, const std::string& from, const std::string& to)
{
  return text.replace(text.find(from), from.size(), to);
}

void
expectTriangle(const TriangleMesh& mesh)
{
  EXPECT_EQ(mesh.vertices, (std::vector<TriangleMesh::Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<TriangleMesh::Triangle>{{0, 1, 2}}));
}

} // namespace

#define EXPECT_CONTAINS(text, part)                                                                \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

TEST_F(MeshFile, ReadsTheManyWaysToWriteOneTriangle)
{
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string& text :
       {kTriangle, "OFF 3 1 0\n" + body, "OFF3 1 0\n" + body, "OFF\n3 1\n" + body,
        std::string("# made by hand\n\n  OFF # keyword\n# counts\n\n3 1 0 # three\n0 0 0 # "
                    "origin\n\n1 0 0\n"
                    "#\n0 1 0\n\n3 0 1 2"),
        std::string("\xef\xbb\xbf") + kTriangle, kTriangle + "left over text 1 2 3\n",
        std::string("OFF\n3 1 0\n0\n0 0\n+1e0 -0.0 0.0e5\n0.000 1.0E+0 1e-400\n3 0\n1 2\n")}) {
    SCOPED_TRACE(text);
    expectTriangle(load(text));
  }
}

TEST_F(MeshFile, ReadsForeignLineEnds)
{
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : kTriangle)
      text += c == '\n' ? end : std::string(1, c);
    expectTriangle(load(text));
  }
}

TEST_F(MeshFile, IgnoresColoursNormalsAndTextureCoordinates)
{
  expectTriangle(load("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0.5 1 0\n0 1 0 1\n3 0 1 2 9 9 9\n"));
  expectTriangle(load("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 0.1 0.2\n"));
  expectTriangle(load("STOFF\n3 1 0\n0 0 0 0 1\n1 0 0 0 1\n0 1 0 0 1\n3 0 1 2\n"));
  expectTriangle(load("STCNOFF 3 1 0\n0 0 0 0 0 1 9 9 9 9 1 1\n1 0 0 0\n0 1 0 0\n3 0 1 2 red\n"));
}

TEST_F(MeshFile, SplitsPolygonsIntoFansAndSkipsEdges)
{
  const TriangleMesh mesh = load("OFF\n5 4 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n"
                                 "5 0 1 2 3 4\n2 0 1\n1 3\n4 3 2 1 0\n");
  EXPECT_EQ(mesh.triangles, (std::vector<TriangleMesh::Triangle>{
                                {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {3, 2, 1}, {3, 1, 0}}));
}

TEST_F(MeshFile, PointsAloneAreAMeshThatCannotBeSampled)
{
  const TriangleMesh mesh = load("OFF\n2 0 0\n1 2 3\n4 5 6\n");
  EXPECT_EQ(mesh.vertices.size(), 2u);
  EXPECT_CONTAINS(mesh.problem(), "no triangles");
}

TEST_F(MeshFile, ReadsAndWritesTheSameInEveryLocale)
{
  TriangleMesh mesh;
  {
    const test::CommaLocale comma;
    mesh = load(replaced(kTriangle, "1 0 0", "1.5 0 0"));
    mesh.vertices.resize(1234, {0.25f, 1e6f, 0});
    saveOff(mesh, path("saved.off"));
  }
  EXPECT_EQ(mesh.vertices[1][0], 1.5f);
  EXPECT_CONTAINS(test::readFile(path("saved.off")), "1234 1 0\n");
  EXPECT_CONTAINS(test::readFile(path("saved.off")), "1.5 0 0\n");
  EXPECT_EQ(loadOff(path("saved.off")).vertices, mesh.vertices);
}

TEST_F(MeshFile, NamesFileLineCauseAndRemedy)
{
  const std::string message = failure(replaced(kTriangle, "0 1 0", "0 one 0"));
  EXPECT_CONTAINS(message, path("mesh.off") + ":5: ");
  EXPECT_CONTAINS(message, "y of vertex 2 is 'one', not a number");
  EXPECT_CONTAINS(message, "export the mesh again");
}

TEST_F(MeshFile, CountsForeignLineEndsOnce)
{
  std::string text;
  for (const char c : replaced(kTriangle, "0 1 0", "0 one 0"))
    text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_CONTAINS(failure(text), ":5: ");
}

TEST_F(MeshFile, APipeIsRefusedWithoutWaiting)
{
  ASSERT_EQ(::mkfifo(path("pipe.off").c_str(), 0600), 0);
  try {
    loadOff(path("pipe.off"));
    FAIL();
  }
  catch (const MeshFileError& e) {
    EXPECT_CONTAINS(e.what(), "no regular file");
  }
}

TEST_F(MeshFile, AFileThatMustNotBeWrittenStays)
{
  const TriangleMesh mesh = meshOfShape(Shape::box(1, 1, 1), 0.5);
  test::writeFile(path("m.off"), "kept");
  std::filesystem::permissions(directory_, std::filesystem::perms::all);
  std::filesystem::permissions(path("m.off"), std::filesystem::perms::owner_read |
                                                  std::filesystem::perms::others_read);
  const uid_t me = ::geteuid();
  ASSERT_EQ(::seteuid(me == 0 ? 65534 : me), 0); // root may write everywhere: be nobody
  std::string message;
  try {
    saveOff(mesh, path("m.off"));
  }
  catch (const MeshFileError& e) {
    message = e.what();
  }
  ASSERT_EQ(::seteuid(me), 0);
  EXPECT_CONTAINS(message, "ermission");
  EXPECT_EQ(test::readFile(path("m.off")), "kept");
}

TEST_F(MeshFile, RefusesWhatIsNotThere)
{
  try {
    loadOff(path("absent.off"));
    FAIL();
  }
  catch (const MeshFileError& e) {
    EXPECT_CONTAINS(e.what(), path("absent.off") + ": there is no such file");
  }
  try {
    loadOff(directory_.string());
    FAIL();
  }
  catch (const MeshFileError& e) {
    EXPECT_CONTAINS(e.what(), "is a directory");
  }
}

TEST_F(MeshFile, RefusesOtherFormats)
{
  EXPECT_CONTAINS(failure(""), "the file is empty");
  EXPECT_CONTAINS(failure("  \n# only a comment\n"), "the file is empty");
  EXPECT_CONTAINS(failure("ply\nformat ascii 1.0\n"), "not an OFF file: it begins with 'ply'");
  EXPECT_CONTAINS(failure("OFFICE 3 1 0\n"), "not an OFF file");
  EXPECT_CONTAINS(failure("C\n"), "not an OFF file");
  EXPECT_CONTAINS(failure(std::string(100000, '\x07')), "no text file");
  EXPECT_CONTAINS(failure(std::string(3000, '\0')), "no text file");
  EXPECT_CONTAINS(failure("OFF BINARY\n3 1 0\n"), "binary OFF is not supported");
  EXPECT_CONTAINS(failure("COFF BINARY\n"), "binary OFF is not supported");
  EXPECT_CONTAINS(failure("4OFF\n3 1 0\n"), "other than three coordinates");
  EXPECT_CONTAINS(failure("nOFF\n4\n3 1 0\n"), "other than three coordinates");
}

TEST_F(MeshFile, RefusesTruncatedFilesAtEveryToken)
{
  // Cut anywhere before the last token begins: always an error, never a mesh.
  for (std::size_t n = 0; n <= kTriangle.rfind('2'); ++n)
    EXPECT_NE(failure(kTriangle.substr(0, n)), "no exception") << n;
  EXPECT_CONTAINS(failure("OFF"), "ends after its keyword");
  EXPECT_CONTAINS(failure("OFF\n3"), "the file ends where the number of faces should be");
  EXPECT_CONTAINS(failure("OFF\n3 1 0\n0 0 0\n1 0"), "the file ends where z of vertex 1 should be");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2\n", "3 0 1")),
                  "the file ends where an index of face 0 should be");
}

TEST_F(MeshFile, DoesNotBelieveAbsurdCounts)
{
  EXPECT_CONTAINS(failure("OFF 4000000000 1 0\n0 0 0\n"), "the file ends");
  EXPECT_CONTAINS(failure("OFF 0 4000000000 0\n"), "the file ends");
  EXPECT_CONTAINS(failure("OFF 5000000000 1 0\n"), "more than 2^32 - 1");
  EXPECT_CONTAINS(failure("OFF 3 5000000000 0\n"), "more than 2^32 - 1");
  EXPECT_CONTAINS(failure("OFF 99999999999999999999999 1 0\n"), "absurdly large");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "4000000000 0 1 2")), "the file ends");
  EXPECT_CONTAINS(failure("OFF -3 1 0\n"), "not a whole number");
  EXPECT_CONTAINS(failure("OFF 3.5 1 0\n"), "not a whole number");
  EXPECT_CONTAINS(failure("OFF many 1 0\n"), "'many', not a whole number");
}

TEST_F(MeshFile, RefusesIndicesWithoutVertex)
{
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "3 0 1 3")),
                  "an index of face 0 is 3, but there are only 3 vertices");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "3 0 4294967296 2")), "only 3 vertices");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "3 0 -1 2")), "not a whole number");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "3 0 1.0 2")), "not a whole number");
  EXPECT_CONTAINS(failure(replaced(kTriangle, "3 0 1 2", "2 0 7")), "only 3 vertices");
}

TEST_F(MeshFile, RefusesCoordinatesThatAreNoNumbers)
{
  for (const std::string bad : {"abc", "1,5", "0x10", "1e", "--1", "+", "1.0.0", "\x01\x02"})
    EXPECT_CONTAINS(failure(replaced(kTriangle, "1 0 0", bad + " 0 0")), "not a number");
  for (const std::string bad : {"nan", "inf", "-inf", "1e39", "-1e39", "1e999", "infinity"})
    EXPECT_CONTAINS(failure(replaced(kTriangle, "1 0 0", bad + " 0 0")), "not finite");
}

TEST_F(MeshFile, SurvivesEveryByteReplaced)
{
  for (std::size_t i = 0; i < kTriangle.size(); ++i)
    for (int c = 0; c < 256; ++c) {
      std::string text = kTriangle;
      text[i] = static_cast<char>(c);
      try {
        const TriangleMesh mesh = load(text);
        EXPECT_LE(mesh.vertices.size(), 3u);
      }
      catch (const MeshFileError&) {
      }
    }
}

TEST_F(MeshFile, GivesBackWhatWasSaved)
{
  TriangleMesh mesh = meshOfShape(*shapeByName("wine_glass"), 0.02);
  mesh.vertices.push_back({1e-45f, -3.4028235e38f, 0.1f});
  saveOff(mesh, path("saved.off"));
  const TriangleMesh back = loadOff(path("saved.off"));
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(filesInDirectory(), 1u);
}

TEST_F(MeshFile, OverwritesKeepingLinksAndPermissions)
{
  const TriangleMesh mesh = load(kTriangle);
  test::writeFile(path("old.off"), "old");
  fs::permissions(path("old.off"), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("old.off", path("link.off"));
  saveOff(mesh, path("link.off"));
  EXPECT_TRUE(fs::is_symlink(path("link.off")));
  expectTriangle(loadOff(path("old.off")));
  EXPECT_EQ(fs::status(path("old.off")).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(MeshFile, ReportsWhatCannotBeWritten)
{
  const TriangleMesh mesh = load(kTriangle);
  EXPECT_CONTAINS(saveFailure(mesh, path("absent/mesh.off")), "cannot be written");
  EXPECT_CONTAINS(saveFailure(mesh, directory_.string()), "it is a directory");
  TriangleMesh bad = mesh;
  bad.triangles[0][2] = 3;
  EXPECT_CONTAINS(saveFailure(bad, path("bad.off")), "not written: triangle 0 refers to vertex 3");
  bad = mesh;
  bad.vertices[1][0] = std::numeric_limits<float>::infinity();
  EXPECT_CONTAINS(saveFailure(bad, path("bad.off")), "not finite");
  EXPECT_FALSE(fs::exists(path("bad.off")));
}

TEST_F(MeshFile, KeepsTheOldFileWhenWritingFails)
{
  const TriangleMesh mesh = meshOfShape(*shapeByName("torus"), 0.01);
  test::writeFile(path("old.off"), "old");
  const std::string message = [&] {
    const test::FullDisk full(4096);
    return saveFailure(mesh, path("old.off"));
  }();
  EXPECT_CONTAINS(message, "File too large");
  EXPECT_CONTAINS(message, "free space");
  EXPECT_EQ(test::readFile(path("old.off")), "old");
  EXPECT_EQ(filesInDirectory(), 1u);
}

TEST_F(MeshFile, WritesToPipesAndDevicesWithoutReplacingThem)
{
  const TriangleMesh mesh = load(kTriangle);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  saveOff(mesh, path("pipe"));
  char text[100] = {};
  EXPECT_GT(::read(reader, text, sizeof text - 1), 0);
  ::close(reader);
  EXPECT_CONTAINS(text, "3 0 1 2");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  // A full device of our own: code that fails this test as root would replace the system's.
  const int made = ::mknod(path("full").c_str(), S_IFCHR | 0600, ::makedev(1, 7));
  const int full = made == 0 ? ::open(path("full").c_str(), O_WRONLY) : -1;
  if (full < 0)
    GTEST_SKIP() << "devices cannot be made here";
  ::close(full);
  EXPECT_CONTAINS(saveFailure(mesh, path("full")), "No space left");
  EXPECT_TRUE(fs::is_character_file(path("full")));
}
