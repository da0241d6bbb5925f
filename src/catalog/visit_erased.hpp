// Which face of a problem behind virtual calls a method works on. A face is a set of capabilities; each method is
// compiled on as few as it needs.
#pragma once

#include <array>

#include "erased.hpp"
#include "recipes.hpp"

namespace hamflow {

namespace detail {
/// The faces of a recipe, the preferred one first: those that it declares, or the one with the fewest capabilities that
/// it accepts.
template <class M>
constexpr auto faces_of() {
  if constexpr (requires { M::faces; }) {
    return std::to_array(M::faces);
  } else if constexpr (M::template accepts<Erased<double, Capability::smooth>>) {
    // Derivatives come in two parts where H has two.
    return std::array{Capability::separable, Capability::smooth};
  } else if constexpr (M::template accepts<Erased<double, Capability::separable>>) {
    return std::array{Capability::separable};
  } else {
    return std::array{Capability::separable | Capability::quadratic_kinetic};
  }
}

template <class M, std::size_t k, class F>
auto visit_face(Capability offered, const M& recipe, F&& f) {
  constexpr auto faces = faces_of<M>();
  static_assert(M::template accepts<Erased<double, faces[k]>>, "hamflow: a recipe has to accept its faces");
  if constexpr (k + 1 < faces.size()) {
    if (!includes(offered, faces[k])) return visit_face<M, k + 1>(offered, recipe, f);
  }
  return f.template operator()<faces[k]>(recipe);
}
}  // namespace detail

/// Calls f.operator()<face>(recipe) with the first face of the recipe that the problem offers.
template <class F>
auto visit_erased(Capability offered, const MethodSpec& spec, F&& f) {
  return visit_method(spec, [&](const auto& recipe) {
    const auto of_any_shape = with_shape_at_run_time(recipe);
    return detail::visit_face<std::remove_cv_t<decltype(of_any_shape)>, 0>(offered, of_any_shape, f);
  });
}

}  // namespace hamflow
