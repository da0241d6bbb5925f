// From a method's name and options to a recipe, an object that binds the typed stepper to a problem and an arithmetic.
#pragma once

#include "hamflow/methods/boris.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/dop853.hpp"
#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/taylor.hpp"
#include "hamflow/run/catalog.hpp"
#include "tableau_list.hpp"  // generated: includes every tableau, defines HAMFLOW_FOR_EACH_TABLEAU

namespace hamflow {

/// Whether the method is compiled with every problem in double. What is bound by more than its forces runs behind
/// virtual calls there, too.
template <class Recipe>
inline constexpr bool has_typed_kernel =
    !std::is_same_v<Recipe, Dop853> && !std::is_same_v<Recipe, Taylor> && !std::is_same_v<Recipe, ForceGradient>;

/// Any table of one shape, its length known at run time.
template <Shape shape>
struct TableRecipe {
  template <class P>
  static constexpr bool accepts = Separable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;  // every kick and drift is one-to-one on the lattice
  const MethodEntry* entry;
  bool needs_quadratic_kinetic() const { return entry->splitting != nullptr && entry->splitting->nystroem; }
  template <class P, class A>
  using Stepper = Splitting<P, A, shape>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    using Base = typename Stepper<P, A>::Base;
    if (entry->kind == MethodKind::splitting) {
      return {sequence_of<Base>(*entry->splitting), detail::describe_splitting, entry->splitting};
    }
    return {sequence_of<Base>(*entry->composition, entry->starts_with),
            entry->starts_with == StartsWith::kick ? detail::describe_kick_first : detail::describe_drift_first,
            entry->composition};
  }
};

/// Whether a problem has what the method needs. Some tables, which are known at run time, need more than others.
template <class P, class Recipe>
bool is_accepted(const Recipe& recipe) {
  if constexpr (Recipe::template accepts<P> && !QuadraticKinetic<P> && requires { recipe.needs_quadratic_kinetic(); }) {
    return !recipe.needs_quadratic_kinetic();
  } else {
    return Recipe::template accepts<P>;
  }
}

/// Runs at full speed: the common shapes in plain double have kernels of their own. What is rare, or bound by its
/// arithmetic, shares one whose shape is known at run time, which costs a branch a step and takes a quarter of the time
/// to compile.
template <class Recipe>
auto with_shape_at_run_time(const Recipe& recipe) {
  if constexpr (requires { recipe.entry; }) {
    return TableRecipe<Shape::any>{recipe.entry};
  } else {
    return recipe;
  }
}

/// The compositions that begin with a kick keep their kernel: for compensated sums, where the order of operations
/// within a step decides about a tenth of its time.
template <class Recipe>
auto with_few_shapes(const Recipe& recipe) {
  if constexpr (std::is_same_v<Recipe, TableRecipe<Shape::kick_drift_kick>>) {
    return recipe;
  } else {
    return with_shape_at_run_time(recipe);
  }
}

inline Shape shape_of(const MethodEntry& entry) {
  return entry.kind == MethodKind::splitting ? sequence_of<double>(*entry.splitting).shape()
                                             : sequence_of<double>(*entry.composition, entry.starts_with).shape();
}

/// Calls f with the recipe of a method: the one place where a name becomes a type.
template <class F>
auto visit_method(const MethodSpec& spec, F&& f) {
  const MethodEntry& entry = find_method(spec.name);
  if (entry.kind == MethodKind::cg) return f(Cg{spec.cg});
  if (entry.kind == MethodKind::boris) return f(Boris{});
  if (entry.kind == MethodKind::dop853) return f(Dop853{spec.adaptive});
  if (entry.kind == MethodKind::taylor) return f(Taylor{spec.adaptive});
  if (entry.kind == MethodKind::force_gradient) return f(ForceGradient{entry.force_gradient});
#define HAMFLOW_TRY_TABLEAU(table) \
  if (entry.name == tableaus::table.name) return f(RungeKuttaBy<tableaus::table>{});
  HAMFLOW_FOR_EACH_TABLEAU(HAMFLOW_TRY_TABLEAU)
#undef HAMFLOW_TRY_TABLEAU
  switch (shape_of(entry)) {
    case Shape::kick_drift_kick:
      return f(TableRecipe<Shape::kick_drift_kick>{&entry});
    case Shape::drift_kick_drift:
      return f(TableRecipe<Shape::drift_kick_drift>{&entry});
    case Shape::kick_drift:
    case Shape::drift_kick:
    case Shape::any:
      break;
  }
  return f(TableRecipe<Shape::any>{&entry});
}

}  // namespace hamflow
