/** \file
 * Databases as files: one self-describing PCD, one point per model member.
 *
 * Fields: format_version (U4, now 1), label and condition (U1 x 64, NUL-padded UTF-8), role (U4: 0
 * object, 1 background), member (U4, counts from 0 within a model), resolution (U4 x 4), delta_max,
 * r_mean, r_max, r_min, surface_area, features, tau, floor (F8), misfit, misfit_limit, area (F8,
 * may be missing), centre (F8 x 7, may be missing), histogram (F4 x bins). What is checked on
 * loading: doc/database_format.md. */
#pragma once

#include "pcl_surflet/compat.h"
#include "pcl_surflet/recognition/model_database.h"

#include <pcl/exceptions.h>

#include <string>

namespace pcl_surflet {

/** \brief A database file that cannot be read or written; what() names file, cause and remedy. */
class PCL_SURFLET_API DatabaseFileError : public pcl::PCLException {
public:
  /** \brief \param description file, cause and remedy */
  explicit DatabaseFileError(const std::string& description)
      : pcl::PCLException(description), description_(description)
  {
  }

  /** \brief The description alone; PCL would put a place in the source before it. */
  const char*
  what() const noexcept override
  {
    return description_.c_str();
  }

private:
  std::string description_;
};

/** \brief Writes \p database to \p path as binary PCD, atomically: readers see the old file or the
 * whole new one. \throws DatabaseFileError if it cannot be written (the old file is left as it
 * was) or the database is empty */
PCL_SURFLET_API void saveDatabase(const ModelDatabase& database, const std::string& path);

/** \brief Reads a database (ASCII, binary or compressed PCD).
 * \throws DatabaseFileError if the file is missing, no PCD, truncated, of a newer format, lacks a
 * field, or holds a model that is unusable (HistogramModel::problem()) */
PCL_SURFLET_API ModelDatabase loadDatabase(const std::string& path);

} // namespace pcl_surflet
