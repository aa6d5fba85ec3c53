/** \file
 * Small symmetric systems. */
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pcl_surflet {

template <std::size_t N>
using SquareMatrix = std::array<std::array<double, N>, N>;

/** \brief x of (a + damping 1) x = \p right for symmetric a, of which the lower half is read; all 0
 * unless that sum is positive definite. */
template <std::size_t N>
std::array<double, N>
solvedByCholesky(SquareMatrix<N> a, const std::array<double, N>& right, double damping)
{
  std::array<double, N> x = right;
  for (std::size_t i = 0; i < N; ++i)
    a[i][i] += damping;
  for (std::size_t i = 0; i < N; ++i) { // a = l l^T, l in the lower half
    for (std::size_t k = 0; k < i; ++k)
      a[i][i] -= a[i][k] * a[i][k];
    if (!(a[i][i] > 0))
      return {};
    a[i][i] = std::sqrt(a[i][i]);
    for (std::size_t j = i + 1; j < N; ++j) {
      for (std::size_t k = 0; k < i; ++k)
        a[j][i] -= a[j][k] * a[i][k];
      a[j][i] /= a[i][i];
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < i; ++k)
      x[i] -= a[i][k] * x[k];
    x[i] /= a[i][i];
  }
  for (std::size_t i = N; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k)
      x[i] -= a[k][i] * x[k];
    x[i] /= a[i][i];
  }
  return x;
}

} // namespace pcl_surflet
