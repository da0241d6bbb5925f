// [Gross1999, appendix C]: the tangents that it prints against the derivative of its residual, and its count of
// iterations. Newton's method begins at the last state there, and ends at |R| <= 1e-13.
#include <algorithm>

#include "../experiment.hpp"
#include "../pendulum_runs.hpp"
#include "hamflow/core/dual.hpp"
#include "hamflow/numerics/elimination.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::reproduction {

namespace pendulum_listing {

template <class S>
using Four = std::array<S, 4>;  // q1, q2, p1, p2
constexpr double dt = 0.01;

/// The residual of a step, equation 3.168.
template <class Problem, class S>
Four<S> residual(const Problem& problem, const Four<S>& a, const Four<S>& b) {
  using R = typename Problem::Real;
  const auto rule = gauss_rule<R>(5);
  Four<S> r{b[0] - a[0], b[1] - a[1], b[2] - a[2], b[3] - a[3]};
  for (std::size_t i = 0; i < 5; ++i) {
    const auto at = [&](std::size_t j) { return a[j] + (b[j] - a[j]) * rule.c[i]; };
    Vector<S, 2> dq{}, dp{};
    problem.gradient(Vector<S, 2>{at(0), at(1)}, Vector<S, 2>{at(2), at(3)}, dq, dp);
    const R weight = R(dt) * rule.b[i];
    for (std::size_t j = 0; j < 2; ++j) {
      r[j] = r[j] - dp[j] * weight;
      r[2 + j] = r[2 + j] + dq[j] * weight;
    }
  }
  return r;
}

/// Which power of c a place has: 3 as printed, 4 as equations 3.165, 3.188 and 3.190 have it.
struct Powers {
  int coupling_absolute = 4;  // h of C.1
  int diagonal_relative = 4;  // f1 of C.2
  int coupling_relative = 4;  // h of C.2
};

/// The part of p^T dM/dq^2 p in the tangent as appendix C writes it: dR3/dq1 in absolute, dR4/dq2 in relative angles.
template <class R>
R kinetic_part(bool absolute, const Four<R>& a, const Four<R>& b, const Powers& powers) {
  const auto rule = gauss_rule<R>(5);
  R sum(0);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto at = [&](std::size_t j) { return a[j] + (b[j] - a[j]) * rule.c[i]; };
    const R angle = absolute ? at(0) - at(1) : at(1), p1 = at(2), p2 = at(3);
    const R c = std::cos(angle), s = std::sin(angle), c2 = c * c, s2 = s * s, c4 = c2 * c2;
    const R o = 4 * c2 - 5;
    const auto power = [&](int n) { return n == 4 ? c4 : c2 * c; };
    R f1, f2, h;
    if (absolute) {
      f1 = -48 * c2 * s2 - 20 * s2 - 16 * c4 + 20 * c2;
      f2 = 5 * f1;
      h = c * (16 * power(powers.coupling_absolute) - 25 + 32 * s2 * c2 + 120 * s2);
    } else {
      f1 = -16 * power(powers.diagonal_relative) + 20 * c2 - 20 * s2 - 48 * s2 * c2;
      f2 = -240 * s2 * c - 32 * c4 * c - 96 * c4 + 120 * c2 - 120 * s2 + 50 * c - 288 * s2 * c2 - 64 * s2 * c2 * c;
      h = 120 * s2 * c - 20 * c2 + 20 * s2 - 25 * c + 48 * s2 * c2 + 32 * s2 * c2 * c +
          16 * power(powers.coupling_relative) + 16 * c4 * c;
    }
    sum += (f1 * p1 * p1 + 2 * h * p1 * p2 + f2 * p2 * p2) / (o * o * o) * rule.c[i] * rule.b[i];
  }
  return R(dt) / 18 * sum;  // vor = 1/(m l^2)
}

/// The part of V in the same entry.
template <class R>
R potential_part(bool absolute, const Four<R>& a, const Four<R>& b) {
  const auto rule = gauss_rule<R>(5);
  R sum(0);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto at = [&](std::size_t j) { return a[j] + (b[j] - a[j]) * rule.c[i]; };
    sum += (absolute ? 3 * std::cos(at(0)) : std::cos(at(0) + at(1))) * rule.c[i] * rule.b[i];
  }
  return R(dt) * R(2) * R(3) * parse_decimal<R>("9.81") * sum;
}

/// All derivatives of the residual with respect to its second state.
template <class Problem>
std::array<Four<double>, 4> tangent(const Problem& problem, const Four<double>& a, const Four<double>& b) {
  using D = Dual<double, 4>;
  Four<D> from, to;
  for (std::size_t i = 0; i < 4; ++i) {
    from[i] = D(a[i]);
    to[i] = D::variable(b[i], i);
  }
  const Four<D> r = residual(problem, from, to);
  std::array<Four<double>, 4> k{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) k[i][j] = r[i].slope[j];
  }
  return k;
}

/// The same entry by a divided difference of sixth order in long double.
template <class Problem>
double divided_difference(const Problem& problem, std::size_t row, const Four<long double>& a, Four<long double> b) {
  const std::size_t column = row - 2;
  const long double at = b[column], h = 1e-3L;
  const auto r = [&](int n) {
    b[column] = at + n * h;
    return residual(problem, a, b)[row];
  };
  return static_cast<double>((45 * (r(1) - r(-1)) - 9 * (r(2) - r(-2)) + (r(3) - r(-3))) / (60 * h));
}

struct Place {
  const char* name;
  const char* where;
  bool absolute;
  Four<double> a, b;
  Powers printed;
};

template <template <class> class Problem>
void claim_place(Study& study, const Place& place) {
  const Problem<double> problem(pendulum_masses, pendulum_lengths);
  const Problem<long double> longer(Vector<long double, 2>{2, 2}, Vector<long double, 2>{3, 3});
  const std::size_t row = place.absolute ? 2 : 3;
  const double by_dual = tangent(problem, place.a, place.b)[row][row - 2];
  const auto wide = [](const Four<double>& x) { return Four<long double>{x[0], x[1], x[2], x[3]}; };
  const double by_difference = divided_difference(longer, row, wide(place.a), wide(place.b));
  const double V = potential_part(place.absolute, place.a, place.b);
  const double as_printed_there = V + kinetic_part(place.absolute, place.a, place.b, place.printed);
  const double with_fourth = V + kinetic_part(place.absolute, place.a, place.b, {});
  const auto off = [](double x, double right) { return std::abs(x - right) / std::abs(right); };
  study.claim(
      {place.name,
       fmt::format("the tangent of appendix C is the derivative of its residual with c^3 in {}", place.where), "c^3",
       place.absolute ? "151" : "161, 162"},
      at_most(1e-8, "relative error of that entry of the tangent, to rounding of the derivative"),
      {{off(as_printed_there, by_dual), 1e-11, fmt::format("dual numbers; with c^4 {:.2g}", off(with_fourth, by_dual))},
       {off(as_printed_there, by_difference), 1e-9,
        fmt::format("divided differences of the residual in long double; with c^4 {:.2g}",
                    off(with_fourth, by_difference))}},
      Grounds::ways);
}

struct Counts {
  std::vector<int> iterations;
  double least_second = 1e300;  // |R| after the first correction, the least of all steps
  bool converged = true;
};

/// As appendix C does it, with the exact tangent or with the printed one.
template <class Problem>
Counts run(Study& study, const Problem& problem, bool absolute, bool printed, int steps) {
  Counts counts;
  Four<double> a{0, std::numbers::pi / 2, 0, 0};
  const Powers powers = printed ? Powers{3, 3, 3} : Powers{};
  for (int step = 0; step < steps && counts.converged; ++step) {
    if (step % 100 == 0) study.breathe();
    Four<double> b = a;
    const auto norm = [&](const Four<double>& r) { return std::hypot(std::hypot(r[0], r[1]), std::hypot(r[2], r[3])); };
    Four<double> r = residual(problem, a, b);
    int iteration = 0;
    while (norm(r) > 1e-13) {
      if (++iteration > 15) {
        counts.converged = false;
        break;
      }
      auto k = tangent(problem, a, b);
      if (printed) {
        const double wrong = kinetic_part(absolute, a, b, powers) - kinetic_part(absolute, a, b, {});
        if (absolute) {
          k[2][0] += wrong;
          k[2][1] -= wrong;
          k[3][0] -= wrong;
        }
        k[3][1] += wrong;
      }
      std::array<double, 16> m{};
      for (std::size_t i = 0; i < 16; ++i) m[i] = k[i / 4][i % 4];
      Four<double> x = r;
      detail::eliminate(m.data(), x.data(), 4, 1);
      for (std::size_t i = 0; i < 4; ++i) b[i] -= x[i];
      r = residual(problem, a, b);
      if (iteration == 1) counts.least_second = std::min(counts.least_second, norm(r));
    }
    counts.iterations.push_back(iteration);
    a = b;
  }
  return counts;
}

/// `if iter > maxit, maxit = iter; elseif iter < minit, minit = iter`, after each correction.
int least_of_appendix_c(const std::vector<int>& iterations) {
  int most = 0, least = 15;
  for (const int count : iterations) {
    for (int iteration = 1; iteration <= count; ++iteration) {
      if (iteration > most) {
        most = iteration;
      } else if (iteration < least) {
        least = iteration;
      }
    }
  }
  return least;
}

template <template <class> class Problem>
void claim_iterations(Study& study, bool absolute) {
  const std::string angles = absolute ? "absolute" : "relative";
  const Problem<double> problem(pendulum_masses, pendulum_lengths);
  const Counts right = run(study, problem, absolute, false, 2600), printed = run(study, problem, absolute, true, 2600);
  const auto most = [](const Counts& c) { return *std::max_element(c.iterations.begin(), c.iterations.end()); };
  const auto least = [](const Counts& c) { return *std::min_element(c.iterations.begin(), c.iterations.end()); };
  study.claim(
      {"most_" + angles, "Newton's method converges in at most three iterations in " + angles + " angles", "3", "124"},
      at_most(3, "counted over every step up to t = 26"),
      {{static_cast<double>(most(right)), 0, "with the exact tangent"}});
  study.claim(
      {"most_printed_" + angles,
       "with the printed tangent Newton's method converges in at most three iterations in " + angles + " angles", "3",
       "124"},
      at_most(3, "counted over every step up to t = 26"),
      {{static_cast<double>(most(printed)), 0,
        fmt::format("with c^3; {} after {} steps", printed.converged ? "converged" : "no convergence",
                    printed.iterations.size())}});
  study.claim(
      {"least_" + angles, "a step takes at least one iteration in " + angles + " angles", "1", "124"}, as_printed("1"),
      {{static_cast<double>(least(right)), 0,
        fmt::format("smallest number over all steps, exact tangent; |R| after one correction is at least {:.2g}",
                    right.least_second)},
       {static_cast<double>(least(printed)), 0, "with the printed tangent"}},
      Grounds::ways);
  study.note(
      fmt::format("The counter of appendix C, given these counts ({} angles), prints {} as the smallest: it counts "
                  "every correction, and each step has a first one.",
                  angles, least_of_appendix_c(right.iterations)));
}

void carry_out(Study& study) {
  const Four<double> a{0.3, 1.1, 20, 9}, b{0.35, 1.02, 21, 8.5};
  claim_place<DoublePendulumNonlinearAbsolute>(study, {"absolute_coupling", "h of section C.1", true, a, b, {3, 4, 4}});
  // Where p2 is 0 the coupling does not count.
  claim_place<DoublePendulumNonlinearRelative>(
      study, {"relative_diagonal", "f1 of section C.2", false, {0.3, 1.1, 20, 0}, {0.35, 1.02, 21, 0}, {4, 3, 4}});
  claim_place<DoublePendulumNonlinearRelative>(study,
                                               {"relative_coupling", "h of section C.2", false, a, b, {4, 4, 3}});
  claim_iterations<DoublePendulumNonlinearAbsolute>(study, true);
  claim_iterations<DoublePendulumNonlinearRelative>(study, false);
}

}  // namespace pendulum_listing

std::vector<Experiment> pendulum_listing_experiments() {
  return {
      {{"G-C", gross, "143-162", "the programs of appendix C: tangents and iterations"}, pendulum_listing::carry_out}};
}

}  // namespace hamflow::reproduction
