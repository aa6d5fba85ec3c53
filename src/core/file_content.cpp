#include "file_content.h"

#include "off_scanner.h"
#include "pcl_surflet/core/mesh_file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace pcl_surflet {
namespace detail {

namespace fs = std::filesystem;

std::uint64_t
checkedFileSize(const std::string& path)
{
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw MeshFileError(path + ": there is no such file; check the name");
  if (error)
    throw MeshFileError(path + ": cannot be read: " + error.message() +
                        "; check the name and the permissions");
  if (fs::is_directory(status))
    throw MeshFileError(path + ": is a directory; give a file");
  if (!fs::is_regular_file(status))
    throw MeshFileError(path + ": is no regular file; save its content as a file first");
  const auto size = fs::file_size(path, error);
  if (error)
    throw MeshFileError(path + ": cannot be read: " + error.message() + "; check the permissions");
  if (size == 0)
    throw MeshFileError(path + ": the file is empty; export it again");
  return size;
}

std::string
fileContent(const std::string& path)
{
  std::string content(checkedFileSize(path), '\0');
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.read(content.data(), static_cast<std::streamsize>(content.size())))
    throw MeshFileError(path + ": cannot be read" +
                        (errno != 0 ? std::string(": ") + std::strerror(errno) : "") +
                        "; check the permissions");
  return content;
}

bool
TextLines::next(std::vector<std::string_view>& tokens)
{
  constexpr std::string_view kBlanks(" \t\r\v\f\0", 6);
  tokens.clear();
  while (tokens.empty() && position_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_;
    for (;;) {
      const std::size_t first = line.find_first_not_of(kBlanks);
      if (first == std::string_view::npos)
        break;
      const std::size_t last = std::min(line.find_first_of(kBlanks, first), line.size());
      tokens.push_back(line.substr(first, last - first));
      line.remove_prefix(last);
    }
  }
  return !tokens.empty();
}

double
TextLines::number(std::string_view token) const
{
  const std::string_view digits = token.substr(!token.empty() && token[0] == '+');
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    fail(forMessage(std::string(token)) + " is not a number",
         "correct it or export the file again");
  if (error == std::errc::result_out_of_range) // too small is as good as zero
    return digits.find("e-") != std::string_view::npos ||
                   digits.find("E-") != std::string_view::npos
               ? 0.0
               : std::numeric_limits<double>::infinity();
  return value;
}

std::int64_t
TextLines::integer(std::string_view token) const
{
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc{} || end != token.data() + token.size())
    fail(forMessage(std::string(token)) + " is not a whole number",
         "correct it or export the file again");
  return value;
}

void
TextLines::fail(const std::string& cause, const std::string& remedy) const
{
  throw MeshFileError(path_ + ", line " + std::to_string(line_) + ": " + cause + "; " + remedy);
}

} // namespace detail
} // namespace pcl_surflet
