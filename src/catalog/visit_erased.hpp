// Which face of a problem behind virtual calls a method works on.
#pragma once

#include "erased.hpp"
#include "recipes.hpp"

namespace hamflow {

/// Calls f.operator()<capability>(recipe). Elements choose how to solve a step by what H offers; what only needs
/// derivatives takes them in two parts where H has two.
template <class F>
auto visit_erased(Capability offered, const MethodSpec& spec, F&& f) {
  const bool separable = offered == Capability::natural || offered == Capability::separable;
  return visit_method(spec, [&]<class Recipe>(const Recipe& recipe) {
    constexpr auto natural = Capability::natural;
    if constexpr (std::is_same_v<Recipe, Cg>) {
      if (offered == natural) return f.template operator()<natural>(recipe);
      if (offered == Capability::cyclic) return f.template operator()<Capability::cyclic>(recipe);
      return f.template operator()<Capability::smooth>(recipe);
    } else if constexpr (std::is_same_v<Recipe, Boris>) {
      return f.template operator()<Capability::charge>(recipe);
    } else if constexpr (!Recipe::template accepts<Erased<double, Capability::smooth>>) {
      return f.template operator()<natural>(with_shape_at_run_time(recipe));
    } else {
      return separable ? f.template operator()<natural>(recipe) : f.template operator()<Capability::smooth>(recipe);
    }
  });
}

}  // namespace hamflow
