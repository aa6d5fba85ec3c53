#include "ply_header.h"

#include "off_scanner.h"

#include <map>

namespace pcl_surflet {
namespace detail {
namespace {

using Tokens = std::vector<std::string_view>;

constexpr const char* kRemedy = "correct the header or export the file again";

PlyType
typeOf(const TextLines& lines, std::string_view name)
{
  static const std::map<std::string_view, PlyType> types = {
      {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
      {"uint8", PlyType::Uint8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
      {"ushort", PlyType::Uint16},  {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
      {"int32", PlyType::Int32},    {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
      {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
      {"float64", PlyType::Float64}};
  const auto found = types.find(name);
  if (found == types.end())
    lines.fail(forMessage(std::string(name)) + " is no type of PLY", kRemedy);
  return found->second;
}

PlyFormat
formatOf(const TextLines& lines, const Tokens& tokens)
{
  if (tokens.size() == 3 && tokens[1] == "ascii")
    return PlyFormat::Ascii;
  if (tokens.size() == 3 && tokens[1] == "binary_little_endian")
    return PlyFormat::LittleEndian;
  if (tokens.size() == 3 && tokens[1] == "binary_big_endian")
    return PlyFormat::BigEndian;
  lines.fail("the format is none of ascii, binary_little_endian and binary_big_endian", kRemedy);
}

PlyElement
elementOf(const TextLines& lines, const Tokens& tokens)
{
  if (tokens.size() != 3 || lines.integer(tokens[2]) < 0)
    lines.fail("an element needs a name and a count", kRemedy);
  return {std::string(tokens[1]), static_cast<std::uint64_t>(lines.integer(tokens[2])), {}};
}

PlyProperty
propertyOf(const TextLines& lines, const Tokens& tokens)
{
  if (tokens.size() == 3)
    return {std::string(tokens[2]), typeOf(lines, tokens[1]), std::nullopt};
  if (tokens.size() != 5 || tokens[1] != "list")
    lines.fail("a property needs a type and a name", kRemedy);
  return {std::string(tokens[4]), typeOf(lines, tokens[3]), typeOf(lines, tokens[2])};
}

/** \brief An element without properties would be read for as long as its count says. */
void
checkElements(const TextLines& lines, const PlyHeader& header)
{
  for (const auto& element : header.elements)
    if (element.properties.empty() && element.count > 0)
      lines.fail("element " + forMessage(element.name) + " has no properties", kRemedy);
}

} // namespace

PlyHeader
readPlyHeader(TextLines& lines)
{
  PlyHeader header;
  Tokens tokens;
  if (!lines.next(tokens) || tokens[0] != "ply")
    lines.fail("not a PLY file: it does not begin with 'ply'", "give a PLY file");
  bool has_format = false;
  while (lines.next(tokens)) {
    if (tokens[0] == "format") {
      header.format = formatOf(lines, tokens);
      has_format = true;
    }
    else if (tokens[0] == "element")
      header.elements.push_back(elementOf(lines, tokens));
    else if (tokens[0] == "property" && !header.elements.empty())
      header.elements.back().properties.push_back(propertyOf(lines, tokens));
    else if (tokens[0] == "end_header" && has_format) {
      checkElements(lines, header);
      return header;
    }
    else if (tokens[0] != "comment" && tokens[0] != "obj_info")
      lines.fail(forMessage(std::string(tokens[0])) + " does not belong here in a PLY header",
                 kRemedy);
  }
  lines.fail("the file ends within its header", "it is truncated; export it again");
}

} // namespace detail
} // namespace pcl_surflet
