#include "thread_time.h"

#include <time.h>

namespace pcl_surflet {
namespace apps {

double
threadSeconds()
{
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace apps
} // namespace pcl_surflet
