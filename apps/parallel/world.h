/** \file
 * What several ranks need of MPI; not for programs, see ranks.h. */
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pcl_surflet {
namespace apps {

/** \brief Bytes that travel between ranks. */
using Bytes = std::string;

/** \brief Two ranks or more. All but rank(), size() and abort() is called on each of them. */
class World {
public:
  using Work = std::function<Bytes(std::size_t item)>;
  using Take = std::function<void(std::size_t item, const Bytes& answer)>;

  virtual ~World() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  /** \brief \p own of every rank, in their order. */
  virtual std::vector<Bytes> fromAll(const Bytes& own) = 0;
  virtual void fromFirst(Bytes& content) = 0;
  /** \brief As many numbers on every rank. */
  virtual void sum(std::vector<std::uint64_t>& numbers) = 0;
  /** \brief Ranks::shareOut(). */
  virtual void shareOut(std::size_t items, const Work& work, const Take& take) = 0;
  /** \brief Name of this rank's machine. */
  virtual std::string machine() const = 0;
  [[noreturn]] virtual void abort(int code) = 0;
};

/** \brief Joins those who were started together: null if that is this process alone. A plain start
 * does not touch MPI, whose initialisation takes half a second. Without MPI at build time always
 * null. \throws DataError if several were started that cannot find each other */
std::unique_ptr<World> joinWorld();

} // namespace apps
} // namespace pcl_surflet
