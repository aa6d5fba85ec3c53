/** \file
 * The processes (ranks) that share one run of a program: one, unless mpirun or srun started more.
 */
#pragma once

#include "parallel/world.h"

#include "pcl_surflet/core/pair_histogram.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace pcl_surflet {
namespace apps {

/** \brief This process among its fellows. Every rank must call every function but rank(), size()
 * and isFirst(), in the same order. */
class Ranks {
public:
  /** \brief Ranks other than the first say nothing on stdout from now on.
   * \throws DataError if a launcher started several processes that cannot find each other */
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const;
  int size() const;
  /** \brief Is this the rank that prints and writes? */
  bool
  isFirst() const
  {
    return rank() == 0;
  }

  /** \brief Threads of this rank where -threads was \p wanted: as many if not 0, else its share of
   * the processors that it may use, at least 1; 0 (all) where there is one rank. */
  unsigned threads(std::uint64_t wanted);

  /** \brief Does \p work on every rank; if it fails on any, the run ends on all of them.
   *
   * The first rank throws what was thrown there, else DataError that names another rank and its
   * error; the others throw ReportedElsewhere. */
  void together(const std::function<void()>& work);

  /** \brief Does the items [0, items) one by one on whichever rank is free; the first rank takes
   * the answers in order. For two ranks or more; see share_out.h.
   *
   * In the first rank both run at the same time, \p work in a thread of its own. What they throw
   * comes through and must not be caught: other ranks wait. At most a few answers per rank wait for
   * being taken. */
  void shareOut(std::size_t items, const World::Work& work, const World::Take& take);

  /** \brief \p content of the first rank, on all of them. */
  Bytes fromFirst(Bytes content);

  /** \brief Counts of all ranks, added bin by bin. */
  PairHistogram sum(PairHistogram own);

private:
  friend int runOnRanks(const std::string& program, int argc, char** argv,
                        const std::function<int(Ranks& ranks)>& body);

  /** \brief Other arguments mean other work. \throws UsageError, ReportedElsewhere */
  void requireSameArguments(int argc, char** argv);

  /** \brief Says what went wrong and ends all ranks, unless all of them end already. */
  void endAll(const std::string& program, const std::string& error);

  std::unique_ptr<World> world_; ///< null where there is one rank
  bool all_end_ = false;         ///< an error was shared
};

/** \brief Thrown where the first rank throws the error. */
struct ReportedElsewhere {};

/** \brief runMain() for programs that several ranks run, all with the same arguments: \p body is
 * called on each of them. The exit code is that of the first rank, 0 on others. An error that \p
 * body does not share by Ranks::together() ends all ranks at once. */
int runOnRanks(const std::string& program, int argc, char** argv,
               const std::function<int(Ranks& ranks)>& body);

} // namespace apps
} // namespace pcl_surflet
