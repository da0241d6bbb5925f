// A user's own Hamiltonian from generic lambdas; gradients and Hessians come from dual numbers.
//   auto quartic = hamflow::separable<1>([](const auto& p) { return p[0]*p[0]/2; },
//                                        [](const auto& q) { return q[0]*q[0]*q[0]*q[0]/4; });
#pragma once

#include <cmath>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow {

template <std::size_t N, class T, class V, bool Quadratic>
struct SeparableFunctions {
  using Real = double;
  static constexpr std::size_t dimension = N;
  static constexpr bool quadratic_kinetic = Quadratic;
  T kinetic_function;
  V potential_function;

  SeparableFunctions(T kinetic, V potential) : kinetic_function(kinetic), potential_function(potential) {
    if constexpr (Quadratic) expect_quadratic();
  }

  template <class S>
  requires std::is_invocable_v < T, const Vector<S, N>
  & > S kinetic(const Vector<S, N>& p) const { return kinetic_function(p); }
  template <class S>
  requires std::is_invocable_v < V, const Vector<S, N>
  & > S potential(const Vector<S, N>& q) const { return potential_function(q); }

 private:
  /// T = p^T M^-1 p/2 has T(s p) = s^2 T(p), and the parallelogram law; asked of momenta in general position. Powers of
  /// 2 change no bit of such a T but the exponent.
  void expect_quadratic() const {
    Vector<double, N> x{};
    Vector<double, N> y{};
    for (std::size_t i = 0; i < N; ++i) {
      x[i] = 0.7071067811865475 + 0.3 * static_cast<double>(i % 7);
      y[i] = 0.5772156649015329 - 0.9 * static_cast<double>(i % 5);
    }
    const auto at = [&](double a, double b) {
      Vector<double, N> p{};
      for (std::size_t i = 0; i < N; ++i) p[i] = a * x[i] + b * y[i];
      return static_cast<double>(kinetic_function(p));
    };
    const double one = at(1, 0);
    const double other = at(0, 1);
    const double size = std::abs(one) + std::abs(other) + std::abs(at(1, 1)) + std::abs(at(1, -1));
    const auto is = [&](double found, double wanted) { return std::abs(found - wanted) <= 1e-9 * size; };
    if (is(at(2, 0) / 4, one) && is(at(0, 4) / 16, other) && is(at(1, 1) + at(1, -1), 2 * (one + other))) return;
    throw Error(
        "hamflow: natural() needs T = p^T M^-1 p/2 with constant M, and this T is not quadratic in p; use "
        "separable()");
  }
};

namespace detail {
template <std::size_t N, class T, class V>
constexpr void expect_generic() {
  static_assert(std::is_invocable_v<T, const Vector<Dual<double, N>, N>&> &&
                    std::is_invocable_v<V, const Vector<Dual<double, N>, N>&>,
                "hamflow: T and V are called with dual numbers too: write [](const auto& p) and [](const auto& q)");
}
}  // namespace detail

/// H = T(p) + V(q) with N degrees of freedom. @param kinetic, potential generic callables of a Vector<S, N>
template <std::size_t N, class T, class V>
auto separable(T kinetic, V potential) {
  detail::expect_generic<N, T, V>();
  return SeparableFunctions<N, T, V, false>{kinetic, potential};
}

/// As above, for T = p^T M^-1 p/2 with constant M. Implicit elements then have half as many unknowns.
template <std::size_t N, class T, class V>
auto natural(T kinetic, V potential) {
  detail::expect_generic<N, T, V>();
  return SeparableFunctions<N, T, V, true>{kinetic, potential};
}

template <std::size_t N, class H>
struct HamiltonianFunction {
  using Real = double;
  static constexpr std::size_t dimension = N;
  H function;

  template <class S>
  requires std::is_invocable_v < H, const Vector<S, N>
  &, const Vector<S, N>& > S energy(const Vector<S, N>& q, const Vector<S, N>& p) const { return function(q, p); }
};

/// Any H(q, p). Methods that need H = T + V refuse it at compile time.
template <std::size_t N, class H>
auto hamiltonian(H function) {
  using Both = Vector<Dual<double, 2 * N>, N>;
  static_assert(std::is_invocable_v<H, const Both&, const Both&>,
                "hamflow: H is called with dual numbers too: write [](const auto& q, const auto& p)");
  return HamiltonianFunction<N, H>{function};
}

}  // namespace hamflow
