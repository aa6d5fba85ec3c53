/** \file
 * Marks the symbols that libpcl_surflet offers; everything else stays hidden. */
#pragma once

#if defined(__GNUC__) || defined(__clang__)
#define PCL_SURFLET_API __attribute__((visibility("default")))
#else
#define PCL_SURFLET_API
#endif
