// A StepMap for a problem template and a method recipe. A recipe has Stepper<P, A> and bind<P, A>(problem).
#pragma once

#include <optional>
#include <variant>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/methods/element/context.hpp"
#include "hamflow/numerics/dense.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/run/step_map.hpp"
#include "hamflow/verify/reference_flow.hpp"

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
template <template <class> class Family, bool quad>
struct QuadProblem {
  using type = std::optional<Family<Quad>>;
};
template <template <class> class Family>
struct QuadProblem<Family, false> {
  using type = std::optional<std::monostate>;
};
}  // namespace detail

/// @tparam Family a class template over the number type of its parameters   @tparam Recipe see above
/// @tparam quad also in quad
template <template <class> class Family, class Recipe, bool quad = false>
class StepMapOf final : public StepMap {
  using P = Family<double>;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<double, n>;
  template <class R>
  using Arithmetic = std::conditional_t<always_compensated<Recipe>(), Compensated<R>, Plain<R>>;

 public:
  /// @param make Family<R> for double and long double: called as make.template operator()<R>()
  template <class Make>
  StepMapOf(Make&& make, Recipe recipe)
      : problem_(make.template operator()<double>()),
        long_problem_(make.template operator()<long double>()),
        quad_problem_(in_quad(make)),
        recipe_(std::move(recipe)),
        size_(degrees_of_freedom(problem_)) {}

  std::size_t dimension() const override { return size_; }
  MethodInfo claims() const override { return recipe_.template bind<P, Arithmetic<double>>(problem_).info(); }
  bool advance(State<double>& z, double h, std::int64_t steps) const override { return go(problem_, z, h, steps); }
  bool advance(State<long double>& z, long double h, std::int64_t steps) const override {
    return go(long_problem_, z, h, steps);
  }

  bool has_quad() const override { return quad; }
  bool advance(State<Quad>& z, const Quad& h, std::int64_t steps) const override {
    if constexpr (quad) {
      return go(*quad_problem_, z, h, steps);
    } else {
      return false;
    }
  }

  /// One direction at a time: column k is the derivative along coordinate k of z.
  std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const override {
    if constexpr (Recipe::implicit) {
      return implicit_jacobian(z, h);
    } else {
      using D = Dual<double, 1>;
      using A = Plain<D>;
      std::vector<std::vector<double>> rows(2 * size_, std::vector<double>(2 * size_));
      for (std::size_t k = 0; k < 2 * size_; ++k) {
        auto method = recipe_.template bind<P, A>(problem_);
        PhasePoint<A, n> point;
        point.store(seeded(detail::part_of<double, n>(z, 0), k, 0),
                    seeded(detail::part_of<double, n>(z, size_), k, size_));
        (void)method.step(problem_, h, point);
        for (std::size_t i = 0; i < size_; ++i) {
          rows[i][k] = point.q[i].slope[0];
          rows[size_ + i][k] = point.p[i].slope[0];
        }
      }
      return rows;
    }
  }

  bool advance_with_tangents(State<double>& z, std::vector<State<double>>& tangents, double h,
                             std::int64_t steps) const override {
    if constexpr (Recipe::implicit) {
      return implicit_tangents(z, tangents, h, steps);
    } else {
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
    std::vector<double> all{simulation.energy().initial};
    for (int b = 0; b < blocks; ++b) {
      if (simulation.advance(steps) != Outcome::done) break;
      all.push_back(simulation.energy().final);
    }
    return all;
  }
  double energy_scale(const State<double>& z) const override { return simulation_from(z, 1.0).energy_scale(); }
  Effort cost(const State<double>& z, double h, std::int64_t steps) const override {
    auto simulation = simulation_from(z, h);
    (void)simulation.advance(steps);
    return simulation.effort();
  }
  State<long double> flow(const State<long double>& z, long double t) const override {
    return follow(long_problem_, z, t);
  }
  State<Quad> flow(const State<Quad>& z, const Quad& t) const override {
    if constexpr (quad) {
      return follow(*quad_problem_, z, t);
    } else {
      return z;
    }
  }

 private:
  template <class Make>
  static auto in_quad(Make& make) {
    if constexpr (quad) {
      return std::optional(make.template operator()<Quad>());
    } else {
      return std::optional<std::monostate>();
    }
  }
  template <class Q, class R>
  static State<R> follow(const Q& problem, const State<R>& z, const R& t) {
    auto point = zeros < R, n == dynamic ? dynamic : 2 * n > (z.size());
    for (std::size_t i = 0; i < z.size(); ++i) point[i] = z[i];
    const auto end = reference_flow(problem, point, t);
    return {end.begin(), end.end()};
  }

  auto simulation_from(const State<double>& z, double h) const {
    using A = Arithmetic<double>;
    auto method = recipe_.template bind<P, A>(problem_);
    return SimulationOf<P, decltype(method), A, NoProbe>(problem_, method, detail::part_of<double, n>(z, 0),
                                                         detail::part_of<double, n>(z, size_), h);
  }

  template <class Q, class R>
  bool go(const Q& problem, State<R>& z, const R& h, std::int64_t steps) const {
    using A = Arithmetic<R>;
    auto method = recipe_.template bind<Q, A>(problem);
    PhasePoint<A, n> point;
    point.store(detail::part_of<R, n>(z, 0), detail::part_of<R, n>(z, size_));
    for (std::int64_t i = 0; i < steps; ++i) {
      if (method.step(problem, h, point) != Outcome::done) return false;
    }
    z = detail::joined<R, n>(point.positions(), point.momenta());
    return true;
  }

  /// x as dual numbers; the k-th of all coordinates, of which x is `first` and following, is the variable.
  static Vector<Dual<double, 1>, n> seeded(const V& x, std::size_t k, std::size_t first) {
    auto y = zeros<Dual<double, 1>, n>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      y[i] = x[i];
      if (first + i == k) y[i].slope[0] = 1;
    }
    return y;
  }

  /// With r(z0, u) = 0 and z1 = z0 + u: du/dz0 = -(dr/du)^-1 dr/dz0, at the converged solution.
  std::vector<std::vector<double>> implicit_jacobian(const State<double>& z, double h) const {
    using A = Arithmetic<double>;
    using D = Dual<double, 1>;
    const V q0 = detail::part_of<double, n>(z, 0);
    const V p0 = detail::part_of<double, n>(z, size_);
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(q0, p0);
    if (method.step(problem_, h, point) != Outcome::done) return {};
    V du_q = point.positions();
    V du_p = point.momenta();
    for (std::size_t i = 0; i < size_; ++i) {
      du_q[i] -= q0[i];
      du_p[i] -= p0[i];
    }
    const std::size_t width = 2 * size_;
    std::vector<double> by_u(width * width);
    std::vector<double> by_z(width * width);
    for (std::size_t k = 0; k < 4 * size_; ++k) {
      const Increment<D, n> u{seeded(du_q, k, 0), seeded(du_p, k, size_)};
      Increment<D, n> r;
      method.equations(problem_, h, seeded(q0, k, 2 * size_), seeded(p0, k, 3 * size_), u, r);
      auto& matrix = k < 2 * size_ ? by_u : by_z;
      const std::size_t column = k % width;
      for (std::size_t i = 0; i < size_; ++i) {
        matrix[i * width + column] = r.q[i].slope[0];
        matrix[(size_ + i) * width + column] = r.p[i].slope[0];
      }
    }
    detail::solve_large(by_u.data(), by_z.data(), width, width);
    std::vector<std::vector<double>> rows(width, std::vector<double>(width));
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t k = 0; k < width; ++k) rows[i][k] = (i == k ? 1.0 : 0.0) - by_z[i * width + k];
    }
    return rows;
  }

  /// x as dual numbers along the tangent vector whose part from `first` on belongs to x.
  static Vector<Dual<double, 1>, n> along(const V& x, const State<double>& tangent, std::size_t first) {
    auto y = zeros<Dual<double, 1>, n>(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      y[i] = x[i];
      y[i].slope[0] = tangent[first + i];
    }
    return y;
  }

  /// One method takes one direction through all steps, so that what it keeps from step to step is used here, too.
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

  /// Step by step t <- t - (dr/du)^-1 (dr/dz0) t, see implicit_jacobian(). A step that was replaced by two halves does
  /// not solve the one equation: refused.
  bool implicit_tangents(State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps) const {
    using A = Arithmetic<double>;
    using D = Dual<double, 1>;
    auto method = recipe_.template bind<P, A>(problem_);
    PhasePoint<A, n> point;
    point.store(detail::part_of<double, n>(z, 0), detail::part_of<double, n>(z, size_));
    const std::size_t width = 2 * size_;
    const std::size_t columns = tangents.size();
    std::vector<double> by_u(width * width);
    std::vector<double> right(width * columns);
    for (std::int64_t step = 0; step < steps; ++step) {
      const V q0 = point.positions();
      const V p0 = point.momenta();
      const auto halved = method.effort().halved;
      if (method.step(problem_, h, point) != Outcome::done || method.effort().halved != halved) return false;
      V du_q = point.positions();
      V du_p = point.momenta();
      for (std::size_t i = 0; i < size_; ++i) {
        du_q[i] -= q0[i];
        du_p[i] -= p0[i];
      }
      const auto column = [&](const Increment<D, n>& u, const Vector<D, n>& q, const Vector<D, n>& p, double* out,
                              std::size_t stride) {
        Increment<D, n> r;
        method.equations(problem_, h, q, p, u, r);
        for (std::size_t i = 0; i < size_; ++i) {
          out[i * stride] = r.q[i].slope[0];
          out[(size_ + i) * stride] = r.p[i].slope[0];
        }
      };
      const State<double> fixed(width);
      for (std::size_t k = 0; k < width; ++k) {
        column({seeded(du_q, k, 0), seeded(du_p, k, size_)}, along(q0, fixed, 0), along(p0, fixed, size_), &by_u[k],
               width);
      }
      for (std::size_t k = 0; k < columns; ++k) {
        column({along(du_q, fixed, 0), along(du_p, fixed, size_)}, along(q0, tangents[k], 0),
               along(p0, tangents[k], size_), &right[k], columns);
      }
      if (columns > 0) detail::solve_large(by_u.data(), right.data(), width, columns);
      for (std::size_t k = 0; k < columns; ++k) {
        for (std::size_t i = 0; i < width; ++i) tangents[k][i] -= right[i * columns + k];
      }
    }
    z = detail::joined<double, n>(point.positions(), point.momenta());
    return true;
  }

  P problem_;
  Family<long double> long_problem_;
  typename detail::QuadProblem<Family, quad>::type quad_problem_;
  Recipe recipe_;
  std::size_t size_;
};

}  // namespace hamflow
