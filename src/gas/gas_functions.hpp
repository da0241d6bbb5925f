// The functions of the gas in each number type, from its choices and parameters.
#pragma once

#include "engine/erased.hpp"
#include "gas_system.hpp"
#include "hamflow/detail/formula/model.hpp"
#include "pair_list.hpp"  // generated from the folder of pair laws

namespace hamflow {

/// With more particles, double uses bulk forces (bulk_gas.hpp), and pairs with a cut-off use neighbour lists. With
/// fewer, steps are recorded, with the sums of a loop over all pairs.
inline constexpr std::size_t most_recorded_particles = 12;
/// The skin of neighbour lists, in length units of the potential.
inline constexpr double usual_skin = 0.3;

/// The choices given by words.
struct GasShape {
  std::string pair;
  std::shared_ptr<const formula::Model> typed;  // p_r^2/2 + phi(r), if phi is typed
  ContainerKind container = ContainerKind::circle;
  CutoffKind cutoff = CutoffKind::none;
};

template <class R>
using Gas = GasSystem<R, PairLaws<R>>;

/// @param size the number of coordinates of all particles
template <class R>
Gas<R> make_gas(const GasShape& shape, const Parameters<R>& given, std::size_t size);
/// Returns the functions of the gas behind virtual calls. Instantiated for all number types.
template <class R>
ErasedFunctions<R> gas_functions(const GasShape& shape, const Parameters<R>& given, std::size_t size);

}  // namespace hamflow
