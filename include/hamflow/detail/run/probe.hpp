// A probe computes quantities at *every* step. It is a template argument of the step loop; `NoProbe` compiles to
// nothing.
#pragma once

#include <limits>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

namespace detail {
template <class P, class R>
struct InvariantsOf {
  using type = Vector<R, 1>;  // never used
};
template <class P, class R>
requires HasInvariants<P, R>
struct InvariantsOf<P, R> {
  using type = decltype(std::declval<const P&>().invariants(
      std::declval<const VectorOf<P, R>&>(), std::declval<const VectorOf<P, R>&>(), std::declval<const R&>()));
};

/// The number of components of each invariant; one each unless the problem gives other sizes.
template <class P>
std::vector<std::size_t> invariant_sizes(const P& problem) {
  if constexpr (HasInvariantSizes<P>) {
    const auto sizes = problem.invariant_sizes();
    return {sizes.begin(), sizes.end()};
  } else if constexpr (HasInvariants<P>) {
    using Values = typename InvariantsOf<P, RealOf<P>>::type;
    static_assert(
        requires { typename std::integral_constant<std::size_t, Values::size()>; },
        "hamflow: a problem whose number of invariants is known only at run time must define invariant_sizes()");
    return std::vector<std::size_t>(Values::size(), 1);
  } else {
    return {};
  }
}

/// The problem with parameters in double. Its info() serves all number types, because it takes long to compile.
template <class P>
struct InDouble {
  using type = P;
};
template <template <class> class Family, class R>
requires std::same_as<R, RealOf<Family<R>>>
struct InDouble<Family<R>> {
  using type = Family<double>;
};
template <template <class, template <class> class> class Family, class R, template <class> class Part>
requires std::same_as<R, RealOf<Family<R, Part>>>
struct InDouble<Family<R, Part>> {
  using type = Family<double, Part>;
};

/// The name of a problem with its variant.
template <class P>
std::string problem_label() {
  if constexpr (!std::is_same_v<P, typename InDouble<P>::type>) {
    return problem_label<typename InDouble<P>::type>();
  } else if constexpr (requires { P::info().variant; }) {
    const auto info = P::info();
    std::string text = info.name;
    for (const auto& [key, value] : info.variant) text += " " + key + " = " + value;
    return text;
  } else {
    return "a problem";
  }
}
}  // namespace detail

/// A probe that computes nothing.
struct NoProbe {
  template <class P, class R, std::size_t N>
  void start(const P&, const Vector<R, N>&, const Vector<R, N>&, const R&) {}
  template <class P, class R, std::size_t N>
  bool look(const P&, const Vector<R, N>&, const Vector<R, N>&, const R&) {
    return true;
  }
};

/// The largest deviation of the energy and of each invariant from its start (for several components, the length of the
/// deviation), and the largest kinetic part of H, which is the scale of energy errors whatever constant H contains.
template <class P, class R>
class ConservationProbe {
 public:
  static constexpr bool watches_invariants = HasInvariants<P, R>;
  static constexpr bool watches_kinetic_part = Differentiable<P>;
  using Invariants = typename detail::InvariantsOf<P, R>::type;

  template <std::size_t N>
  void start(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p, const R& t) {
    initial_energy_ = hamflow::energy(problem, q, p);
    if constexpr (watches_kinetic_part) initial_kinetic_ = most_kinetic_ = abs(kinetic_part(problem, q, p));
    if constexpr (watches_invariants) {
      initial_ = problem.invariants(q, p, t);
      worst_ = zeros_like(initial_);
      if constexpr (requires { problem.residual_groups(); }) start_residuals(problem);
    }
  }
  /// Returns false if the energy is not finite. It is inlined with all its calls into the loop over steps, so that its
  /// square roots and divisions overlap with those of the step.
  template <std::size_t N>
  [[gnu::flatten]] bool look(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p,
                             [[maybe_unused]] const R& t) {
    const R difference = hamflow::energy(problem, q, p) - initial_energy_;
    above_ = larger(above_, difference);
    below_ = larger(below_, R(-difference));
    if constexpr (watches_kinetic_part) most_kinetic_ = larger(most_kinetic_, R(abs(kinetic_part(problem, q, p))));
    if constexpr (watches_invariants) {
      const auto values = problem.invariants(q, p, t);
      if constexpr (HasInvariantSizes<P>) {
        look_at_groups(problem.invariant_sizes(), values);
      } else {
        for (std::size_t i = 0; i < values.size(); ++i) {
          worst_[i] = larger(worst_[i], R(abs(values[i] - initial_[i])));
        }
      }
    }
    return abs(difference) <= std::numeric_limits<R>::max();  // false for NaN and infinity
  }
  R initial_energy() const { return initial_energy_; }
  R worst_energy_error() const { return larger(worst_energy_, larger(above_, below_)); }
  /// The smallest and the largest H - H0 since restart_range(), or since start() before that, the state there included.
  R least_difference() const { return R(R(0) - below_); }
  R largest_difference() const { return above_; }
  /// @param difference H - H0 of the present state
  void restart_range(const R& difference) {
    worst_energy_ = worst_energy_error();
    above_ = difference;
    below_ = -difference;
  }
  /// The energy that the motion exchanges: the largest kinetic part so far. If the error is more than a quarter of it,
  /// the result is meaningless and only the kinetic part at the start counts: if p . dH/dp, twice T, has blown up, the
  /// error is half of it.
  R exchanged_energy() const {
    const bool is_motion = R(4) * worst_energy_error() <= most_kinetic_;
    return is_motion && most_kinetic_ <= std::numeric_limits<R>::max() ? most_kinetic_ : initial_kinetic_;
  }
  const Invariants& initial() const { return initial_; }
  /// The largest deviation of the k-th invariant.
  R worst(std::size_t k) const { return worst_[k]; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(initial_energy_, worst_energy_, above_, below_);
    if constexpr (watches_kinetic_part) ar(initial_kinetic_, most_kinetic_);
    if constexpr (watches_invariants) ar(initial_, worst_);
  }

 private:
  /// Begins with the residuals of constraints. Their size is measured, also at the start, and not their change.
  void start_residuals(const P& problem) {
    const auto& sizes = problem.invariant_sizes();
    std::size_t i = 0;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const std::size_t end = i + sizes[k];
      if (k + problem.residual_groups() < sizes.size()) {
        i = end;
        continue;
      }
      R square(0);
      for (; i < end; ++i) {
        square += initial_[i] * initial_[i];
        initial_[i] = R(0);
      }
      worst_[k] = sqrt(square);
    }
  }

  template <class Sizes>
  void look_at_groups(const Sizes& sizes, const Invariants& values) {
    std::size_t i = 0;
    std::size_t k = 0;
    for (const std::size_t size : sizes) {
      if (size == 1) {
        worst_[k] = larger(worst_[k], R(abs(values[i] - initial_[i])));
        ++i;
        ++k;
        continue;
      }
      R square(0);
      for (const std::size_t end = i + size; i < end; ++i) {
        const R difference = values[i] - initial_[i];
        square += difference * difference;
      }
      worst_[k] = larger(worst_[k], R(sqrt(square)));
      ++k;
    }
  }

  R initial_energy_{};
  R worst_energy_{};     // before the current range
  R above_{};            // largest H - H0 of the current range
  R below_{};            // largest H0 - H of it
  R initial_kinetic_{};  // size of the kinetic part at the start
  R most_kinetic_{};
  Invariants initial_{};
  Invariants worst_{};
};

}  // namespace hamflow
