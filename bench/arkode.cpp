// The implicit midpoint rule in SUNDIALS' ARKODE, with fixed steps, Newton's method with the exact Jacobian, and the
// dense solver. This file defines the table, because not every release of ARKODE has it.
#include "other_libraries.hpp"

#if HAMFLOW_BENCH_ARKODE

#include <arkode/arkode_arkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <memory>

#include "library.hpp"

namespace bench {

namespace {

struct Kepler {
  double inverse_mass, k;
  long long forces = 0;
};

int slope(double, N_Vector at, N_Vector out, void* parameters) {
  auto& kepler = *static_cast<Kepler*>(parameters);
  ++kepler.forces;
  const double* const z = N_VGetArrayPointer_Serial(at);
  double* const dz = N_VGetArrayPointer_Serial(out);
  const double u = z[0] * z[0] + z[1] * z[1];
  const double s = kepler.k / (u * std::sqrt(u));
  dz[0] = z[2] * kepler.inverse_mass;
  dz[1] = z[3] * kepler.inverse_mass;
  dz[2] = -s * z[0];
  dz[3] = -s * z[1];
  return 0;
}

int jacobian(double, N_Vector at, N_Vector, SUNMatrix out, void* parameters, N_Vector, N_Vector, N_Vector) {
  const auto& kepler = *static_cast<Kepler*>(parameters);
  const double* const z = N_VGetArrayPointer_Serial(at);
  const double u = z[0] * z[0] + z[1] * z[1];
  const double s = kepler.k / (u * std::sqrt(u));
  const double c = -3 * s / u;
  double* const* const column = SM_COLS_D(out);  // entries that are not set below are 0 already
  column[2][0] = column[3][1] = kepler.inverse_mass;
  column[0][2] = -s - c * z[0] * z[0];
  column[0][3] = column[1][2] = -c * z[0] * z[1];
  column[1][3] = -s - c * z[1] * z[1];
  return 0;
}

/// Newton's method ends if the correction is below this in ARKODE's weighted norm.
constexpr double tolerance = 1e-13;

void check(int status) {
  if (status < 0) throw std::runtime_error("arkode: status " + std::to_string(status));
}

/// Owns an object of ARKODE.
template <class T>
using Kept = std::unique_ptr<T, void (*)(T*)>;

Run run_midpoint(const Task& task, std::int64_t steps) {
  SUNContext context = nullptr;
  check(SUNContext_Create(nullptr, &context));
  const Kept<_SUNContext> keep_context(context, [](SUNContext it) { SUNContext_Free(&it); });
  const Kept<_generic_N_Vector> z(N_VNew_Serial(4, context), [](N_Vector it) { N_VDestroy(it); });
  double* const numbers = N_VGetArrayPointer_Serial(z.get());
  for (std::size_t i = 0; i < 2; ++i) {
    numbers[i] = task.start.q[i];
    numbers[2 + i] = task.start.p[i];
  }
  Kepler kepler{1 / task.mass, task.k};
  const Kept<void> memory(ARKStepCreate(nullptr, slope, 0, z.get(), context), [](void* it) { ARKStepFree(&it); });
  double c = 0.5, a = 0.5, b = 1;
  const Kept<ARKodeButcherTableMem> table(ARKodeButcherTable_Create(1, 2, 0, &c, &a, &b, nullptr),
                                          [](ARKodeButcherTable it) { ARKodeButcherTable_Free(it); });
  const Kept<_generic_SUNMatrix> matrix(SUNDenseMatrix(4, 4, context), [](SUNMatrix it) { SUNMatDestroy(it); });
  const Kept<_generic_SUNLinearSolver> solver(SUNLinSol_Dense(z.get(), matrix.get(), context),
                                              [](SUNLinearSolver it) { SUNLinSolFree(it); });
  check(ARKStepSetTables(memory.get(), 2, 0, table.get(), nullptr));
  check(ARKStepSStolerances(memory.get(), tolerance, tolerance));
  check(ARKStepSetUserData(memory.get(), &kepler));
  check(ARKStepSetFixedStep(memory.get(), task.h));
  check(ARKStepSetLinearSolver(memory.get(), solver.get(), matrix.get()));
  check(ARKStepSetJacFn(memory.get(), jacobian));
  check(ARKStepSetMaxNonlinIters(memory.get(), 15));
  Run run;
  double t = 0;
  int status = 0;
  const double far = 10 * task.h * static_cast<double>(steps);
  run.nanoseconds = timed([&] {
    for (std::int64_t i = 0; i < steps && status >= 0; ++i) {
      status = ARKStepEvolve(memory.get(), far, z.get(), &t, ARK_ONE_STEP);
    }
  });
  check(status);
  run.end = {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
  run.forces = static_cast<double>(kepler.forces);
  return run;
}

}  // namespace

std::vector<OtherLibraryMethod> arkode_peers() {
  // Newton's method leaves at most a tenth of the tolerance in each step, 1e-14/(4 epsilon) = 11 bounds, and an error
  // from Jacobians of earlier iterations.
  return {{"arkode", "midpoint", "cg(1,1)", 2, 2000, run_midpoint}};
}

std::string arkode_version() { return "SUNDIALS " SUNDIALS_VERSION; }

}  // namespace bench

#else

namespace bench {
std::vector<OtherLibraryMethod> arkode_peers() { return {}; }
std::string arkode_version() { return "without SUNDIALS"; }
}  // namespace bench

#endif
