#define HAMFLOW_BULK_KERNELS fast_avx512
#define HAMFLOW_BULK_FAST 1
#include "kernel_body.hpp"
