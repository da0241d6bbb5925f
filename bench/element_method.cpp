// cg(1,5). The hand-written loop is for this problem only. It eliminates p, has five constant Gauss points, the exact
// Jacobian and Cramer's rule, and the initial guess, stopping rule and compensated sums of hamflow. There are two
// forms: one point after the other, and two points at a time in a vector register.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "library.hpp"
#include "other_libraries.hpp"

namespace bench {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Two doubles in one register.
using Two = double __attribute__((vector_size(16)));
inline double root(double x) { return std::sqrt(x); }
inline Two root(Two x) { return Two{std::sqrt(x[0]), std::sqrt(x[1])}; }
inline double total(double x) { return x; }
inline double total(Two x) { return x[0] + x[1]; }

// Gauss-Legendre points on [0, 1] are 1/2 + offset.
constexpr double outer = 0.45308992296933199640, inner = 0.26923465505284154552;
constexpr double b_outer = 0.11846344252809454376, b_inner = 0.23931433524968323402, b_middle = 0.28444444444444444444;

template <class T>
struct Points;
template <>
struct Points<double> {
  static constexpr int groups = 5;
  static constexpr double offset[groups] = {-outer, -inner, 0, inner, outer};
  static constexpr double weight[groups] = {b_outer, b_inner, b_middle, b_inner, b_outer};
};
template <>
struct Points<Two> {
  static constexpr int groups = 3;
  static constexpr Two offset[groups] = {{-outer, outer}, {-inner, inner}, {0, 0}};
  static constexpr Two weight[groups] = {{b_outer, b_outer}, {b_inner, b_inner}, {b_middle, 0}};
};

struct Pair {
  double x, y;
};

/// Adds r to high + low. The rounding error of high is added to low.
inline void add(double& high, double& low, double r) {
  const double increment = r + low;
  const double sum = high + increment;
  const double part = sum - high;
  low = (high - (sum - part)) + (increment - part);
  high = sum;
}

/// @return the number of Newton iterations; negative if a step did not converge
template <class T>
[[gnu::noinline]] std::int64_t hand_cg(Orbit& z, double mass, double k, double h, std::int64_t steps) {
  const double h_by_mass = h / mass, half = h / 2, tangent = h * h / (2 * mass);
  Pair q{z.q[0], z.q[1]}, p{z.p[0], z.p[1]}, q_low{0, 0}, p_low{0, 0};
  Pair last[3]{};  // mean forces
  std::int64_t iterations = 0;
  for (std::int64_t i = 0; i < steps; ++i) {
    Pair f{};
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
    int stalls = 0;
    for (int pass = 0;; ++pass) {
      if (pass == 15) return -1;
      ++iterations;
      const Pair middle{q.x + 0.5 * d.x, q.y + 0.5 * d.y};
      T sx{}, sy{}, sxx{}, sxy{}, syy{};
      for (int l = 0; l < Points<T>::groups; ++l) {
        // Computations that do not need the square root are written before it, so that they run while it is computed.
        const T offset = Points<T>::offset[l], weight = Points<T>::weight[l], moment = weight * (0.5 + offset);
        const T x = middle.x + offset * d.x, y = middle.y + offset * d.y;
        const T xx = x * x, xy = x * y, yy = y * y;
        const T inverse = 1 / (xx + yy);
        const T slope = (k * inverse) * root(inverse);
        const T curvature = slope * (-3 * inverse);
        sx += slope * (weight * x);
        sy += slope * (weight * y);
        sxx += moment * (slope + curvature * xx);
        sxy += moment * (curvature * xy);
        syy += moment * (slope + curvature * yy);
      }
      const double fx = -total(sx), fy = -total(sy), kxx = total(sxx), kxy = total(sxy), kyy = total(syy);
      const Pair target{h_by_mass * (p.x + half * fx), h_by_mass * (p.y + half * fy)};
      const double rx = target.x - d.x, ry = target.y - d.y;
      const double mxx = 1 + tangent * kxx, mxy = tangent * kxy, myy = 1 + tangent * kyy;
      const double inverse_det = 1 / (mxx * myy - mxy * mxy);
      const double ex = (rx * myy - ry * mxy) * inverse_det, ey = (ry * mxx - rx * mxy) * inverse_det;
      d.x += ex;
      d.y += ey;
      f = {fx - (kxx * ex + kxy * ey), fy - (kxy * ex + kyy * ey)};
      const double size = std::max(std::fabs(ex), std::fabs(ey));
      const double noise =
          epsilon * (std::max(std::fabs(target.x), std::fabs(target.y)) + std::max(std::fabs(d.x), std::fabs(d.y)));
      if (!(size <= std::numeric_limits<double>::max())) return -1;
      // The stopping rule of hamflow's NewtonProgress: the rate is size/previous, and the next correction is estimated
      // as rate^2 size.
      stalls = pass > 0 && size > 0.9 * previous ? stalls + 1 : 0;
      if (size <= noise || (pass > 0 && size * size * size <= noise / 16384 * (previous * previous)) ||
          (size > previous / 2 && size <= 64 * noise) || (stalls >= 2 && size <= (1 << 26) * noise)) {
        break;
      }
      previous = size;
    }
    add(q.x, q_low.x, d.x);
    add(q.y, q_low.y, d.y);
    add(p.x, p_low.x, h * f.x);
    add(p.y, p_low.y, h * f.y);
    last[2] = last[1];
    last[1] = last[0];
    last[0] = f;
  }
  z = {{q.x, q.y}, {p.x, p.y}};
  return iterations;
}

/// An iteration is a chain from d to d: the point (3 operations), the force with its derivative (8), five sums, the
/// Jacobian (2) and Cramer's rule (5). A step has two iterations, which are always needed here, and after the last
/// correction the mean force (3), its extrapolation (3) and the next d (3).
constexpr Chain iteration{12, 9, 2, 1};
constexpr Chain chain{2 * iteration.additions + 5, 2 * iteration.multiplications + 4, 2 * iteration.divisions,
                      2 * iteration.square_roots};

template <class T>
Run run_hand(const Task& task, std::int64_t steps) {
  Run run;
  run.end = task.start;
  std::int64_t iterations = 0;
  run.nanoseconds = timed([&] { iterations = hand_cg<T>(run.end, task.mass, task.k, task.h, steps); });
  if (iterations < 0) throw std::runtime_error("the hand-written Newton did not converge");
  run.forces = 1 + 5 * static_cast<double>(iterations);
  return run;
}

}  // namespace

namespace {

/// Compares a method by name, on the problem behind virtual calls, with the template instantiated for the problem.
template <class Recipe>
Workload averages_workload(const std::string& method, const Task& task, const Recipe& recipe) {
  Workload w{method, task.h_text, {}, {}, [h = task.h](std::int64_t steps) { return parting(h, 4, steps); }};
  add_typed(w, task, recipe, 0, true);
  w.contenders.front().against.clear();
  w.contenders.push_back(
      {"named", [=](std::int64_t steps) { return run_named(task, method, false, steps); }, "typed", 1.2});
  return w;
}

}  // namespace

std::vector<Workload> element_workloads(const Task& task) {
  Workload w{"cg(1,5)", task.h_text, chain, {}, {}};
  w.contenders.push_back({"hand", [=](std::int64_t steps) { return run_hand<double>(task, steps); }, {}});
  w.contenders.push_back(
      {"hand, two lanes", [=](std::int64_t steps) { return run_hand<Two>(task, steps); }, "hand", 0, false});
  add_library_contenders(w, task, hamflow::Cg{{.quadrature = 5}}, 1.2, false);
  w.bound = [h = task.h](std::int64_t steps) { return parting(h, 4, steps); };

  // The implicit midpoint rule, for comparison with other libraries.
  Workload midpoint{"cg(1,1)", task.h_text, {}, {}, w.bound};
  add_typed(midpoint, task, hamflow::Cg{{.quadrature = 1}}, 0, true);
  midpoint.contenders.front().against.clear();
  add_other_libraries(midpoint, task);
  std::vector<Workload> all{w};
  if (midpoint.contenders.size() > 1) all.push_back(midpoint);
  using hamflow::CgOfDegree;
  using hamflow::Gauss;
  all.push_back(averages_workload("cg(2,4)", task, CgOfDegree{{.degree = 2, .quadrature = 4}}));
  all.push_back(averages_workload("cg(3,6)", task, CgOfDegree{{.degree = 3, .quadrature = 6}}));
  all.push_back(averages_workload("gauss(4)", task, Gauss{{.stages = 4}}));
  all.push_back(averages_workload("gauss(8)", task, Gauss{{.stages = 8}}));
  return all;
}

}  // namespace bench
