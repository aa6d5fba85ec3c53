#include "failing_allocation.h"

#include <cstdlib>
#include <new>

namespace pcl_surflet {
namespace test {

thread_local long allocations_left = -1;

} // namespace test
} // namespace pcl_surflet

void*
operator new(std::size_t size)
{
  long& left = pcl_surflet::test::allocations_left;
  if (left > 0)
    --left;
  else if (left == 0)
    throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

/** \brief Sanitizers bring one of their own, whose memory is not malloc()'s. */
void*
operator new(std::size_t size, const std::nothrow_t&) noexcept
{
  return std::malloc(size > 0 ? size : 1);
}

void
operator delete(void* memory) noexcept
{
  std::free(memory);
}

void
operator delete(void* memory, std::size_t) noexcept
{
  std::free(memory);
}
