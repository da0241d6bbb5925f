// **MethodRecipe**: the object by which a user chooses a method. It makes a stepper for a problem and an arithmetic.
//     struct Verlet {
//       static constexpr bool implicit = false;        // whether a step solves equations
//       static constexpr bool bijective = true;        // whether every action of a step is one-to-one on a lattice
//       template <class P>
//       static constexpr bool accepts = Separable<P>;  // whether the problem has the capabilities that it needs
//       template <class P, class A>
//       using Stepper = VerletStep<P, A>;              // has info, step, effort, invalidate, archive
//       template <class P, class A>
//       Stepper<P, A> bind(const P& problem) const;
//     };
// It may declare `compensated` (always adds increments with compensation; the default for implicit methods), `typed`
// (compiled in double for every problem of the catalogue, for methods whose own work dominates a step; by default it
// runs behind virtual calls), `recorded` (a step in double is a straight-line program, which is recorded and compiled),
// and `capability_sets`, the sets of capabilities for which it is compiled, in order of preference
// (src/steps/visit_erased.hpp).
#pragma once

#include <concepts>

#include "hamflow/detail/core/capability.hpp"

namespace hamflow {

namespace detail {
/// A problem type without members. Concepts instantiate a recipe with it, to check that the recipe has a member.
struct UnspecifiedProblem {
  using Real = double;
  static constexpr std::size_t dimension = 1;
};
}  // namespace detail

template <class M>
concept MethodRecipe = std::copy_constructible<M> && requires {
  { M::implicit } -> std::convertible_to<bool>;
  { M::bijective } -> std::convertible_to<bool>;
  { M::template accepts<detail::UnspecifiedProblem> } -> std::convertible_to<bool>;
};

/// Methods that conserve the energy add their increments with compensation in every arithmetic; the others compute in
/// the plain type of the problem unless another is requested.
template <class M>
constexpr bool always_compensated() {
  static_assert(MethodRecipe<M>,
                "hamflow: a method is chosen by a MethodRecipe: implicit, bijective, accepts<P>, Stepper<P, A> and "
                "bind<P, A>(problem); see methods/recipe.hpp");
  if constexpr (requires { M::compensated; }) {
    return M::compensated;
  } else {
    return M::implicit;
  }
}

template <class M>
constexpr bool has_typed_kernel() {
  if constexpr (requires { M::typed; }) {
    return M::typed;
  } else {
    return false;
  }
}

/// Whether the memory of a stepper depends only on positions, so that the sign of a momentum may be changed.
template <class Stepper>
constexpr bool memory_depends_on_positions_only() {
  return requires { Stepper::memory_depends_on_positions_only; };
}

/// Whether a step in double can be recorded (src/engine/recorded_step.hpp).
template <class M>
constexpr bool is_recorded() {
  if constexpr (requires { M::recorded; }) {
    return M::recorded;
  } else {
    return false;
  }
}

}  // namespace hamflow
