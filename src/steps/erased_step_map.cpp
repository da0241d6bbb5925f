// The StepMap of every method, on problems behind virtual calls, compiled once for each method. It is not compiled
// again for steps in quad, which simulations take, and for exact flows, which do not depend on methods.
#include <cstring>

#include "engine/recorded_tangents.hpp"
#include "engine/step_map_of.hpp"
#include "visit_erased.hpp"
#include "walls/walled_step_map.hpp"

namespace hamflow {

namespace {
template <Capability c>
struct ErasedWith {
  template <class R>
  using Of = Erased<R, c>;
};
/// Tangent vectors in double use the recorded step.
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

/// The capability set for exact flows: only two kinds of flows are compiled, for any method.
template <Capability c>
constexpr Capability flow_capabilities = includes(c, Capability::constrained) ? c : Capability::smooth;

template <Capability c, class R>
auto flow_of(const ErasedFunctions<R>& functions) {
  return [problem = functions.template as<flow_capabilities<c>>()](const State<R>& z, const R& t) {
    return detail::flow_of(problem, z, t);
  };
}

template <Capability c>
auto settle_of(const ErasedFunctions<Quad>& functions) {
  return [problem = functions.as<flow_capabilities<c>>()](const State<Quad>& z) {
    return detail::projected_to_constraints(problem, z);
  };
}

auto simulations(const ErasedFunctions<double>& functions, const MethodSpec& method) {
  return [functions, method](const State<double>& z, double h) {
    const auto part = [&](std::size_t first) { return detail::part_of<double, dynamic>(z, first); };
    return simulate_erased<double>({functions, part(0), part(functions.size), h}, {.method = method});
  };
}

/// Takes steps from a new start. The stored data of a coordinate begin with its number, in every arithmetic.
auto steps_in_quad(const ErasedFunctions<Quad>& functions, const MethodSpec& method) {
  return [functions, method](State<Quad>& z, const Quad& h, std::int64_t steps) {
    const auto part = [&](std::size_t first) { return detail::part_of<Quad, dynamic>(z, first); };
    const auto simulation =
        simulate_erased<Quad>({functions, part(0), part(functions.size), h}, {.method = method, .arithmetic = "quad"});
    if (simulation->advance(steps) != Outcome::done) return false;
    const std::vector<std::byte> bits = simulation->bits();
    const std::size_t stride = bits.size() / z.size();
    for (std::size_t i = 0; i < z.size(); ++i) Reader(std::span(bits).subspan(i * stride))(z[i]);
    return true;
  };
}

std::unique_ptr<StepMap> map_without_walls(const ErasedProblem& problem, const MethodSpec& method) {
  return visit_erased<std::unique_ptr<StepMap>>(
      problem.in_double.capability, problem.in_double.size, method,
      [&]<Capability c, class Recipe>(const Recipe& recipe) -> std::unique_ptr<StepMap> {
        const auto make = [&]<class R>() { return problem.in<R>().template as<c>(); };
        auto map = std::make_unique<StepMapOf<ErasedWith<c>::template Of, Recipe, Beyond::given>>(
            make, recipe,
            GivenMaps{simulations(problem.in_double, method), flow_of<c>(problem.in_long),
                      steps_in_quad(problem.in_quad, method), flow_of<c>(problem.in_quad),
                      settle_of<c>(problem.in_quad)});
        if constexpr (is_recorded<Recipe>()) {
          map->take_tangents_by(tangents_of<c>(problem.in_double, recipe));
        }
        return map;
      });
}
}  // namespace

std::unique_ptr<StepMap> erased_step_map(const ErasedProblem& problem, const Request& request) {
  const auto& walls = request.walls;
  return walls ? step_map_with_walls(problem, request, *walls, map_without_walls)
               : map_without_walls(problem, request.method);
}

}  // namespace hamflow
