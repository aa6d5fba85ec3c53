#include "off_scanner.h"

#include "file_content.h"

#include "pcl_surflet/core/mesh_file.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

namespace pcl_surflet {
namespace detail {

namespace {

constexpr std::size_t kLongestToken = 1000; ///< the longest sensible number is far shorter
constexpr std::size_t kLongestQuote = 40;

bool
isBlank(int c)
{
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r' || c == '\n';
}

/** \brief First character to parse: std::from_chars does not know a leading plus. */
const char*
afterPlus(const std::string& token)
{
  return token.data() + (token.size() > 1 && token[0] == '+' && token[1] != '-' ? 1 : 0);
}

/** \brief Whether a number out of the range of float is too small, not too large. */
bool
underflows(const std::string& token)
{
  double value = 0;
  const auto result = std::from_chars(afterPlus(token), token.data() + token.size(), value);
  if (result.ec == std::errc())
    return std::abs(value) < 1;
  return token.find("e-") != std::string::npos || token.find("E-") != std::string::npos;
}

} // namespace

std::string
forMessage(const std::string& token)
{
  std::string shown = "'";
  for (const char c : token.substr(0, kLongestQuote))
    shown += c >= 32 && c < 127 ? c : '?';
  return shown + (token.size() > kLongestQuote ? "...'" : "'");
}

OffScanner::OffScanner(const std::string& path) : path_(path)
{
  detail::checkedFileSize(path);
  errno = 0;
  file_.open(path, std::ios::binary);
  if (!file_)
    throw MeshFileError(path + ": cannot be opened: " + std::strerror(errno) +
                        "; check its permissions");
}

void
OffScanner::fail(const std::string& cause, const std::string& remedy) const
{
  throw MeshFileError(path_ + ":" + std::to_string(line_) + ": " + cause + "; " + remedy);
}

int
OffScanner::peek()
{
  if (position_ == filled_) {
    file_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (file_.bad())
      fail("reading failed", "check the disk and copy the file again");
    filled_ = static_cast<std::size_t>(file_.gcount());
    position_ = 0;
    if (filled_ == 0)
      return kEnd;
  }
  return static_cast<unsigned char>(buffer_[position_]);
}

void
OffScanner::drop()
{
  if (buffer_[position_++] == '\n')
    ++line_;
}

bool
OffScanner::next(std::string& token)
{
  token.clear();
  for (int c = peek(); isBlank(c) || c == '#'; c = peek()) {
    if (c == '#')
      skipLine();
    else
      drop();
  }
  for (int c = peek(); c != kEnd && !isBlank(c) && c != '#'; c = peek()) {
    if (token.size() == kLongestToken)
      fail("a token longer than " + std::to_string(kLongestToken) +
               " characters: " + forMessage(token),
           "this is no text file; export the mesh as ASCII OFF");
    token += static_cast<char>(c);
    drop();
  }
  return !token.empty();
}

void
OffScanner::skipLine()
{
  // Leaves the line's end itself to next(): a message about this line then names this line.
  for (int c = peek(); c != kEnd && c != '\n' && c != '\r'; c = peek())
    drop();
}

std::string
OffScanner::required(const std::string& what)
{
  if (!next(token_))
    fail("the file ends where " + what + " should be",
         "it is truncated or claims too many elements; export it again");
  return token_;
}

float
OffScanner::coordinate(const std::string& what)
{
  required(what);
  const char* const end = token_.data() + token_.size();
  // Parsed as a float at once: by way of double it would be rounded twice, the largest float away.
  float value = 0;
  const auto result = std::from_chars(afterPlus(token_), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument)
    fail(what + " is " + forMessage(token_) + ", not a number",
         "correct it or export the mesh again (vertices must start on lines of their own)");
  const bool out_of_range = result.ec == std::errc::result_out_of_range;
  if (out_of_range && underflows(token_))
    return 0;
  if (out_of_range || !std::isfinite(value))
    fail(what + " is " + forMessage(token_) + ", not finite in single precision",
         "remove the vertex or choose another unit of length");
  return value;
}

std::uint64_t
OffScanner::parseCount(const std::string& token, const std::string& what) const
{
  const char* const end = token.data() + token.size();
  std::uint64_t value = 0;
  const auto result = std::from_chars(afterPlus(token), end, value);
  if (result.ptr == end && result.ec == std::errc::result_out_of_range)
    fail(what + " is " + forMessage(token) + ", absurdly large", "export the mesh again");
  if (result.ptr != end || result.ec != std::errc())
    fail(what + " is " + forMessage(token) + ", not a whole number from 0",
         "correct it or export the mesh again (faces must start on lines of their own)");
  return value;
}

std::uint64_t
OffScanner::count(const std::string& what)
{
  return parseCount(required(what), what);
}

} // namespace detail
} // namespace pcl_surflet
