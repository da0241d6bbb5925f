#define HAMFLOW_BULK_KERNELS exact_sse2
#define HAMFLOW_BULK_FAST 0
#include "kernel_body.hpp"
