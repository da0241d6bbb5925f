// Which vector instructions this processor has. A portable build has src/portable/plain_instructions.cpp instead.
#include "hamflow/core/bulk_forces.hpp"

namespace hamflow {

bool BulkForces::has(BulkSet set) {
  switch (set) {
    case BulkSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
    case BulkSet::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    default:
      return true;
  }
}

}  // namespace hamflow
