// The StepMap of every method, on problems behind virtual calls: compiled once for each method.
#include "hamflow/verify/step_map_of.hpp"
#include "visit_erased.hpp"

namespace hamflow {

namespace {
template <Capability c>
struct Faces {
  template <class R>
  using Of = Erased<R, c>;
};
}  // namespace

std::unique_ptr<StepMap> erased_step_map(const ErasedProblem& problem, const MethodSpec& method) {
  return visit_erased(problem.in_double.capability, method,
                      [&]<Capability c, class Recipe>(const Recipe& recipe) -> std::unique_ptr<StepMap> {
                        const auto make = [&]<class R>() { return problem.in<R>().template as<c>(); };
                        return std::make_unique<StepMapOf<Faces<c>::template Of, Recipe, true>>(make, recipe);
                      });
}

}  // namespace hamflow
