// The StepMap of every method, on problems behind virtual calls: compiled once for each method.
#include "hamflow/run/recorded_tangents.hpp"
#include "hamflow/verify/step_map_of.hpp"
#include "visit_erased.hpp"

namespace hamflow {

namespace {
template <Capability c>
struct Faces {
  template <class R>
  using Of = Erased<R, c>;
};
/// Tangent vectors in double go through the recorded step.
template <Capability c, class Recipe>
TangentSteps tangents_of(const ErasedFunctions<double>& functions, const Recipe& recipe) {
  using Traced = AnyProblem<Trace<double>, c>;
  return recorded_tangents([problem = Traced(functions.size, functions.trace), recipe](const Vector<double, dynamic>& q,
                                                                                       const Vector<double, dynamic>& p,
                                                                                       double h, RecordedAt at) {
    using A = Plain<Trace<double>>;
    return record_step<A>(problem, recipe.template bind<Traced, A>(problem), q, p, h, {}, false, at);
  });
}
}  // namespace

std::unique_ptr<StepMap> erased_step_map(const ErasedProblem& problem, const MethodSpec& method) {
  return visit_erased(problem.in_double.capability, problem.in_double.size, method,
                      [&]<Capability c, class Recipe>(const Recipe& recipe) -> std::unique_ptr<StepMap> {
                        const auto make = [&]<class R>() { return problem.in<R>().template as<c>(); };
                        auto map = std::make_unique<StepMapOf<Faces<c>::template Of, Recipe, true>>(make, recipe);
                        if constexpr (is_recorded<Recipe>()) {
                          map->take_tangents_by(tangents_of<c>(problem.in_double, recipe));
                        }
                        return map;
                      });
}

}  // namespace hamflow
