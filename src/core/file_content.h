/** \file
 * Reads whole files and splits text into lines; not installed, shared with
 * the apps. */
#pragma once

#include "pcl_surflet/export.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_surflet {
namespace detail {

/** \brief Size in bytes of \p path. \throws MeshFileError unless it is a regular, non-empty file
 * (a pipe or a device could go on for ever) */
PCL_SURFLET_API std::uint64_t checkedFileSize(const std::string& path);

/** \brief Content of \p path. \throws MeshFileError as checkedFileSize(), or if it cannot be read
 */
PCL_SURFLET_API std::string fileContent(const std::string& path);

/** \brief Lines of a text, split at blanks, with the number of the line for messages.
 *
 * Numbers are read the same way in every locale. Refers to the text, which must outlive it. */
class TextLines {
public:
  TextLines(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  /** \brief Goes to the next line that is not blank and splits it; false at the end. */
  bool next(std::vector<std::string_view>& tokens);

  double number(std::string_view token) const;
  std::int64_t integer(std::string_view token) const;

  /** \brief Where the next line begins. */
  std::size_t
  position() const
  {
    return position_;
  }
  /** \throws MeshFileError with file, line, \p cause and \p remedy */
  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const;

private:
  std::string path_;
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
};

} // namespace detail
} // namespace pcl_surflet
