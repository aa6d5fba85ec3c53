/** \file
 * Model banks: the conditions under which an object is trained beside the ideal one. */
#pragma once

#include "pcl_surflet/export.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_surflet {

/** \brief A bank that cannot be used; what() names the line and how to mend it. */
class PCL_SURFLET_API ModelBankError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
  ~ModelBankError() override;
};

/** \brief What happens to an object before it is trained, and how many members keep it.
 *
 * A cut or a view leaves another part of the object each time. One mean histogram of all parts
 * resembles none of them; several members, each the mean of similar parts, do. */
struct PCL_SURFLET_API BankCondition {
  static constexpr unsigned kMostMembers = 64; ///< of one condition

  double noise = 0;     ///< largest displacement as a share of the diameter, in [0, 0.5]
  double visible = 1;   ///< share of the surface left by a random plane, in (0, 1]
  bool view = false;    ///< only what a distant sensor in a random direction sees
  unsigned members = 1; ///< in [1, kMostMembers]

  /** \brief What members are called: "noise 1 %", "view, noise 0.3 %", "visible 40 %"; of several
   * members with their number, "visible 40 % (2 of 6)". At most 63 bytes.
   * \param member counts from 0
   * \param of number of members of this condition */
  std::string name(std::size_t member, std::size_t of) const;
};

/** \brief The conditions of a bank, in order; the members of a model follow that order, after the
 * clean and complete one, which is always the first.
 *
 * As text, one condition a line, percentages of the diameter and of the surface; a '#' starts a
 * comment:
 * \code
 * normals 3                      # radius of estimated normals in point spacings
 * noise 1                        # one member
 * visible 40 members 6
 * noise 4 visible 50 members 3   # both at once
 * view noise 0.3 members 6
 * \endcode */
struct PCL_SURFLET_API ModelBank {
  /** \brief Normals of noisy surfaces and of views are estimated from the positions within this
   * radius, in spacings (square root of the area per point). Queries should be treated alike. */
  double normal_radius = 3;
  std::vector<BankCondition> conditions; ///< of the members after the first

  /** \brief The default: noise of 1, 2 and 4 %, three visible shares, both together, and views; 29
   * members in all with the clean one, 81 kB a model in a file at resolution 5,5,5,5. */
  static ModelBank standard();
  /** \brief No conditions: models of one member. */
  static ModelBank none();
  /** \brief Reads the text form. \throws ModelBankError naming the line */
  static ModelBank parse(const std::string& text);

  /** \brief The text form; parse() reads it. */
  std::string toText() const;
  /** \brief Number of members of a model, the clean one included. */
  unsigned members() const;
};

} // namespace pcl_surflet
