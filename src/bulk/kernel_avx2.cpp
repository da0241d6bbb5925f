#define HAMFLOW_BULK_KERNELS avx2
#include "kernel_body.hpp"
