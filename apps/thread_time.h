/** \file
 * What a piece of work costs, however busy the machine is. */
#pragma once

namespace pcl_surflet {
namespace apps {

/** \brief CPU time of the calling thread in seconds. */
double threadSeconds();

} // namespace apps
} // namespace pcl_surflet
