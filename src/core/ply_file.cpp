#include "mesh_readers.h"
#include "off_scanner.h"
#include "pcl_surflet/core/mesh_file.h"
#include "ply_header.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace pcl_surflet {
namespace detail {
namespace {

std::size_t
sizeOf(PlyType type)
{
  switch (type) {
  case PlyType::Int8:
  case PlyType::Uint8:
    return 1;
  case PlyType::Int16:
  case PlyType::Uint16:
    return 2;
  case PlyType::Float64:
    return 8;
  default:
    return 4;
  }
}

template <typename T>
double
as(const char* bytes)
{
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double
decode(PlyType type, const char* bytes)
{
  switch (type) {
  case PlyType::Int8:
    return as<std::int8_t>(bytes);
  case PlyType::Uint8:
    return as<std::uint8_t>(bytes);
  case PlyType::Int16:
    return as<std::int16_t>(bytes);
  case PlyType::Uint16:
    return as<std::uint16_t>(bytes);
  case PlyType::Int32:
    return as<std::int32_t>(bytes);
  case PlyType::Uint32:
    return as<std::uint32_t>(bytes);
  case PlyType::Float32:
    return as<float>(bytes);
  case PlyType::Float64:
    return as<double>(bytes);
  }
  return 0;
}

/** \brief The values behind the header, one after the other. */
class PlyBody {
public:
  PlyBody(const std::string& path, std::string_view data, PlyFormat format)
      : path_(path), data_(data), lines_(path, data), format_(format)
  {
  }

  void
  enter(const PlyElement& element, std::uint64_t number)
  {
    element_ = &element;
    number_ = number;
  }

  double
  value(PlyType type)
  {
    if (format_ == PlyFormat::Ascii)
      return lines_.number(token());
    const std::size_t size = sizeOf(type);
    if (data_.size() < size)
      failAtEnd();
    char bytes[8];
    std::copy_n(data_.data(), size, bytes);
    data_.remove_prefix(size);
    if (format_ == PlyFormat::BigEndian) // this library runs on little-endian machines, as PCL does
      std::reverse(bytes, bytes + size);
    return decode(type, bytes);
  }

  [[noreturn]] void
  fail(const std::string& cause) const
  {
    throw MeshFileError(path_ + ", element " + forMessage(element_->name) + " " +
                        std::to_string(number_) + ": " + cause +
                        "; correct it or export the file again");
  }

private:
  std::string_view
  token()
  {
    if (next_ == tokens_.size()) {
      next_ = 0;
      if (!lines_.next(tokens_))
        failAtEnd();
    }
    return tokens_[next_++];
  }

  [[noreturn]] void
  failAtEnd() const
  {
    throw MeshFileError(path_ + ": the file ends after " + std::to_string(number_) + " of the " +
                        std::to_string(element_->count) + " " + forMessage(element_->name) +
                        " elements that its header claims; it is truncated, export it again");
  }

  std::string path_;
  std::string_view data_;
  TextLines lines_;
  PlyFormat format_;
  std::vector<std::string_view> tokens_;
  std::size_t next_ = 0;
  const PlyElement* element_ = nullptr;
  std::uint64_t number_ = 0;
};

std::uint64_t
listLength(PlyBody& body, PlyType type)
{
  const double length = body.value(type);
  if (!(length >= 0) || length > 4294967295.0 || length != std::floor(length))
    body.fail("a list has the impossible length " + std::to_string(length));
  return static_cast<std::uint64_t>(length);
}

/** \brief Place of a vertex property among x y z nx ny nz, or -1. */
int
slotOf(const std::string& name)
{
  static const std::map<std::string, int> slots = {
      {"x", 0},  {"y", 1},        {"z", 2},        {"nx", 3},      {"ny", 4},
      {"nz", 5}, {"normal_x", 3}, {"normal_y", 4}, {"normal_z", 5}};
  const auto found = slots.find(name);
  return found == slots.end() ? -1 : found->second;
}

void
readVertices(PlyBody& body, const PlyElement& element, PlyContent& content)
{
  std::vector<int> slots;
  unsigned present = 0;
  for (const auto& property : element.properties) {
    slots.push_back(property.count_type ? -1 : slotOf(property.name));
    if (slots.back() >= 0)
      present |= 1u << slots.back();
  }
  body.enter(element, 0);
  if ((present & 7u) != 7u)
    body.fail("vertices have no x, y and z");
  const bool normals = (present >> 3) == 7u;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.enter(element, i);
    float v[6] = {};
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const auto& property = element.properties[k];
      const std::uint64_t n = property.count_type ? listLength(body, *property.count_type) : 1;
      for (std::uint64_t j = 0; j < n; ++j) {
        const double value = body.value(property.type);
        if (slots[k] >= 0)
          v[slots[k]] = static_cast<float>(value);
      }
    }
    content.mesh.vertices.push_back({v[0], v[1], v[2]});
    if (normals)
      content.normals.push_back({v[3], v[4], v[5]});
  }
}

/** \brief Reads a list of vertex indices and appends its fan. */
void
readFan(PlyBody& body, const PlyProperty& property, TriangleMesh& mesh)
{
  const std::uint64_t corners = listLength(body, *property.count_type);
  std::uint32_t first = 0, previous = 0;
  for (std::uint64_t k = 0; k < corners; ++k) {
    const double index = body.value(property.type);
    if (!(index >= 0) || index >= static_cast<double>(mesh.vertices.size()))
      body.fail("an index of a vertex is out of range: there are " +
                std::to_string(mesh.vertices.size()) + " before it");
    const auto v = static_cast<std::uint32_t>(index);
    if (k == 0)
      first = v;
    if (k >= 2)
      mesh.triangles.push_back({first, previous, v});
    previous = v;
  }
}

void
readElement(PlyBody& body, const PlyElement& element, PlyContent& content)
{
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.enter(element, i);
    for (const auto& property : element.properties) {
      if (element.name == "face" && property.count_type &&
          (property.name == "vertex_indices" || property.name == "vertex_index")) {
        readFan(body, property, content.mesh);
        continue;
      }
      const std::uint64_t n = property.count_type ? listLength(body, *property.count_type) : 1;
      for (std::uint64_t j = 0; j < n; ++j)
        body.value(property.type);
    }
  }
}

} // namespace

PlyContent
loadPly(const std::string& path)
{
  const std::string data = fileContent(path);
  TextLines lines(path, data);
  const PlyHeader header = readPlyHeader(lines);
  PlyBody body(path, std::string_view(data).substr(lines.position()), header.format);
  PlyContent content;
  for (const auto& element : header.elements)
    if (element.name == "vertex" && content.mesh.vertices.empty())
      readVertices(body, element, content);
    else
      readElement(body, element, content);
  if (content.mesh.vertices.empty())
    throw MeshFileError(path + ": the file has no vertices; export it again");
  return content;
}

} // namespace detail
} // namespace pcl_surflet
