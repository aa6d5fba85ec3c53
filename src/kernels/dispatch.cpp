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
  if (set == InstructionSet::Scalar || set == InstructionSet::Automatic)
    return &scalar_kernels;
  return nullptr;
}

std::atomic<const PairKernels*>&
selected()
{
  static std::atomic<const PairKernels*> kernels{kernelsFor(InstructionSet::Automatic)};
  return kernels;
}

} // namespace

BinMap::BinMap(const Resolution& r, double delta_max)
    : n_alpha(static_cast<float>(r.alpha)), n_beta(static_cast<float>(r.beta)),
      n_gamma(static_cast<float>(r.gamma)), n_delta(static_cast<float>(r.delta)),
      half_beta(n_beta / 2), half_gamma(n_gamma / 2),
      delta_scale(static_cast<float>(r.delta / delta_max)),
      alpha_base(static_cast<float>(r.alpha / 2)), angular_bins(r.angularBins()), bins(r.bins()),
      edges(0), edge_cos{}, edge_sin{}
{
  for (int k = r.alpha / 2 + 1; k < r.alpha; ++k, ++edges) {
    const double angle = -M_PI + 2 * M_PI * k / r.alpha;
    // A right angle must be exact: boxes have many pairs exactly on that border.
    const double cosine = std::cos(angle);
    edge_cos[edges] = std::abs(cosine) < 1e-12 ? 0.f : static_cast<float>(cosine);
    edge_sin[edges] = static_cast<float>(std::sin(angle));
  }
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
