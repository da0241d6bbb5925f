// From a method's name and options to a recipe (methods/recipe.hpp).
#pragma once

#include <any>

#include "family_list.hpp"  // generated: includes every file of families/, defines families::All
#include "hamflow/methods/recipe.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace families {
template <class... Families>
struct List {
  /// The families in the order of the list.
  static std::vector<MethodFamily> declared() { return {Families::declared()...}; }

  /// Calls f with the recipe of a method of the k-th family.
  template <class F>
  static auto visit(std::size_t k, std::size_t method, const std::any& options, F&& f) {
    return visit_from<0, Families...>(k, method, options, f);
  }

 private:
  template <std::size_t at, class Family, class... Rest, class F>
  static auto visit_from(std::size_t k, std::size_t method, const std::any& options, F&& f) {
    if constexpr (sizeof...(Rest) > 0) {
      if (k != at) return visit_from<at + 1, Rest...>(k, method, options, f);
    }
    return Family::visit(method, options, f);
  }
};
}  // namespace families

/// Calls f with the recipe of a method. Names become types only here.
template <class F>
auto visit_method(const MethodSpec& spec, F&& f) {
  const MethodEntry& entry = find_method(spec.name);
  const std::any options = entry.family->read ? entry.family->read(spec.options) : std::any();
  return families::All::visit(family_number(entry), entry.index, options, [&]<class M>(const M& recipe) {
    static_assert(MethodRecipe<M>, "hamflow: visit() of a family must pass a MethodRecipe, see methods/recipe.hpp");
    return f(recipe);
  });
}

/// Whether a problem has the capabilities that the method needs. Some tables, known at run time, need more than others.
template <class P, class M>
bool is_accepted(const M& recipe) {
  if constexpr (M::template accepts<P> && !QuadraticKinetic<P> && requires { recipe.needs_quadratic_kinetic(); }) {
    return !recipe.needs_quadratic_kinetic();
  } else {
    return M::template accepts<P>;
  }
}

/// The recipe with a shape chosen at run time. Only the common shapes in plain double have kernels of their own. Rare
/// shapes, and slow arithmetics, share one kernel, which costs one branch per step and a quarter of the compile time.
template <class M>
auto with_shape_at_run_time(const M& recipe) {
  if constexpr (requires { recipe.with_any_shape(); }) {
    return recipe.with_any_shape();
  } else {
    return recipe;
  }
}

}  // namespace hamflow
