// The instructions that every processor has: in place of src/bulk/instruction_sets.cpp and the kernels for AVX.
#include "bulk/kernel.hpp"
#include "hamflow/core/bulk_forces.hpp"

namespace hamflow {

namespace bulk {
const Kernels avx2{};
const Kernels avx512{};
}  // namespace bulk

bool BulkForces::has(BulkSet set) { return set == BulkSet::sse2; }

}  // namespace hamflow
