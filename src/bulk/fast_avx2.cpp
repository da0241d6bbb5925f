#define HAMFLOW_BULK_KERNELS fast_avx2
#define HAMFLOW_BULK_FAST 1
#include "kernel_body.hpp"
