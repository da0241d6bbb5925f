#define HAMFLOW_BULK_KERNELS exact_avx2
#define HAMFLOW_BULK_FAST 0
#include "kernel_body.hpp"
