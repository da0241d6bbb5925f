#define HAMFLOW_BULK_KERNELS exact_avx512
#define HAMFLOW_BULK_FAST 0
#include "kernel_body.hpp"
