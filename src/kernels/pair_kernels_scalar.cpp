#include "kernels/lanes_scalar.h"
#include "kernels/pair_kernels_impl.h"

PCL_SURFLET_DEFINE_KERNELS(scalar_kernels, "scalar", ScalarLanes)
