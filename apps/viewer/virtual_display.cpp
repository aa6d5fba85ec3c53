#include "virtual_display.h"

#include "app_common.h"

#include <X11/Xlib.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

constexpr int kPatience = 20000; ///< milliseconds for the server to start

/** \brief Becomes Xvfb, which writes its number to \p to; ends with this program. */
[[noreturn]] void
becomeServer(int to)
{
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (const int null = ::open("/dev/null", O_RDWR); null >= 0) {
    ::dup2(null, STDIN_FILENO);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
  }
  const std::string descriptor = std::to_string(to);
  // A server that resets itself after its last client, our trial connection, refuses the next one
  // meanwhile, and VTK aborts: one picture in five.
  ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1280x1024x24",
           "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
  ::_exit(127);
}

/** \brief The number the server writes, empty if none comes. */
std::string
readNumber(int from)
{
  std::string text;
  pollfd ready{from, POLLIN, 0};
  char c = 0;
  while (::poll(&ready, 1, kPatience) > 0 && ::read(from, &c, 1) == 1 && c != '\n')
    text += c;
  return c == '\n' ? text : std::string();
}

} // namespace

bool
displayAnswers()
{
  Display* display = XOpenDisplay(nullptr);
  if (display != nullptr)
    XCloseDisplay(display);
  return display != nullptr;
}

VirtualDisplay::VirtualDisplay()
{
  int ends[2];
  if (::pipe(ends) != 0)
    throw DataError("no pipe to an X server: too many open files");
  server_ = ::fork();
  if (server_ == 0) {
    ::close(ends[0]);
    becomeServer(ends[1]);
  }
  ::close(ends[1]);
  const std::string number = readNumber(ends[0]);
  ::close(ends[0]);
  if (!number.empty()) {
    ::setenv("DISPLAY", (":" + number).c_str(), 1);
    if (displayAnswers())
      return;
  }
  throw DataError(
      "cannot draw: there is no display (DISPLAY) and the X server without screen, "
      "Xvfb, does not start; install it (apt-get install xvfb libgl1-mesa-dri), or make "
      "room in /tmp if it is there");
}

VirtualDisplay::~VirtualDisplay()
{
  if (server_ > 0) {
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
  }
}

} // namespace apps
} // namespace pcl_surflet
