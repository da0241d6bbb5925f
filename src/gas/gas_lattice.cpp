#include "gas_lattice.hpp"

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "methods/recipes.hpp"

namespace hamflow {

std::unique_ptr<Simulation> simulate_gas_on_lattice(const Gas<double>& gas, const Vector<double, dynamic>& q,
                                                    const Vector<double, dynamic>& p, double h,
                                                    const Request& request) {
  return visit_method(request.method, [&]<class M>(const M& recipe) -> std::unique_ptr<Simulation> {
    if constexpr (!requires { recipe.with_any_shape(); }) {
      return nullptr;
    } else {
      auto method = recipe.with_any_shape().template bind<Gas<double>, Lattice>(gas);
      using Stepper = decltype(method);
      method.use_threads(static_cast<std::size_t>(request.threads));
      Lattice lattice;
      lattice.position.set_unit(request.position_unit);
      lattice.momentum.set_unit(request.momentum_unit);
      if (!request.watch) {
        return std::make_unique<SimulationOf<Gas<double>, Stepper, Lattice, NoProbe>>(gas, method, q, p, h, lattice);
      }
      return std::make_unique<SimulationOf<Gas<double>, Stepper, Lattice>>(gas, method, q, p, h, lattice);
    }
  });
}

}  // namespace hamflow
