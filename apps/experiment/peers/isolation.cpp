#include "experiment/peers/isolation.h"

#include "thread_time.h"

#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pcl_surflet {
namespace apps {
namespace {

/** \brief What the child hands over: shared memory, since a pipe's end would leak into the children
 * that other threads fork meanwhile. */
struct Letter {
  double seconds;
  std::size_t count, length;
  float values[1 << 18];
};

class SharedLetter {
public:
  SharedLetter()
      : place_(::mmap(nullptr, sizeof(Letter), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                      -1, 0))
  {
  }
  ~SharedLetter()
  {
    if (place_ != MAP_FAILED)
      ::munmap(place_, sizeof(Letter));
  }
  SharedLetter(const SharedLetter&) = delete;
  SharedLetter& operator=(const SharedLetter&) = delete;

  Letter*
  get() const
  {
    return place_ == MAP_FAILED ? nullptr : static_cast<Letter*>(place_);
  }

private:
  void* place_;
};

bool
write(const Signatures& signatures, Letter& letter)
{
  letter.count = signatures.size();
  letter.length = signatures.empty() ? 0 : signatures.front().size();
  if (letter.count * letter.length * sizeof(float) > sizeof letter.values)
    return false;
  float* to = letter.values;
  for (const auto& s : signatures)
    to = std::copy(s.begin(), s.end(), to);
  return true;
}

Signatures
read(const Letter& letter)
{
  Signatures out;
  for (std::size_t i = 0; i < letter.count; ++i)
    out.emplace_back(letter.values + i * letter.length, letter.values + (i + 1) * letter.length);
  return out;
}

[[noreturn]] void
runChild(const std::function<Signatures()>& work, unsigned seconds, Letter& letter)
{
  const rlimit time{seconds, seconds}, no_core{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::alarm(10 * seconds); // one that sleeps for ever uses no CPU time
  ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
  bool done = false;
  try {
    const double start = threadSeconds();
    const Signatures signatures = work();
    letter.seconds = threadSeconds() - start;
    done = write(signatures, letter);
  }
  catch (...) { // a failure like a crash
  }
  ::_exit(done ? 0 : 1); // no destructors: they belong to the parent
}

} // namespace

std::optional<IsolatedResult>
runIsolated(const std::function<Signatures()>& work, unsigned seconds)
{
  const SharedLetter letter;
  if (letter.get() == nullptr)
    return std::nullopt;
  const pid_t child = ::fork();
  if (child == 0)
    runChild(work, seconds, *letter.get());
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status) ||
      WEXITSTATUS(status) != 0)
    return std::nullopt;
  return IsolatedResult{read(*letter.get()), letter.get()->seconds};
}

} // namespace apps
} // namespace pcl_surflet
