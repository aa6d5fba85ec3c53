/** \file
 * A place to draw on. VTK aborts the program where there is no X server, so one looks first. */
#pragma once

#include <sys/types.h>

namespace pcl_surflet {
namespace apps {

/** \brief Does the X server that DISPLAY names answer? */
bool displayAnswers();

/** \brief An X server without screen (Xvfb) of our own, while the object lives; DISPLAY names it.
 * It chooses a free number itself, so that any number of programs may do so at once. */
class VirtualDisplay {
public:
  /** \throws DataError naming the remedy if Xvfb is not installed or does not start */
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

private:
  pid_t server_ = -1;
};

} // namespace apps
} // namespace pcl_surflet
