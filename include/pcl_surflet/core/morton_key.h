/** \file
 * Keys: the Morton code of a cell, one digit per level, whole digits per machine word. */
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace pcl_surflet {

namespace detail {

/** \brief Moves bit i of the low 21 bits of \p v to bit 3 i. */
constexpr std::uint64_t
spread3(std::uint64_t v)
{
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffffULL;
  v = (v | v << 16) & 0x001f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/** \brief Inverse of spread3(). */
constexpr std::uint64_t
compact3(std::uint64_t v)
{
  v &= 0x1249249249249249ULL;
  v = (v ^ v >> 2) & 0x10c30c30c30c30c3ULL;
  v = (v ^ v >> 4) & 0x100f00f00f00f00fULL;
  v = (v ^ v >> 8) & 0x001f0000ff0000ffULL;
  v = (v ^ v >> 16) & 0x001f00000000ffffULL;
  return (v ^ v >> 32) & 0x1fffff;
}

} // namespace detail

/** \brief Key I of a cell: its Morton code, the leading digit naming the coarsest level
 * [Wahl 2007, Eq. 4.3, 4.4].
 *
 * Layout "code 2" [Wahl 2007, Sec. 4.2.1]: a digit never straddles two words. A 64-bit word holds
 * 21 octal digits (one bit is unused) or, in the plane, 32 base-4 digits. Digits fill a word from
 * its high end, so words compare like numbers and a prefix is a mask. The depth is stored, not
 * coded in the unused bits as in Fig. 4.4: base-4 words have none.
 *
 * \tparam Dim 3 for space (octal digits), 2 for the plane (base 4, used by the worked example)
 * \tparam Words number of 64-bit words; the greatest depth is Words * digits_per_word
 *
 * Bit a of a digit tells whether the upper half is meant along axis a in Fig. 4.1's order: x is the
 * lowest bit, then y, then z. */
template <int Dim, int Words>
class BasicMortonKey {
public:
  static constexpr int bits_per_digit = Dim;                ///< one bit per axis
  static constexpr int digits_per_word = 64 / Dim;          ///< whole digits
  static constexpr int max_depth = digits_per_word * Words; ///< most levels of a key
  using Coordinates = std::array<std::uint64_t, 3>;         ///< whole numbers of a cell, x y z

  /** \brief The key of depth 0: the whole cube. */
  constexpr BasicMortonKey() = default;

  /** \brief The key of the cell at integer coordinates \p c on level \p depth.
   *
   * Only the low \p depth bits of each coordinate are used; the third is ignored in the plane.
   * \p depth must lie in [0, min(max_depth, 63)]. */
  static BasicMortonKey
  fromCoordinates(const Coordinates& c, int depth)
  {
    BasicMortonKey key;
    key.depth_ = depth;
    for (int w = 0, done = 0; done < depth; ++w, done += digits_per_word) {
      const int digits = std::min(digits_per_word, depth - done);
      const int below = depth - done - digits; // levels left to the later words
      key.words_[w] = interleave(c, below) & lowBits(digits * Dim);
      key.words_[w] <<= kUsed - digits * Dim;
    }
    return key;
  }

  /** \brief The key whose digits are the characters of \p digits, e.g. "132": each below 2^Dim, no
   * more than max_depth. Not checked. */
  static BasicMortonKey
  fromDigits(const std::string& digits)
  {
    BasicMortonKey key;
    for (const char d : digits)
      key = key.child(d - '0');
    return key;
  }

  /** \brief The key of depth \p depth whose words are \p words; bits below the depth are dropped.
   * \p depth in [0, max_depth]. */
  static constexpr BasicMortonKey
  fromWords(const std::array<std::uint64_t, Words>& words, int depth)
  {
    BasicMortonKey key;
    key.words_ = words;
    key.depth_ = max_depth;
    key = key.prefix(depth);
    key.depth_ = depth;
    return key;
  }

  /** \brief Number of digits, the level of the cell, in [0, max_depth]. */
  constexpr int
  depth() const
  {
    return depth_;
  }

  /** \brief Digit of level \p level in [0, depth()); 0 is the coarsest. */
  constexpr int
  digit(int level) const
  {
    const int w = level / digits_per_word, i = level % digits_per_word;
    return static_cast<int>(words_[w] >> (kUsed - (i + 1) * Dim)) & ((1 << Dim) - 1);
  }

  /** \brief The key of the sub-cell \p digit of this cell; depth() must be below max_depth. */
  constexpr BasicMortonKey
  child(int digit) const
  {
    BasicMortonKey key = *this;
    const int w = depth_ / digits_per_word, i = depth_ % digits_per_word;
    key.words_[w] |= static_cast<std::uint64_t>(digit) << (kUsed - (i + 1) * Dim);
    key.depth_ = depth_ + 1;
    return key;
  }

  /** \brief Prefix i(I, d): the \p d leading digits, the key of the parent cell on level \p d
   * [Wahl 2007, Eq. 4.20]; the key itself where \p d >= depth(). */
  constexpr BasicMortonKey
  prefix(int d) const
  {
    if (d >= depth_)
      return *this;
    BasicMortonKey key;
    key.depth_ = d;
    for (int w = 0; w < Words && d > 0; ++w, d -= digits_per_word)
      key.words_[w] = words_[w] & ~lowBits(kUsed - std::min(d, digits_per_word) * Dim);
    return key;
  }

  /** \brief Whether \p other lies in this cell, i.e. starts with this key. */
  constexpr bool
  isPrefixOf(const BasicMortonKey& other) const
  {
    return other.depth_ >= depth_ && other.prefix(depth_) == *this;
  }

  /** \brief Integer coordinates of the cell on its level (depths up to 63). */
  Coordinates
  coordinates() const
  {
    Coordinates c{0, 0, 0};
    for (int level = 0; Dim != 3 && level < depth_; ++level)
      for (int a = 0; a < Dim; ++a)
        c[a] = c[a] << 1 | ((digit(level) >> a) & 1);
    for (int w = 0, done = 0; Dim == 3 && done < depth_; ++w, done += digits_per_word) {
      const int digits = std::min(digits_per_word, depth_ - done);
      for (int a = 0; a < 3; ++a)
        c[a] = c[a] << digits | detail::compact3(words_[w] >> (kUsed - digits * Dim) >> a);
    }
    return c;
  }

  /** \brief The digits as text, coarsest first. */
  std::string
  toString() const
  {
    std::string text;
    for (int level = 0; level < depth_; ++level)
      text += static_cast<char>('0' + digit(level));
    return text;
  }

  /** \brief The words, coarsest digits first; fromWords() takes them back. */
  constexpr const std::array<std::uint64_t, Words>&
  words() const
  {
    return words_;
  }
  /** \brief Word \p w in [0, Words). */
  constexpr std::uint64_t
  word(int w) const
  {
    return words_[w];
  }

  /** \brief The same cell on the same level. */
  friend constexpr bool
  operator==(const BasicMortonKey& a, const BasicMortonKey& b)
  {
    if (a.depth_ != b.depth_)
      return false;
    for (int w = 0; w < Words; ++w)
      if (a.words_[w] != b.words_[w])
        return false;
    return true;
  }
  /** \brief Not equal. */
  friend constexpr bool
  operator!=(const BasicMortonKey& a, const BasicMortonKey& b)
  {
    return !(a == b);
  }
  /** \brief Order along the curve; a cell comes before its sub-cells. */
  friend constexpr bool
  operator<(const BasicMortonKey& a, const BasicMortonKey& b)
  {
    for (int w = 0; w < Words; ++w)
      if (a.words_[w] != b.words_[w])
        return a.words_[w] < b.words_[w];
    return a.depth_ < b.depth_;
  }

private:
  static constexpr int kUsed = digits_per_word * Dim; // bits of a word that carry digits

  /** \brief The lowest \p n bits. */
  static constexpr std::uint64_t
  lowBits(int n)
  {
    return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1;
  }

  /** \brief Bits [shift, shift + digits_per_word) of the coordinates, interleaved from bit 0. */
  static constexpr std::uint64_t
  interleave(const Coordinates& c, int shift)
  {
    if (Dim == 3)
      return detail::spread3(c[0] >> shift) | detail::spread3(c[1] >> shift) << 1 |
             detail::spread3(c[2] >> shift) << 2;
    std::uint64_t word = 0;
    for (int i = 0; i < digits_per_word; ++i)
      for (int a = 0; a < Dim; ++a)
        word |= (c[a] >> shift >> i & 1) << (i * Dim + a);
    return word;
  }

  std::array<std::uint64_t, Words> words_{};
  std::int32_t depth_ = 0;
};

/** \brief Key in space, one word: depths up to 21. */
using MortonKey = BasicMortonKey<3, 1>;
/** \brief Key in space of three words: depths up to 63. */
using WideMortonKey = BasicMortonKey<3, 3>;
/** \brief Key in the plane, one word: depths up to 32. */
using PlanarMortonKey = BasicMortonKey<2, 1>;

} // namespace pcl_surflet
