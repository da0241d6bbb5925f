// Quantities wanted at *every* step are a probe, a template argument of the step loop. `NoProbe` compiles to nothing.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

namespace detail {
template <class P, class R>
concept HasInvariants = requires(const P& problem, const VectorOf<P, R>& x) {
  problem.invariants(x, x);
};

template <class P, class R>
struct InvariantCount {
  static constexpr std::size_t value = 0;
};
template <class P, class R>
requires HasInvariants<P, R>
struct InvariantCount<P, R> {
  static constexpr std::size_t value = decltype(std::declval<const P&>().invariants(
      std::declval<VectorOf<P, R>>(), std::declval<VectorOf<P, R>>()))::size();
};
}  // namespace detail

/// Watches nothing.
struct NoProbe {
  template <class P, class R, std::size_t N>
  void start(const P&, const Vector<R, N>&, const Vector<R, N>&) {}
  template <class P, class R, std::size_t N>
  bool look(const P&, const Vector<R, N>&, const Vector<R, N>&) {
    return true;
  }
};

/// The largest deviation of the energy and of each invariant from its start.
template <class P, class R>
class ConservationProbe {
 public:
  static constexpr std::size_t count = detail::InvariantCount<P, R>::value;
  template <std::size_t N>
  void start(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p) {
    energy_ = {hamflow::energy(problem, q, p), R(0)};
    if constexpr (count > 0) {
      const auto values = problem.invariants(q, p);
      for (std::size_t i = 0; i < count; ++i) invariants_[i] = {values[i], R(0)};
    }
  }
  /// False where the energy is not finite. With all it calls it belongs into the loop over steps, where its square
  /// roots and divisions hide behind those of the step.
  template <std::size_t N>
  [[gnu::flatten]] bool look(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p) {
    const R error = abs(hamflow::energy(problem, q, p) - energy_.initial);
    energy_.worst = larger(energy_.worst, error);
    if constexpr (count > 0) {
      const auto values = problem.invariants(q, p);
      for (std::size_t i = 0; i < count; ++i) {
        invariants_[i].worst = larger(invariants_[i].worst, R(abs(values[i] - invariants_[i].initial)));
      }
    }
    return error <= std::numeric_limits<R>::max();  // false for NaN and infinity
  }
  R initial_energy() const { return energy_.initial; }
  R worst_energy_error() const { return energy_.worst; }
  R initial(std::size_t i) const { return invariants_[i].initial; }
  R worst(std::size_t i) const { return invariants_[i].worst; }

 private:
  struct Watched {
    R initial{};
    R worst{};
  };
  Watched energy_;
  Watched invariants_[count > 0 ? count : 1]{};
};

}  // namespace hamflow
