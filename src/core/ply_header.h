/** \file
 * The header of PLY files; internal, not installed. */
#pragma once

#include "file_content.h"

#include <optional>

namespace pcl_surflet {
namespace detail {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;
  std::optional<PlyType> count_type; ///< of a list: type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
};

/** \brief Reads the lines up to end_header. \throws MeshFileError if they are no PLY header */
PlyHeader readPlyHeader(TextLines& lines);

} // namespace detail
} // namespace pcl_surflet
