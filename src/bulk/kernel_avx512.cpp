#define HAMFLOW_BULK_KERNELS avx512
#include "kernel_body.hpp"
