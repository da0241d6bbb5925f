// cg(1,5). The hand-written loop eliminates p, takes five Gauss points in constants, the exact tangent, Cramer's rule
// and the first guess and stopping rule of hamflow (down to rounding), all for this one problem.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hamflow/methods/cg.hpp"
#include "library.hpp"

namespace bench {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int points = 5;
// Gauss-Legendre on [0, 1]; the points lie symmetric about 1/2.
constexpr double c[points] = {0.046910077030668003601, 0.23076534494715845448, 0.5, 0.76923465505284154552,
                              0.953089922969331996399};
constexpr double b[points] = {0.11846344252809454376, 0.23931433524968323402, 0.28444444444444444444,
                              0.23931433524968323402, 0.11846344252809454376};
constexpr double bc[points] = {b[0] * c[0], b[1] * c[1], b[2] * c[2], b[3] * c[3], b[4] * c[4]};

struct Pair {
  double x, y;
};

/// s <- s + r with the error kept in low.
inline void add(double& high, double& low, double r) {
  const double increment = r + low;
  const double sum = high + increment;
  const double part = sum - high;
  low = (high - (sum - part)) + (increment - part);
  high = sum;
}

/// @tparam compensated whether the state keeps the rounding errors of its increments, as hamflow does
/// @return force evaluations, negative if Newton failed
template <bool compensated>
[[gnu::noinline]] std::int64_t hand_cg(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const double h_by_mass = h / mass, half = h / 2, tangent = h * h / (2 * mass);
  Pair q{z.q[0], z.q[1]}, p{z.p[0], z.p[1]}, q_low{0, 0}, p_low{0, 0};
  Pair last[3]{};
  std::int64_t iterations = 0;
  for (std::int64_t i = 0; i < steps; ++i) {
    Pair f{};  // mean force
    if (i == 0) {
      const double u = q.x * q.x + q.y * q.y;
      const double slope = k / (u * std::sqrt(u));
      f = {-slope * q.x, -slope * q.y};
    } else if (i == 1) {
      f = last[0];
    } else if (i == 2) {
      f = {2 * last[0].x - last[1].x, 2 * last[0].y - last[1].y};
    } else {
      f = {3 * (last[0].x - last[1].x) + last[2].x, 3 * (last[0].y - last[1].y) + last[2].y};
    }
    Pair d{h_by_mass * (p.x + half * f.x), h_by_mass * (p.y + half * f.y)};
    double previous = 0;
    for (int pass = 0;; ++pass) {
      if (pass == 15) return -1;
      ++iterations;
      double fx = 0, fy = 0, sxx = 0, sxy = 0, syy = 0;
      for (int l = 0; l < points; ++l) {
        // The square root comes last: what does not need it is ready when it arrives.
        const double x = q.x + c[l] * d.x, y = q.y + c[l] * d.y;
        const double xx = x * x, xy = x * y, yy = y * y;
        const double inverse = 1 / (xx + yy);
        const double slope = (k * inverse) * std::sqrt(inverse);
        const double curvature = slope * (-3 * inverse);
        fx -= slope * (b[l] * x);
        fy -= slope * (b[l] * y);
        sxx += bc[l] * (slope + curvature * xx);
        sxy += bc[l] * (curvature * xy);
        syy += bc[l] * (slope + curvature * yy);
      }
      const Pair target{h_by_mass * (p.x + half * fx), h_by_mass * (p.y + half * fy)};
      const double rx = target.x - d.x, ry = target.y - d.y;
      const double kxx = 1 + tangent * sxx, kxy = tangent * sxy, kyy = 1 + tangent * syy;
      const double inverse_det = 1 / (kxx * kyy - kxy * kxy);
      const double ex = (rx * kyy - ry * kxy) * inverse_det, ey = (ry * kxx - rx * kxy) * inverse_det;
      d.x += ex;
      d.y += ey;
      f = {fx - (sxx * ex + sxy * ey), fy - (sxy * ex + syy * ey)};
      const double size = std::max(std::fabs(ex), std::fabs(ey));
      const double noise =
          epsilon * (std::max(std::fabs(target.x), std::fabs(target.y)) + std::max(std::fabs(d.x), std::fabs(d.y)));
      if (!(size <= std::numeric_limits<double>::max())) return -1;
      // rate = size/previous; rate^2 size is what the next correction will come to.
      if (size <= noise || (pass > 0 && size * size * size <= noise / 1024 * (previous * previous)) ||
          (pass > 0 && size > previous / 2 && size <= 64 * noise)) {
        break;
      }
      previous = size;
    }
    if constexpr (compensated) {
      add(q.x, q_low.x, d.x);
      add(q.y, q_low.y, d.y);
      add(p.x, p_low.x, h * f.x);
      add(p.y, p_low.y, h * f.y);
    } else {
      q = {q.x + d.x, q.y + d.y};
      p = {p.x + h * f.x, p.y + h * f.y};
    }
    last[2] = last[1];
    last[1] = last[0];
    last[0] = f;
  }
  z = {{q.x, q.y}, {p.x, p.y}};
  return 1 + iterations * points;
}

template <bool compensated>
Run run_hand(const Task& task, std::int64_t steps) {
  Run run;
  run.end = task.start;
  std::int64_t forces = 0;
  run.nanoseconds = timed([&] { forces = hand_cg<compensated>(run.end, task.mass, task.k, task.h, steps); });
  if (forces < 0) throw std::runtime_error("the hand-written Newton did not converge");
  run.forces = static_cast<double>(forces);
  return run;
}

}  // namespace

std::vector<Workload> element_workloads(const Task& task) {
  Workload w{"cg(1,5)", task.h_text, {}, {}};
  w.contenders.push_back({"hand", [=](std::int64_t steps) { return run_hand<true>(task, steps); }, {}});
  w.contenders.push_back(
      {"hand, plain sums", [=](std::int64_t steps) { return run_hand<false>(task, steps); }, "hand", 0, false});
  add_library_contenders(w, task, hamflow::Cg{{.quadrature = 5}}, 1.2, false);
  w.bound = [h = task.h](std::int64_t steps) {
    // A rounding of 4 epsilon per step, carried on by the flow: a defect delta of the state moves the energy by at most
    // 4/3 delta and with it the phase, so that the states part by (10 + 8 t) delta on this orbit.
    const auto count = static_cast<double>(steps);
    return 4 * epsilon * (10 * count + 4 * h * count * count);
  };
  return {w};
}

}  // namespace bench
