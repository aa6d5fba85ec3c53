/** \file
 * Answers as bytes, by Boost.Serialization: numbers keep every bit. Both sides must be the same
 * build on the same kind of machine. */
#pragma once

#include "parallel/ranks.h"

#include "pcl_surflet/recognition/histogram_model.h"
#include "pcl_surflet/surface_file.h"

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <sstream>

namespace pcl_surflet {

template <class Archive>
void
serialize(Archive& archive, Resolution& r, unsigned)
{
  archive& r.alpha& r.beta& r.gamma& r.delta;
}

template <class Archive>
void
serialize(Archive& archive, ModelMember& m, unsigned)
{
  archive& m.condition& m.histogram& m.features& m.misfit& m.misfit_limit& m.area;
}

template <class Archive>
void
serialize(Archive& archive, HistogramModel& m, unsigned)
{
  archive& m.label& m.role& m.resolution& m.delta_max& m.r_mean& m.r_max& m.r_min;
  archive& m.surface_area& m.centre& m.members;
}

template <class Archive>
void
serialize(Archive& archive, SurfletSet& s, unsigned)
{
  archive& s.x& s.y& s.z& s.nx& s.ny& s.nz;
}

template <class Archive>
void
serialize(Archive& archive, TriangleMesh& mesh, unsigned)
{
  archive& mesh.vertices& mesh.triangles;
}

template <class Archive>
void
serialize(Archive& archive, SurfaceFile& file, unsigned)
{
  bool is_mesh = file.mesh.has_value();
  archive& is_mesh& file.surflets& file.rejected;
  if (is_mesh && !file.mesh)
    file.mesh.emplace();
  if (is_mesh)
    archive&* file.mesh;
}

namespace apps {

template <class Value>
Bytes
packed(const Value& value)
{
  std::ostringstream out(std::ios::binary);
  boost::archive::binary_oarchive(out, boost::archive::no_header) << value;
  return out.str();
}

template <class Value>
Value
unpacked(const Bytes& bytes)
{
  std::istringstream in(bytes, std::ios::binary);
  Value value;
  boost::archive::binary_iarchive(in, boost::archive::no_header) >> value;
  return value;
}

} // namespace apps
} // namespace pcl_surflet
