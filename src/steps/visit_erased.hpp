// Selects the capability set of a problem behind virtual calls for which a method is compiled. Each method is compiled
// for as few sets as it needs.
#pragma once

#include <array>

#include "engine/erased.hpp"
#include "methods/recipes.hpp"

namespace hamflow {

namespace detail {
/// The capability sets of a recipe in order of preference: those that it declares, or the smallest set that it accepts.
template <class M>
constexpr auto capability_sets_of() {
  if constexpr (requires { M::capability_sets; }) {
    return std::to_array(M::capability_sets);
  } else if constexpr (M::template accepts<Erased<double, Capability::smooth>>) {
    // If H = T + V, the derivatives come in two parts.
    return std::array{Capability::separable, Capability::smooth};
  } else if constexpr (M::template accepts<Erased<double, Capability::separable>>) {
    return std::array{Capability::separable};
  } else {
    return std::array{Capability::separable | Capability::quadratic_kinetic};
  }
}

/// The result type is explicit, because clang++ 14 fails to deduce it: it omits functions that f needs.
template <class Result, class M, std::size_t k, class F>
Result visit_capability_set(Capability offered, const M& recipe, F&& f) {
  constexpr auto sets = capability_sets_of<M>();
  static_assert(M::template accepts<Erased<double, sets[k]>>, "hamflow: a recipe must accept its capability sets");
  if constexpr (k + 1 < sets.size()) {
    if (!includes(offered, sets[k])) return visit_capability_set<Result, M, k + 1>(offered, recipe, f);
  }
  return f.template operator()<sets[k]>(recipe);
}
}  // namespace detail

/// Calls f.operator()<set>(recipe) with the first capability set of the recipe that the problem offers. cg(1) for a
/// large system is replaced by the implementation for elements of higher degree, which needs no matrix.
/// @param size the degrees of freedom
/// @tparam Result the result type of f
template <class Result, class F>
Result visit_erased(Capability offered, std::size_t size, const MethodSpec& spec, F&& f) {
  return visit_method(spec, [&]<class M>(const M& recipe) -> Result {
    if constexpr (std::is_same_v<M, Cg>) {
      if (size > most_dense_unknowns)
        return detail::visit_capability_set<Result, Averages, 0>(offered, Averages{recipe.options}, f);
    }
    const auto of_any_shape = with_shape_at_run_time(recipe);
    return detail::visit_capability_set<Result, std::remove_cv_t<decltype(of_any_shape)>, 0>(offered, of_any_shape, f);
  });
}

}  // namespace hamflow
