// A StepMap for a problem template and a method recipe. A recipe has Stepper<P, A> and bind<P, A>(problem).
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "core/constrained_motion.hpp"
#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/numerics/dense.hpp"
#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "reference_flow.hpp"

namespace hamflow {

namespace detail {
template <class R, std::size_t N>
Vector<R, N> part_of(const State<R>& z, std::size_t first) {
  Vector<R, N> x = zeros<R, N>(z.size() / 2);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = z[first + i];
  return x;
}
template <class R, std::size_t N>
State<R> joined(const Vector<R, N>& q, const Vector<R, N>& p) {
  State<R> z(q.begin(), q.end());
  z.insert(z.end(), p.begin(), p.end());
  return z;
}
/// Returns an orthonormal basis of the orthogonal complement of the rows, by the Gram-Schmidt process, done twice.
inline std::vector<State<double>> orthogonal_to(std::vector<State<double>> rows) {
  const std::size_t size = rows.at(0).size();
  const std::size_t given = rows.size();
  for (std::size_t k = 0; k < size; ++k) {
    rows.emplace_back(size);
    rows.back()[k] = 1;
  }
  std::vector<State<double>> all;
  for (std::size_t k = 0; k < rows.size() && all.size() < size; ++k) {
    State<double>& x = rows[k];
    const auto length = [&] {
      double square = 0;
      for (const double part : x) square += part * part;
      return sqrt(square);
    };
    const double before = length();
    for (int pass = 0; pass < 2; ++pass) {
      for (const State<double>& other : all) {
        double along = 0;
        for (std::size_t i = 0; i < size; ++i) along += other[i] * x[i];
        for (std::size_t i = 0; i < size; ++i) x[i] -= along * other[i];
      }
    }
    const double rest = length();
    if (!(rest > 1e-6 * before)) continue;  // the vector depends on the others
    for (double& part : x) part /= rest;
    all.push_back(x);
  }
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(given));
  return all;
}
/// A method that carries a second copy of the state.
template <class M>
concept CarriesCopy = requires(const M& method) {
  method.copy();
};
/// Sets a state and a method to z. If z is (q, x, p, y), (x, y) is the copy that the method carries.
template <class A, std::size_t N, class M, class R>
PhasePoint<A, N> placed(const State<R>& z, [[maybe_unused]] std::size_t size, [[maybe_unused]] M& method) {
  const auto part = [&](std::size_t first) {
    auto x = zeros<typename A::Real, N>(size);
    for (std::size_t i = 0; i < size; ++i) x[i] = z[first + i];
    return x;
  };
  PhasePoint<A, N> point;
  point.store(part(0), part(z.size() / 2));
  if constexpr (CarriesCopy<M>) {
    if (z.size() == 4 * size) {
      PhasePoint<A, N> copy;
      copy.store(part(size), part(3 * size));
      method.begin_with(copy);
    }
  }
  return point;
}
/// Reads a state and a method into z; the inverse of placed().
template <class A, std::size_t N, class M, class R>
void read_state_into(const PhasePoint<A, N>& point, [[maybe_unused]] const M& method, State<R>& z) {
  const auto put = [&](std::size_t first, const auto& x) {
    for (std::size_t i = 0; i < x.size(); ++i) z[first + i] = x[i];
  };
  put(0, point.positions());
  put(z.size() / 2, point.momenta());
  if constexpr (CarriesCopy<M>) {
    const std::size_t size = point.q.size();
    if (z.size() == 4 * size) {
      put(size, method.copy().positions());
      put(3 * size, method.copy().momenta());
    }
  }
}
template <class P, class R>
State<R> flow_of(const P& problem, const State<R>& z, const R& t) {
  constexpr std::size_t n = P::dimension;
  auto point = zeros < R, n == dynamic ? dynamic : 2 * n > (z.size());
  for (std::size_t i = 0; i < z.size(); ++i) point[i] = z[i];
  const auto end = [&] {
    if constexpr (Constrained<P>) {
      return reference_flow(ConstrainedField<P>(problem), point, t);
    } else {
      return reference_flow(problem, point, t);
    }
  }();
  return {end.begin(), end.end()};
}
/// Projects a state to the nearest one that satisfies the constraints of a problem.
template <class P, class R>
State<R> projected_to_constraints([[maybe_unused]] const P& problem, const State<R>& z) {
  if constexpr (Constrained<P>) {
    auto q = part_of<R, P::dimension>(z, 0);
    auto p = part_of<R, P::dimension>(z, z.size() / 2);
    move_onto_constraints(problem, q, p);
    return joined<R, P::dimension>(q, p);
  } else {
    return z;
  }
}
}  // namespace detail

/// The functions of a map in addition to steps in double and long double. nothing: none. quad: steps and flows in quad,
/// compiled with the map. given: steps and flows in quad, and the flow in long double, as functions that are compiled
/// in other files.
enum class Beyond { nothing, quad, given };
/// The functions for Beyond::given.
struct GivenMaps {
  std::function<std::unique_ptr<Simulation>(const State<double>& z, double h)> simulation;
  std::function<State<long double>(const State<long double>& z, long double t)> flow;
  std::function<bool(State<Quad>& z, const Quad& h, std::int64_t steps)> advance_in_quad;
  std::function<State<Quad>(const State<Quad>& z, const Quad& t)> flow_in_quad;
  std::function<State<Quad>(const State<Quad>& z)> settle_in_quad;
};

namespace detail {
template <template <class> class Family, Beyond beyond>
struct BeyondDouble {};
template <template <class> class Family>
struct BeyondDouble<Family, Beyond::quad> {
  Family<Quad> problem;
};
template <template <class> class Family>
struct BeyondDouble<Family, Beyond::given> : GivenMaps {};
}  // namespace detail

/// @tparam Family a class template over the number type of its parameters   @tparam Recipe see above
template <template <class> class Family, class Recipe, Beyond beyond = Beyond::nothing>
class StepMapOf final : public StepMap {
  using P = Family<double>;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<double, n>;
  template <class R>
  using Arithmetic = std::conditional_t<always_compensated<Recipe>(), Compensated<R>, Plain<R>>;

 public:
  /// @param make returns Family<R>, called as make.template operator()<R>() for double, long double and quad if needed
  template <class Make>
  StepMapOf(Make&& make, Recipe recipe) requires(beyond != Beyond::given)
      : problem_(make.template operator()<double>()),
        long_problem_(make.template operator()<long double>()),
        beyond_(in_quad(make)),
        recipe_(std::move(recipe)),
        size_(degrees_of_freedom(problem_)) {}
  template <class Make>
  StepMapOf(Make&& make, Recipe recipe, GivenMaps given) requires(beyond == Beyond::given)
      : problem_(make.template operator()<double>()),
        long_problem_(make.template operator()<long double>()),
        beyond_{std::move(given)},
        recipe_(std::move(recipe)),
        size_(degrees_of_freedom(problem_)) {}

  void take_tangents_by(TangentSteps way) { tangent_steps_ = std::move(way); }

  std::size_t dimension() const override { return size_; }
  MethodInfo claims() const override { return recipe_.template bind<P, Arithmetic<double>>(problem_).info(); }
  State<double> begun(const State<double>& z) const override {
    if constexpr (!detail::CarriesCopy<typename Recipe::template Stepper<P, Arithmetic<double>>>) {
      return z;
    } else {
      State<double> both;
      for (std::size_t first : {std::size_t{0}, size_}) {
        for (int copy = 0; copy < 2; ++copy) both.insert(both.end(), &z[first], &z[first] + size_);
      }
      return both;
    }
  }
  State<long double> settled(const State<long double>& z) const override {
    return detail::projected_to_constraints(long_problem_, z);
  }
  State<Quad> settled(const State<Quad>& z) const override {
    if constexpr (beyond == Beyond::quad) {
      return detail::projected_to_constraints(beyond_.problem, z);
    } else if constexpr (beyond == Beyond::given) {
      return beyond_.settle_in_quad(z);
    } else {
      return z;
    }
  }
  std::vector<State<double>> directions(const State<double>& z) const override {
    if constexpr (Constrained<P>) {
      return detail::orthogonal_to(residual_gradients(z));
    } else {
      return {};
    }
  }
  bool advance(State<double>& z, double h, std::int64_t steps) const override { return go(problem_, z, h, steps); }
  bool advance(State<long double>& z, long double h, std::int64_t steps) const override {
    return go(long_problem_, z, h, steps);
  }

  bool has_quad() const override { return beyond != Beyond::nothing; }
  bool advance(State<Quad>& z, const Quad& h, std::int64_t steps) const override {
    if constexpr (beyond == Beyond::quad) {
      return go(beyond_.problem, z, h, steps);
    } else if constexpr (beyond == Beyond::given) {
      return beyond_.advance_in_quad(z, h, steps);
    } else {
      return false;
    }
  }

  /// Computes the Jacobian column by column; column k is the derivative along coordinate k of z.
  std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const override {
    if constexpr (Recipe::implicit) {
      return implicit_jacobian(z, h);
    } else {
      using D = Dual<double, 1>;
      using A = Plain<D>;
      std::vector<std::vector<double>> rows(z.size(), std::vector<double>(z.size()));
      for (std::size_t k = 0; k < z.size(); ++k) {
        auto method = recipe_.template bind<P, A>(problem_);
        State<D> at(z.begin(), z.end());
        at[k].slope[0] = 1;
        auto point = detail::placed<A, n>(at, size_, method);
        (void)method.step(problem_, h, point);
        detail::read_state_into(point, method, at);
        for (std::size_t i = 0; i < z.size(); ++i) rows[i][k] = at[i].slope[0];
      }
      return rows;
    }
  }

  bool advance_with_tangents(State<double>& z, std::vector<State<double>>& tangents, double h,
                             std::int64_t steps) const override {
    if constexpr (Recipe::implicit) {
      return implicit_tangents(z, tangents, h, steps);
    } else {
      if (tangent_steps_ && tangent_steps_(z, tangents, h, steps)) return true;
      const State<double> from = z;
      if (!go(problem_, z, h, steps)) return false;
      for (State<double>& tangent : tangents) {
        if (!explicit_tangent(from, tangent, h, steps)) return false;
      }
      return true;
    }
  }

  std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const override {
    auto simulation = simulation_from(z, h);
    std::vector<double> all{simulation->energy().initial};
    for (int b = 0; b < blocks; ++b) {
      if (simulation->advance(steps) != Outcome::done) break;
      all.push_back(simulation->energy().final);
    }
    return all;
  }
  double energy_scale(const State<double>& z) const override { return simulation_from(z, 1.0)->energy_scale(); }
  Effort cost(const State<double>& z, double h, std::int64_t steps) const override {
    auto simulation = simulation_from(z, h);
    (void)simulation->advance(steps);
    return simulation->effort();
  }
  State<long double> flow(const State<long double>& z, long double t) const override {
    if constexpr (beyond == Beyond::given) {
      return beyond_.flow(z, t);
    } else {
      return detail::flow_of(long_problem_, z, t);
    }
  }
  State<Quad> flow(const State<Quad>& z, const Quad& t) const override {
    if constexpr (beyond == Beyond::quad) {
      return detail::flow_of(beyond_.problem, z, t);
    } else if constexpr (beyond == Beyond::given) {
      return beyond_.flow_in_quad(z, t);
    } else {
      return z;
    }
  }

 private:
  template <class Make>
  static detail::BeyondDouble<Family, beyond> in_quad(Make& make) {
    if constexpr (beyond == Beyond::quad) {
      return {make.template operator()<Quad>()};
    } else {
      return {};
    }
  }
  /// Returns the gradients of the constraints g and of g' M^-1 p, as functions of (q, p).
  std::vector<State<double>> residual_gradients(const State<double>& z) const {
    std::vector<State<double>> all;
    for (std::size_t k = 0; k < z.size(); ++k) {
      const auto q = dual_along_coordinate(detail::part_of<double, n>(z, 0), k);
      const auto p = dual_along_coordinate(detail::part_of<double, n>(z, size_), k, size_);
      const auto position = constraints(problem_, q);
      const auto rates = products(constraint_gradients(problem_, q), inverse_mass_times(problem_, p));
      all.resize(2 * position.size(), State<double>(z.size()));
      for (std::size_t j = 0; j < position.size(); ++j) {
        all[j][k] = position[j].slope[0];
        all[position.size() + j][k] = rates[j].slope[0];
      }
    }
    return all;
  }

  std::unique_ptr<Simulation> simulation_from(const State<double>& z, double h) const {
    if constexpr (beyond == Beyond::given) {
      return beyond_.simulation(z, h);
    } else {
      using A = Arithmetic<double>;
      auto method = recipe_.template bind<P, A>(problem_);
      return std::make_unique<SimulationOf<P, decltype(method), A, NoProbe>>(
          problem_, method, detail::part_of<double, n>(z, 0), detail::part_of<double, n>(z, size_), h);
    }
  }

  template <class Q, class R>
  bool go(const Q& problem, State<R>& z, const R& h, std::int64_t steps) const {
    using A = Arithmetic<R>;
    auto method = recipe_.template bind<Q, A>(problem);
    auto point = detail::placed<A, n>(z, size_, method);
    for (std::int64_t i = 0; i < steps; ++i) {
      if (method.step(problem, h, point) != Outcome::done) return false;
    }
    detail::read_state_into(point, method, z);
    return true;
  }

  /// Returns x as dual numbers. x has the coordinates from `first` on, and coordinate k of all is the variable.
  template <std::size_t N>
  static Vector<Dual<double, 1>, N> dual_along_coordinate(const Vector<double, N>& x, std::size_t k,
                                                          std::size_t first = 0) {
    auto y = zeros<Dual<double, 1>, N>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      y[i] = x[i];
      if (first + i == k) y[i].slope[0] = 1;
    }
    return y;
  }

  /// Returns dz1/dz0 of one implicit step, column by column.
  std::vector<std::vector<double>> implicit_jacobian(const State<double>& z, double h) const {
    using A = Arithmetic<double>;
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(detail::part_of<double, n>(z, 0), detail::part_of<double, n>(z, size_));
    std::vector<State<double>> columns(2 * size_, State<double>(2 * size_));
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k][k] = 1;
    if (!implicit_step(method, h, point, columns)) return {};
    std::vector<std::vector<double>> rows(2 * size_, std::vector<double>(2 * size_));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < columns.size(); ++k) rows[i][k] = columns[k][i];
    }
    return rows;
  }

  /// Returns x as dual numbers along a tangent vector, whose part from `first` on belongs to x.
  static Vector<Dual<double, 1>, n> along(const V& x, const State<double>& tangent, std::size_t first) {
    auto y = zeros<Dual<double, 1>, n>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      y[i] = x[i];
      y[i].slope[0] = tangent[first + i];
    }
    return y;
  }

  /// Carries one tangent vector through all steps with the same method object, so that it can use its data from step to
  /// step.
  bool explicit_tangent(const State<double>& z, State<double>& tangent, double h, std::int64_t steps) const {
    using A = Plain<Dual<double, 1>>;
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(along(detail::part_of<double, n>(z, 0), tangent, 0),
                along(detail::part_of<double, n>(z, size_), tangent, size_));
    for (std::int64_t i = 0; i < steps; ++i) {
      if (method.step(problem_, h, point) != Outcome::done) return false;
    }
    for (std::size_t i = 0; i < size_; ++i) {
      tangent[i] = point.q[i].slope[0];
      tangent[size_ + i] = point.p[i].slope[0];
    }
    return true;
  }

  bool implicit_tangents(State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps) const {
    using A = Arithmetic<double>;
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(detail::part_of<double, n>(z, 0), detail::part_of<double, n>(z, size_));
    for (std::int64_t step = 0; step < steps; ++step) {
      if (!implicit_step(method, h, point, tangents)) return false;
    }
    z = detail::joined<double, n>(point.positions(), point.momenta());
    return true;
  }

  /// One step and its tangents. With r(z0, U) = 0 and z1 = z0 + E(U) the implicit function theorem gives
  ///     t1 = t0 - E_U (dr/dU)^-1 (dr/dz0) t0
  /// at the converged solution, for any number of unknowns. Returns false for a step that was halved, because it does
  /// not solve this equation.
  template <class Method, class Point>
  bool implicit_step(Method& method, double h, Point& point, std::vector<State<double>>& tangents) const {
    using D = Dual<double, 1>;
    const V q0 = point.positions();
    const V p0 = point.momenta();
    typename Method::Unknowns u{};
    const auto halved = method.effort().halved;
    if (method.step(problem_, h, point, u) != Outcome::done || method.effort().halved != halved) return false;
    const std::size_t unknowns = u.size();
    const std::size_t columns = tangents.size();
    if (columns == 0) return true;
    std::vector<double> by_unknowns(unknowns * unknowns);
    std::vector<double> right(unknowns * columns);
    const auto residual = [&](const auto& q, const auto& p, const auto& at, double* out, std::size_t stride) {
      const auto r = method.residual(problem_, h, q, p, at);
      for (std::size_t i = 0; i < unknowns; ++i) out[i * stride] = r[i].slope[0];
    };
    const State<double> fixed(2 * size_);
    std::vector<State<double>> increments(unknowns);  // the columns of E_U
    for (std::size_t k = 0; k < unknowns; ++k) {
      const auto at = dual_along_coordinate(u, k);
      residual(along(q0, fixed, 0), along(p0, fixed, size_), at, &by_unknowns[k], unknowns);
      const Increment<D, n> e = method.increment(at);
      increments[k].resize(2 * size_);
      for (std::size_t i = 0; i < size_; ++i) {
        increments[k][i] = e.q[i].slope[0];
        increments[k][size_ + i] = e.p[i].slope[0];
      }
    }
    for (std::size_t k = 0; k < columns; ++k) {
      residual(along(q0, tangents[k], 0), along(p0, tangents[k], size_), dual_along_coordinate(u, unknowns), &right[k],
               columns);
    }
    detail::solve_large(by_unknowns.data(), right.data(), unknowns, columns);
    for (std::size_t k = 0; k < columns; ++k) {
      for (std::size_t j = 0; j < unknowns; ++j) {
        for (std::size_t i = 0; i < 2 * size_; ++i) tangents[k][i] -= increments[j][i] * right[j * columns + k];
      }
    }
    return true;
  }

  P problem_;
  Family<long double> long_problem_;
  detail::BeyondDouble<Family, beyond> beyond_;
  Recipe recipe_;
  std::size_t size_;
  TangentSteps tangent_steps_;
};

}  // namespace hamflow
