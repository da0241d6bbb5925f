#include "bulk_gas.hpp"

#include <cmath>

#include "engine/forwarding_functions.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/gas.hpp"

namespace hamflow {

namespace {

/// Monitoring the energy at each step needs no second pass over the pairs: the bulk forces learn after which force the
/// potential is requested.
class BulkGas final : public ForwardingFunctions<double> {
 public:
  BulkGas(Pointer functions, Gas<double> gas, BulkForces bulk)
      : ForwardingFunctions<double>(std::move(functions)), gas_(std::move(gas)), bulk_(std::move(bulk)) {}

  double energy(const V& q, const V& p) const override { return gas_.kinetic(p) + potential(q); }
  double potential(const V& q) const override { return bulk_.potential(q.begin()) + gas_.container_potential(q); }
  void force(const V& q, V& f) const override {
    bulk_.force(q.begin(), f.begin());
    gas_.add_container_forces(q, f);
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    force(q, dq);
    for (double& x : dq) x = -x;
    gas_.velocity(p, dp);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    exact_->force_and_hessian(q, f, h);
    force(q, f);
  }

 private:
  Gas<double> gas_;
  BulkForces bulk_;
};

}  // namespace

std::optional<BulkPairSystem> bulk_pair_system(const Gas<double>& gas, double skin) {
  const auto& model = gas.model();
  BulkPairSystem system;
  system.space = gas.space();
  system.particles = gas.particles();
  system.prefactor = 1 / model.scale_squared;
  system.length_scale = model.scale;
  if (const auto* const law = std::get_if<pairs::LennardJones<double>>(&model.law)) {
    const auto& c = law->coefficients();
    system.law = BulkPairSystem::Law::lennard_jones;
    system.factor = c.repulsion;
    system.attraction = c.attraction / c.repulsion;
    system.sigma = std::sqrt(c.length_squared);
  } else if (const auto* const attracts = std::get_if<pairs::Newton<double>>(&model.law)) {
    system.law = BulkPairSystem::Law::newton;
    system.softening = std::sqrt(attracts->softening_squared());
  } else {
    return std::nullopt;
  }
  switch (model.cutoff.kind) {
    case CutoffKind::none:
      break;
    case CutoffKind::shifted:
      system.cutoff = BulkPairSystem::Cutoff::shifted;
      break;
    case CutoffKind::force_shifted:
      system.cutoff = BulkPairSystem::Cutoff::force_shifted;
      break;
    case CutoffKind::smooth:
      system.cutoff = BulkPairSystem::Cutoff::smooth;
      break;
  }
  system.radius = model.cutoff.radius;
  system.inner = model.cutoff.inner;
  for (std::size_t k = 0; k < model.edges.size(); ++k) system.edges.at(k) = model.edges[k];
  system.skin = skin;
  return system;
}

ErasedFunctions<double> with_bulk_forces(ErasedFunctions<double> functions, const Gas<double>& gas, double skin,
                                         std::size_t threads) {
  const auto system = bulk_pair_system(gas, skin);
  if (!system || gas.particles() <= most_recorded_particles) return functions;
  const BulkForces bulk(*system);
  bulk.use_threads(threads);
  functions.plain = std::make_shared<const BulkGas>(std::move(functions.plain), gas, bulk);
  return functions;
}

}  // namespace hamflow
