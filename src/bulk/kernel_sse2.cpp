#define HAMFLOW_BULK_KERNELS sse2
#include "kernel_body.hpp"
