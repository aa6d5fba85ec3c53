#include "kernels/pair_kernels.h"
#include "pcl_surflet/core/instruction_set.h"

#include <atomic>
#include <cmath>

namespace pcl_surflet {
namespace kernels {
namespace {

/** \brief The kernels of \p set, or null where this processor or build has none. */
const PairKernels*
kernelsFor(InstructionSet set)
{
#if defined(PCL_SURFLET_X86_KERNELS)
  const bool avx2 = __builtin_cpu_supports("avx2");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  if (avx512 && (set == InstructionSet::Avx512 || set == InstructionSet::Automatic))
    return &avx512_kernels;
  if (avx2 && (set == InstructionSet::Avx2 || set == InstructionSet::Automatic))
    return &avx2_kernels;
#endif
  if (set == InstructionSet::Baseline || set == InstructionSet::Automatic)
    return &baseline_kernels;
  return set == InstructionSet::Scalar ? &scalar_kernels : nullptr;
}

std::atomic<const PairKernels*>&
selected()
{
  static std::atomic<const PairKernels*> kernels{kernelsFor(InstructionSet::Automatic)};
  return kernels;
}

/** \brief Interval of 0 and number of borders above it, for \p n intervals symmetric about 0. */
AxisMap
axisMap(int n, int stride)
{
  const int middle = n / 2;
  AxisMap axis{};
  axis.borders = n - 1 - middle;
  axis.stride = static_cast<float>(stride);
  axis.base = static_cast<float>(middle * stride);
  axis.base_negative = static_cast<float>(axis.borders * stride);
  return axis;
}

/** \brief Share of [0, 1] at which border \p k above 0 lies, among \p n intervals over [-1, 1]. */
double
borderAbove(int k, int n)
{
  const int number = n / 2 + 1 + k;
  return 2.0 * number / n - 1;
}

/** \brief alpha: borders as -cot(angle) |cot(angle)|, which ascends over (0, pi). */
AxisMap
azimuthMap(int n, int stride)
{
  AxisMap axis = axisMap(n, stride);
  for (int k = 0; k < axis.borders; ++k) {
    const double angle = M_PI * borderAbove(k, n);
    // A right angle must be exact: boxes have many pairs exactly on that border.
    const double cosine = 4 * (n / 2 + 1 + k) == 3 * n ? 0 : std::cos(angle);
    const double cotangent = cosine / std::sin(angle);
    axis.border[k] = static_cast<float>(-cotangent * std::abs(cotangent));
  }
  return axis;
}

/** \brief beta and gamma: borders squared. */
AxisMap
cosineMap(int n, int stride)
{
  AxisMap axis = axisMap(n, stride);
  for (int k = 0; k < axis.borders; ++k)
    axis.border[k] = static_cast<float>(borderAbove(k, n) * borderAbove(k, n));
  return axis;
}

} // namespace

BinMap::BinMap(const Resolution& r, double delta_max)
    : alpha(azimuthMap(r.alpha, kCounterCopies)), beta(cosineMap(r.beta, kCounterCopies * r.alpha)),
      gamma(cosineMap(r.gamma, kCounterCopies * r.alpha * r.beta)),
      right_angle_border(r.alpha % 4 == 0),
      delta_stride(static_cast<float>(kCounterCopies * r.angularBins())),
      delta_borders(r.delta - 1), delta_border{},
      no_feature(static_cast<float>(kCounterCopies * r.bins()))
{
  for (int k = 0; k < delta_borders; ++k)
    delta_border[k] = squaredDeltaBorder(k, r.delta, delta_max);
}

float
squaredDeltaBorder(int k, int n, double delta_max)
{
  const double border = delta_max * (k + 1) / n;
  return static_cast<float>(border * border);
}

const PairKernels&
active()
{
  return *selected().load(std::memory_order_relaxed);
}

} // namespace kernels

bool
selectInstructionSet(InstructionSet set)
{
  const auto* kernels = kernels::kernelsFor(set);
  if (kernels == nullptr)
    return false;
  kernels::selected().store(kernels, std::memory_order_relaxed);
  return true;
}

const char*
activeInstructionSet()
{
  return kernels::active().name;
}

} // namespace pcl_surflet
