// The interface of a central potential V(r): a class template over the type of its parameters, as a function of u =
// r^2, W(u) = V(sqrt u). Every potential has
//     Potential(const Parameters<R>&), info()      name, formula, reference, parameters, starts, region, example
//     value(u) = W(u),   slope(u) = 2 W'(u) = V'(r)/r,   derivatives(u) = {slope, 4 W''(u)}
// The functions below are optional; without them their results are missing or computed in another way.
#pragma once

#include <functional>
#include <optional>

#include "hamflow/core/problem_info.hpp"

namespace hamflow {

/// The two derivatives of a potential at u = r^2.
template <class S>
struct CentralDerivatives {
  S slope;      // 2 W'(u) = V'(r)/r
  S curvature;  // 4 W''(u)
};

/// Returns the start by energy, which every potential has. A potential lists it last, with an energy and an angular
/// momentum that fit the parameters of its example.
inline StartInfo start_by_energy(Texts example) {
  return {.kind = "",
          .keys = {"energy", "angular_momentum"},
          .meaning = "any orbit, starting at pericentre on the x-axis (circles on the y-axis)",
          .example = std::move(example)};
}

namespace potentials {

/// slope(u, factor): factor times the slope, with the factor multiplied into the constants of the potential, which
/// shortens the chain of operations. Default: the product.
template <class V, class S, class F>
concept HasScaledSlope = requires(const V& potential, const S& u, const F& factor) {
  potential.slope(u, factor);
};
/// Static, takes_two = true: `derivatives` accepts Two (detail/core/two.hpp) as well as numbers, and has no branches
/// and no functions except roots. This makes Newton in the plane faster. Default: false.
template <class V>
inline constexpr bool takes_two = requires {
  requires V::takes_two;
};
template <class V, class S, class F>
concept HasFastSlope = requires(const V& potential, const S& u, const F& factor) {
  potential.fast_slope(u, factor);
};
/// Static, refused_parameters(given): as for a problem (detail/core/optional_functions.hpp).
template <class V, class R>
concept HasRefusedParameters = requires(const Parameters<R>& given) {
  { V::refused_parameters(given) } -> std::same_as<std::pair<std::string, std::string>>;
};
/// Static, derive(kind, orbit, given): as for a problem, for potentials whose strength follows from the orbit.
template <class V, class R>
concept HasDerive = requires(const std::string& kind, const Parameters<R>& orbit, Parameters<R>& given) {
  V::derive(kind, orbit, given);
};
/// Static, start(kind, mass, given, orbit, conditions): the starts of info(), except the one by energy.
template <class V, class R>
concept HasStart = requires(const std::string& kind, const R& mass, const Parameters<R>& values,
                            Conditions& conditions) {
  { V::start(kind, mass, values, values, conditions) } -> std::same_as<Start<R, 2>>;
};
/// exact_radius(mass, q, p): r as a function of phi on the orbit through a planar state.
template <class V>
concept HasExactRadius = requires(const V& potential, double mass, const Vector<double, 2>& x) {
  { potential.exact_radius(mass, x, x) } -> std::same_as<std::function<double(double)>>;
};
/// exact(mass, q, p, t): the planar state after time t; std::nullopt if unknown.
template <class V>
concept HasExact = requires(const V& potential, long double number, const Vector<long double, 2>& x) {
  { potential.exact(number, x, x, number) } -> std::same_as<std::optional<Start<long double, 2>>>;
};
/// conic(circular, sign of the energy, straight): the name of the conic, for potentials whose orbits are conics.
template <class V>
concept HasConic = requires(const V& potential) {
  { potential.conic(true, 0, true) } -> std::convertible_to<const char*>;
};

}  // namespace potentials
}  // namespace hamflow
