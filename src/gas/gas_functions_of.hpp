// The definitions of gas_functions.hpp, instantiated in one file for double and in one for all other number types.
#pragma once

#include "gas_functions.hpp"

namespace hamflow {

template <class R>
PairLaws<R> law_of(const GasShape& shape, const Parameters<R>& given) {
  if (shape.typed) return TypedPair<R>(TypedPotential<R>(shape.typed, given));
  return make_pair_law<R>(shape.pair, given);
}

template <class R>
std::shared_ptr<NearPairs> near_pairs_of(const typename Gas<R>::Model& model, const Parameters<R>& given) {
  const auto length = [&](const R& x) { return static_cast<double>(R(x / model.scale)); };
  NearPairs::Reach reach;
  reach.space = model.space;
  reach.particles = model.masses.size();
  reach.radius = length(model.cutoff.radius);
  reach.skin = length(given.has("skin") ? given["skin"] : R(usual_skin));
  for (std::size_t k = 0; k < model.edges.size(); ++k) reach.edges.at(k) = static_cast<double>(model.edges[k]);
  return std::make_shared<NearPairs>(reach);
}

template <class R>
Gas<R> make_gas(const GasShape& shape, const Parameters<R>& given, std::size_t size) {
  using Model = typename Gas<R>::Model;
  auto model = std::make_shared<Model>(law_of(shape, given));
  model->space = static_cast<std::size_t>(static_cast<double>(given["dimension"]));
  const std::size_t particles = size / model->space;
  std::vector<R> masses = given.list("masses");
  masses.resize(particles, masses.front());
  model->set_masses(std::move(masses));
  model->scale = given["scale"];
  model->scale_squared = model->scale * model->scale;
  if (shape.cutoff != CutoffKind::none) {
    const R inner = shape.cutoff == CutoffKind::smooth ? given["inner"] : R(0);
    model->cutoff =
        std::visit([&](const auto& law) { return Cutoff<R>(shape.cutoff, given["cutoff"], inner, law); }, model->law);
  }
  model->container = shape.container;
  if (shape.container == ContainerKind::circle) {
    model->wall = SoftWall<R>(given["radius"], given["exponent"], model->scale);
  }
  if (shape.container == ContainerKind::periodic) {
    model->edges = given.list("size");
  }
  if (shape.cutoff != CutoffKind::none && particles > most_recorded_particles)
    model->near = near_pairs_of(*model, given);
  return Gas<R>(std::move(model));
}

template <class R>
ErasedFunctions<R> gas_functions(const GasShape& shape, const Parameters<R>& given, std::size_t size) {
  const Gas<R> gas = make_gas(shape, given, size);
  ErasedFunctions<R> all{capabilities_of<Gas<R>>(), size, functions_of<R>(gas), functions_of<Trace<R>>(gas), nullptr};
  // eg supports only forces along the lines between particles.
  if (shape.container != ContainerKind::none) {
    all.capability = Capability::separable | Capability::quadratic_kinetic;
  }
  if constexpr (std::is_same_v<R, double>) all.dual = functions_of<Dual<double, 1>>(gas);
  return all;
}

}  // namespace hamflow
