#include "bulk_functions.hpp"

#include <cmath>
#include <optional>

#include "hamflow/run/forwarding_functions.hpp"

namespace hamflow {

namespace {

std::optional<BulkPairSystem> bulk_pair_system(const Gas<double>& gas, double skin) {
  const auto& model = gas.model();
  BulkPairSystem s;
  s.space = gas.space();
  s.particles = gas.particles();
  s.length_scale = model.scale;
  s.prefactor = 1 / model.scale_squared;
  if (const auto* const law = std::get_if<pairs::LennardJones<double>>(&model.law)) {
    const auto& c = law->coefficients();
    s.law = BulkPairSystem::Law::lennard_jones;
    s.factor = c.repulsion;
    s.attraction = c.attraction / c.repulsion;
    s.sigma = std::sqrt(c.length_squared);
  } else if (const auto* const newton = std::get_if<pairs::Newton<double>>(&model.law)) {
    s.law = BulkPairSystem::Law::newton;
    s.softening = std::sqrt(newton->softening_squared());
  } else {
    return std::nullopt;
  }
  switch (model.cutoff.kind) {
    case CutoffKind::none:
      return s;
    case CutoffKind::shifted:
      s.cutoff = BulkPairSystem::Cutoff::shifted;
      break;
    case CutoffKind::force_shifted:
      s.cutoff = BulkPairSystem::Cutoff::force_shifted;
      break;
    case CutoffKind::smooth:
      s.cutoff = BulkPairSystem::Cutoff::smooth;
      break;
  }
  s.radius = model.cutoff.radius;
  s.inner = model.cutoff.inner;
  s.skin = skin;
  for (std::size_t k = 0; k < model.edges.size(); ++k) s.edges[k] = model.edges[k];
  return s;
}

/// Hessians are those of the gas.
class BulkFunctions final : public ForwardingFunctions<double> {
 public:
  BulkFunctions(Pointer plain, const Gas<double>& gas, const BulkPairSystem& system, BulkKernel kernel)
      : ForwardingFunctions(std::move(plain)), gas_(gas), system_(system), bulk_(system, kernel) {}

  double energy(const V& q, const V& p) const override { return exact_->kinetic(p) + potential(q); }
  double potential(const V& q) const override { return bulk_.potential(q.begin()) + gas_.container_potential(q); }
  void force(const V& q, V& f) const override {
    bulk_.force(q.begin(), f.begin());
    gas_.add_container_forces(q, f);
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    force(q, dq);
    for (double& x : dq) x = -x;
    exact_->velocity(p, dp);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    exact_->force_and_hessian(q, f, h);
    force(q, f);
  }

  Pointer by(BulkKernel kernel, std::size_t threads) const {
    auto* const other = new BulkFunctions(exact_, gas_, system_, kernel);
    Pointer shared = shared_functions<double>(other);
    other->bulk_.use_threads(threads);
    return shared;
  }

 private:
  Gas<double> gas_;
  BulkPairSystem system_;
  BulkForces bulk_;
};

}  // namespace

std::shared_ptr<const Functions<double>> with_bulk_forces(const Gas<double>& gas,
                                                          std::shared_ptr<const Functions<double>> plain, double skin) {
  const auto system = bulk_pair_system(gas, skin);
  if (!system) return plain;
  return shared_functions<double>(new BulkFunctions(std::move(plain), gas, *system, BulkKernel::exact));
}

bool has_bulk_forces(const Functions<double>& functions) {
  return dynamic_cast<const BulkFunctions*>(&functions) != nullptr;
}

std::shared_ptr<const Functions<double>> with_bulk_kernel(const std::shared_ptr<const Functions<double>>& functions,
                                                          BulkKernel kernel, std::size_t threads) {
  return dynamic_cast<const BulkFunctions&>(*functions).by(kernel, threads);
}

}  // namespace hamflow
