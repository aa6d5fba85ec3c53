/** \file
 * Division of the cells among explanations; internal, not installed. */
#pragma once

#include "explanation.h"

namespace pcl_surflet {
namespace interpretation {

/** \brief Computes the fit of an explanation's cells. */
void judge(const Explaining& work, Explanation& e);

/** \brief Division of the cells among explanations. */
class Division {
public:
  explicit Division(Explaining& work)
      : work_(work), best_(work.scene.cells.size(), 0.f), owner_(best_.size(), kNobody)
  {
  }

  /** \brief Every cell goes to the explanation that it supports most. The first \p active get their
   * cells, and new fits where these changed, everywhere if \p all; the others only compete. */
  void divide(std::vector<Explanation>& set, std::size_t active, bool all);

private:
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  Explaining& work_;
  std::vector<float> best_;
  std::vector<std::uint32_t> owner_;
};

} // namespace interpretation
} // namespace pcl_surflet
