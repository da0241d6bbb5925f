// A StepMap for a problem template and a method recipe. A recipe has Stepper<P, A> and bind<P, A>(problem).
#pragma once

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/numerics/dense.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/verify/reference_flow.hpp"
#include "hamflow/verify/step_map.hpp"

namespace hamflow {

namespace detail {
template <class R, std::size_t N>
void split(const State<R>& z, Vector<R, N>& q, Vector<R, N>& p) {
  for (std::size_t i = 0; i < N; ++i) {
    q[i] = z[i];
    p[i] = z[N + i];
  }
}
template <class R, std::size_t N>
State<R> joined(const Vector<R, N>& q, const Vector<R, N>& p) {
  State<R> z(q.begin(), q.end());
  z.insert(z.end(), p.begin(), p.end());
  return z;
}
}  // namespace detail

/// @tparam Family a class template over the number type of its parameters   @tparam Recipe see above
template <template <class> class Family, class Recipe>
class StepMapOf final : public StepMap {
  using P = Family<double>;
  static constexpr std::size_t n = P::dimension;
  /// Implicit elements add their increments with compensation.
  template <class R>
  using Arithmetic = std::conditional_t<Recipe::implicit, Compensated<R>, Plain<R>>;

 public:
  /// @param make Family<R> for double and long double: called as make.template operator()<R>()
  template <class Make>
  StepMapOf(Make&& make, Recipe recipe)
      : problem_(make.template operator()<double>()),
        long_problem_(make.template operator()<long double>()),
        recipe_(std::move(recipe)) {}

  std::size_t dimension() const override { return n; }
  MethodInfo claims() const override { return recipe_.template bind<P, Arithmetic<double>>(problem_).info(); }
  bool advance(State<double>& z, double h, std::int64_t steps) const override { return go(problem_, z, h, steps); }
  bool advance(State<long double>& z, long double h, std::int64_t steps) const override {
    return go(long_problem_, z, h, steps);
  }

  std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const override {
    if constexpr (Recipe::implicit) {
      return implicit_jacobian(z, h);
    } else {
      using D = Dual<double, 2 * n>;
      using A = Plain<D>;
      auto method = recipe_.template bind<P, A>(problem_);
      PhasePoint<A, n> point;
      for (std::size_t i = 0; i < n; ++i) {
        point.q[i] = D::variable(z[i], i);
        point.p[i] = D::variable(z[n + i], n + i);
      }
      (void)method.step(problem_, h, point);
      std::vector<std::vector<double>> rows;
      for (const auto& x : point.q) rows.emplace_back(x.slope.begin(), x.slope.end());
      for (const auto& x : point.p) rows.emplace_back(x.slope.begin(), x.slope.end());
      return rows;
    }
  }

  std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const override {
    using A = Arithmetic<double>;
    Vector<double, n> q{};
    Vector<double, n> p{};
    detail::split(z, q, p);
    auto method = recipe_.template bind<P, A>(problem_);
    SimulationOf<P, decltype(method), A, NoProbe> simulation(problem_, method, q, p, h);
    std::vector<double> all{simulation.energy().initial};
    for (int b = 0; b < blocks; ++b) {
      if (simulation.advance(steps) != Outcome::done) break;
      all.push_back(simulation.energy().final);
    }
    return all;
  }
  double energy_scale(const State<double>& z) const override {
    Vector<double, n> q{};
    Vector<double, n> p{};
    detail::split(z, q, p);
    return larger(abs(energy(problem_, q, p)), abs(problem_.kinetic(p)) + abs(problem_.potential(q)));
  }
  Effort cost(const State<double>& z, double h, std::int64_t steps) const override {
    using A = Arithmetic<double>;
    Vector<double, n> q{};
    Vector<double, n> p{};
    detail::split(z, q, p);
    auto method = recipe_.template bind<P, A>(problem_);
    SimulationOf<P, decltype(method), A, NoProbe> simulation(problem_, method, q, p, h);
    (void)simulation.advance(steps);
    return simulation.effort();
  }
  State<long double> flow(const State<long double>& z, long double t) const override {
    Vector<long double, 2 * n> point{};
    for (std::size_t i = 0; i < 2 * n; ++i) point[i] = z[i];
    const auto end = reference_flow(long_problem_, point, t);
    return {end.begin(), end.end()};
  }

 private:
  template <class Q, class R>
  bool go(const Q& problem, State<R>& z, R h, std::int64_t steps) const {
    using A = Arithmetic<R>;
    Vector<R, n> q{};
    Vector<R, n> p{};
    detail::split(z, q, p);
    auto method = recipe_.template bind<Q, A>(problem);
    PhasePoint<A, n> point;
    point.store(q, p);
    for (std::int64_t i = 0; i < steps; ++i) {
      if (method.step(problem, h, point) != Outcome::done) return false;
    }
    z = detail::joined(point.positions(), point.momenta());
    return true;
  }

  /// With r(q0, p0, d) = 0 and p1 = p0 + g(q0, p0, d): dd = -(dr/dd)^-1 (dr/dz0) dz0, q1 = q0 + d.
  std::vector<std::vector<double>> implicit_jacobian(const State<double>& z, double h) const {
    using A = Arithmetic<double>;
    using D = Dual<double, 3 * n>;
    Vector<double, n> q{};
    Vector<double, n> p{};
    detail::split(z, q, p);
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(q, p);
    if (method.step(problem_, h, point) != Outcome::done) return {};
    Vector<D, n> q0{};
    Vector<D, n> p0{};
    Vector<D, n> d{};
    Vector<D, n> r{};
    Vector<D, n> g{};
    const Vector<double, n> q1 = point.positions();
    for (std::size_t i = 0; i < n; ++i) {
      q0[i] = D::variable(q[i], i);
      p0[i] = D::variable(p[i], n + i);
      d[i] = D::variable(q1[i] - q[i], 2 * n + i);
    }
    method.equations(problem_, h, q0, p0, d, r, g);
    Matrix<double, n> by_d{};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) by_d[i][j] = r[i].slope[2 * n + j];
    }
    std::vector<std::vector<double>> rows(2 * n, std::vector<double>(2 * n));
    for (std::size_t k = 0; k < 2 * n; ++k) {
      Vector<double, n> right{};
      for (std::size_t i = 0; i < n; ++i) right[i] = -r[i].slope[k];
      const Vector<double, n> dd = solve(by_d, right);
      for (std::size_t i = 0; i < n; ++i) {
        rows[i][k] = (i == k ? 1.0 : 0.0) + dd[i];
        double dp = (n + i == k ? 1.0 : 0.0) + g[i].slope[k];
        for (std::size_t j = 0; j < n; ++j) dp += g[i].slope[2 * n + j] * dd[j];
        rows[n + i][k] = dp;
      }
    }
    return rows;
  }

  P problem_;
  Family<long double> long_problem_;
  Recipe recipe_;
};

}  // namespace hamflow
