// The GNU Scientific Library, with fixed steps by gsl_odeiv2_step_apply. Its rk4, rk2imp and rk4imp compute each step
// twice, as one step and as two half steps, to estimate the error, and return the half steps. A call with 2 h therefore
// counts as two steps of h.
#include "other_libraries.hpp"

#if HAMFLOW_BENCH_GSL

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>

#include <cmath>
#include <memory>

#include "library.hpp"

namespace bench {

namespace {

struct Kepler {
  double inverse_mass, k;
  long long forces = 0;
};

int slope(double, const double z[], double dz[], void* parameters) {
  auto& kepler = *static_cast<Kepler*>(parameters);
  ++kepler.forces;
  const double u = z[0] * z[0] + z[1] * z[1];
  const double s = kepler.k / (u * std::sqrt(u));
  dz[0] = z[2] * kepler.inverse_mass;
  dz[1] = z[3] * kepler.inverse_mass;
  dz[2] = -s * z[0];
  dz[3] = -s * z[1];
  return GSL_SUCCESS;
}

int jacobian(double, const double z[], double* dfdz, double dfdt[], void* parameters) {
  const auto& kepler = *static_cast<Kepler*>(parameters);
  const double u = z[0] * z[0] + z[1] * z[1];
  const double s = kepler.k / (u * std::sqrt(u));
  const double c = -3 * s / u;
  const double xy = -c * z[0] * z[1];
  const double rows[16] = {0,
                           0,
                           kepler.inverse_mass,
                           0,
                           0,
                           0,
                           0,
                           kepler.inverse_mass,  //
                           -s - c * z[0] * z[0],
                           xy,
                           0,
                           0,
                           xy,
                           -s - c * z[1] * z[1],
                           0,
                           0};
  for (int i = 0; i < 16; ++i) dfdz[i] = rows[i];
  for (int i = 0; i < 4; ++i) dfdt[i] = 0;
  return GSL_SUCCESS;
}

/// The implicit steppers end Newton's method at this size of a correction. The others do not use it.
constexpr double newton_tolerance = 1e-12;

struct Free {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};

Runner runner(const gsl_odeiv2_step_type* type, bool halves) {
  return [=](const Task& task, std::int64_t steps) {
    if (halves && steps % 2 != 0) throw std::runtime_error("gsl: an odd number of steps");
    Kepler kepler{1 / task.mass, task.k};
    gsl_odeiv2_system system{slope, jacobian, 4, &kepler};
    const double h = halves ? 2 * task.h : task.h;
    const std::int64_t calls = halves ? steps / 2 : steps;
    // The driver only sets the tolerance of the implicit steppers.
    const std::unique_ptr<gsl_odeiv2_driver, Free> driver(
        gsl_odeiv2_driver_alloc_y_new(&system, type, h, newton_tolerance, 0));
    double z[4] = {task.start.q[0], task.start.q[1], task.start.p[0], task.start.p[1]};
    double error[4];
    int status = GSL_SUCCESS;
    Run run;
    run.nanoseconds = timed([&] {
      for (std::int64_t i = 0; i < calls && status == GSL_SUCCESS; ++i) {
        status = gsl_odeiv2_step_apply(driver->s, 0, h, z, error, nullptr, nullptr, &system);
      }
    });
    if (status != GSL_SUCCESS) throw std::runtime_error(std::string("gsl: ") + gsl_strerror(status));
    run.end = {{z[0], z[1]}, {z[2], z[3]}};
    run.forces = static_cast<double>(kepler.forces);
    return run;
  };
}

}  // namespace

std::vector<OtherLibraryMethod> gsl_peers() {
  // Newton's method leaves up to newton_tolerance in each step, 1e-12/(4 epsilon) = 1100 bounds.
  return {{"gsl", "rk4", "rk4", 4, 2, runner(gsl_odeiv2_step_rk4, true)},
          {"gsl", "rk8pd", "", 8, 1, runner(gsl_odeiv2_step_rk8pd, false)},
          {"gsl", "rk2imp", "cg(1,1)", 2, 2000, runner(gsl_odeiv2_step_rk2imp, true)},
          {"gsl", "rk4imp", "", 4, 1, runner(gsl_odeiv2_step_rk4imp, true)}};
}

std::string gsl_version() { return "GSL " GSL_VERSION; }

}  // namespace bench

#else

namespace bench {
std::vector<OtherLibraryMethod> gsl_peers() { return {}; }
std::string gsl_version() { return "without GSL"; }
}  // namespace bench

#endif
