# How Eigen aligns memory in the PCL that is installed: with -mavx, -march=native or
# -fsanitize=address Eigen aligns and
# frees differently, and objects that cross to libraries built without crash. So everything that
# shares clouds with this PCL must take PCL's values, whatever its own flags. They follow from the
# options that PCL asks its users to compile with, which are those it was built with.
set(probe ${CMAKE_CURRENT_BINARY_DIR}/eigen_alignment.cpp)
file(WRITE ${probe} "#include <pcl/pcl_config.h>
#include <Eigen/Core>
#ifdef PCL_USES_EIGEN_HANDMADE_ALIGNED_MALLOC // PCL 1.15 tells itself
#undef EIGEN_MALLOC_ALREADY_ALIGNED
#define EIGEN_MALLOC_ALREADY_ALIGNED !PCL_USES_EIGEN_HANDMADE_ALIGNED_MALLOC
#endif
#if EIGEN_MALLOC_ALREADY_ALIGNED
alignment EIGEN_MAX_ALIGN_BYTES 1
#else
alignment EIGEN_MAX_ALIGN_BYTES 0
#endif
")
set(includes ${PCL_INCLUDE_DIRS})
list(TRANSFORM includes PREPEND -I)
execute_process(COMMAND ${CMAKE_CXX_COMPILER} -std=c++17 ${PCL_COMPILE_OPTIONS} ${includes} -E
  ${probe} OUTPUT_VARIABLE preprocessed ERROR_VARIABLE problem)
if(NOT preprocessed MATCHES "alignment ([0-9]+) ([01])")
  message(FATAL_ERROR "Eigen's alignment could not be told from its headers: ${problem}")
endif()
set(PCL_SURFLET_EIGEN_MAX_ALIGN_BYTES ${CMAKE_MATCH_1} CACHE STRING
  "EIGEN_MAX_ALIGN_BYTES that PCL was built with")
set(PCL_SURFLET_EIGEN_MALLOC_ALREADY_ALIGNED ${CMAKE_MATCH_2} CACHE STRING
  "EIGEN_MALLOC_ALREADY_ALIGNED that PCL was built with")
set(pcl_surflet_eigen_definitions
  EIGEN_MAX_ALIGN_BYTES=${PCL_SURFLET_EIGEN_MAX_ALIGN_BYTES}
  EIGEN_MALLOC_ALREADY_ALIGNED=${PCL_SURFLET_EIGEN_MALLOC_ALREADY_ALIGNED})
