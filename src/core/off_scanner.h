/** \file
 * Splits a text file into tokens in constant memory; internal, not installed. */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace pcl_surflet {
namespace detail {

/** \brief Tokens and numbers of an OFF file, with line numbers for messages.
 *
 * Never holds more than a buffer and one token, whatever the file claims or contains. Errors of
 * any kind are MeshFileError naming file and line. */
class OffScanner {
public:
  /** \brief Opens \p path. \throws MeshFileError if it is missing, a directory or unreadable. */
  explicit OffScanner(const std::string& path);

  /** \brief Reads the next token, over line ends and comments; false at the end of the file. */
  bool next(std::string& token);

  /** \brief Drops what is left of the line of the last token. */
  void skipLine();

  /** \brief Reads a coordinate; \p what names it in messages. */
  float coordinate(const std::string& what);

  /** \brief Reads a count or index that is not negative. */
  std::uint64_t count(const std::string& what);

  /** \brief Reads \p token as a count. */
  std::uint64_t parseCount(const std::string& token, const std::string& what) const;

  /** \throws MeshFileError with file, line, \p cause and \p remedy. */
  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const;

private:
  static constexpr int kEnd = -1;

  int peek();
  void drop();
  std::string required(const std::string& what);

  std::string path_;
  std::ifstream file_;
  std::array<char, 65536> buffer_{};
  std::size_t position_ = 0, filled_ = 0;
  std::size_t line_ = 1;
  std::string token_; ///< reused
};

/** \brief \p token for a message: shortened, unprintable characters replaced. */
std::string forMessage(const std::string& token);

} // namespace detail
} // namespace pcl_surflet
