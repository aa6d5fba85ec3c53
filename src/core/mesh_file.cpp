#include "pcl_surflet/core/mesh_file.h"

#include "atomic_file.h"
#include "mesh_checks.h"
#include "off_scanner.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace pcl_surflet {

using detail::forMessage;
using detail::OffScanner;

namespace {

constexpr std::uint64_t kMaxElements = std::numeric_limits<std::uint32_t>::max();

/** \brief Memory is reserved for at most this many elements before any of them was read. */
constexpr std::uint64_t kMaxReserved = 1 << 16;

struct OffCounts {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

/** \brief Length of the keyword's prefix of [ST], [C] and [N] (in either order), without "OFF". */
std::size_t
prefixLength(const std::string& keyword)
{
  std::size_t n = keyword.compare(0, 2, "ST") == 0 ? 2 : 0;
  for (int i = 0; i < 2 && n < keyword.size(); ++i)
    if (keyword[n] == 'C' || keyword[n] == 'N')
      ++n;
  return n;
}

/** \brief Reads the keyword; returns what sticks to it ("8" of "OFF8"), normally nothing. */
std::string
readKeyword(OffScanner& scanner)
{
  const std::string remedy = "give an ASCII OFF file, or export the mesh as one";
  std::string token;
  if (!scanner.next(token))
    scanner.fail("the file is empty", remedy);
  if (token.compare(0, 3, "\xef\xbb\xbf") == 0) // byte order mark
    token.erase(0, 3);
  const std::string keyword = token.substr(prefixLength(token));
  for (const char* other : {"4OFF", "nOFF", "4nOFF"})
    if (keyword == other)
      scanner.fail(forMessage(token) + " holds vertices of other than three coordinates", remedy);
  if (keyword.compare(0, 3, "OFF") != 0 ||
      keyword.find_first_not_of("0123456789", 3) != std::string::npos)
    scanner.fail("not an OFF file: it begins with " + forMessage(token) + ", not with OFF", remedy);
  return keyword.substr(3);
}

OffCounts
readHeader(OffScanner& scanner)
{
  std::string token = readKeyword(scanner);
  if (token.empty() && !scanner.next(token))
    scanner.fail("the file ends after its keyword", "it is truncated; export the mesh again");
  if (token == "BINARY")
    scanner.fail("binary OFF is not supported", "export the mesh as ASCII OFF");
  OffCounts counts;
  counts.vertices = scanner.parseCount(token, "the number of vertices");
  counts.faces = scanner.count("the number of faces");
  if (std::max(counts.vertices, counts.faces) > kMaxElements)
    scanner.fail("the header claims " + std::to_string(counts.vertices) + " vertices and " +
                     std::to_string(counts.faces) + " faces, more than 2^32 - 1",
                 "correct the counts or export the mesh again");
  scanner.skipLine(); // the number of edges, which nobody needs
  return counts;
}

void
readVertices(OffScanner& scanner, std::uint64_t count, TriangleMesh& mesh)
{
  mesh.vertices.reserve(static_cast<std::size_t>(std::min(count, kMaxReserved)));
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string what = " of vertex " + std::to_string(i);
    TriangleMesh::Point p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = scanner.coordinate("xyz"[k] + what);
    mesh.vertices.push_back(p);
    scanner.skipLine();
  }
}

std::uint32_t
readIndex(OffScanner& scanner, const std::string& what, std::size_t vertices)
{
  const std::uint64_t index = scanner.count(what);
  if (index >= vertices)
    scanner.fail(what + " is " + std::to_string(index) + ", but there are only " +
                     std::to_string(vertices) + " vertices (counted from 0)",
                 "correct it or export the mesh again");
  return static_cast<std::uint32_t>(index);
}

void
readFaces(OffScanner& scanner, std::uint64_t count, TriangleMesh& mesh)
{
  mesh.triangles.reserve(static_cast<std::size_t>(std::min(count, kMaxReserved)));
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string face = " of face " + std::to_string(i);
    const std::uint64_t corners = scanner.count("the number of vertices" + face);
    std::uint32_t first = 0, previous = 0;
    for (std::uint64_t k = 0; k < corners; ++k) {
      const std::uint32_t v = readIndex(scanner, "an index" + face, mesh.vertices.size());
      if (k == 0)
        first = v;
      if (k >= 2)
        mesh.triangles.push_back({first, previous, v});
      previous = v;
    }
    scanner.skipLine();
  }
}

template <typename Number>
void
append(std::string& text, Number value, char separator)
{
  // The shortest text that reads back as the same value, in every locale.
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
  text += separator;
}

std::string
offText(const TriangleMesh& mesh)
{
  std::string text = "OFF\n";
  append(text, mesh.vertices.size(), ' ');
  append(text, mesh.triangles.size(), ' ');
  text += "0\n";
  for (const auto& p : mesh.vertices) {
    append(text, p[0], ' ');
    append(text, p[1], ' ');
    append(text, p[2], '\n');
  }
  for (const auto& t : mesh.triangles) {
    text += "3 ";
    append(text, t[0], ' ');
    append(text, t[1], ' ');
    append(text, t[2], '\n');
  }
  return text;
}

} // namespace

TriangleMesh
loadOff(const std::string& path)
{
  OffScanner scanner(path);
  const OffCounts counts = readHeader(scanner);
  TriangleMesh mesh;
  readVertices(scanner, counts.vertices, mesh);
  readFaces(scanner, counts.faces, mesh);
  return mesh;
}

void
saveOff(const TriangleMesh& mesh, const std::string& path)
{
  std::string cause = detail::indexProblem(mesh);
  if (cause.empty())
    cause = detail::coordinateProblem(mesh);
  if (!cause.empty())
    throw MeshFileError(path + ": not written: " + cause);
  cause = detail::replaceFile(path, offText(mesh));
  if (!cause.empty())
    throw MeshFileError(path + ": cannot be written: " + cause);
}

} // namespace pcl_surflet
