// The arithmetics by name, and which method cannot run in which.
#include <algorithm>
#include <charconv>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/methods/dop853_tableau.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

int mp_digits(const std::string& arithmetic) {
  if (!arithmetic.starts_with("mp(") || !arithmetic.ends_with(")")) return 0;
  const std::string inside = arithmetic.substr(3, arithmetic.size() - 4);
  if (inside == "d") return 0;  // the name in lists
  int digits = 0;
  const auto [end, error] = std::from_chars(inside.data(), inside.data() + inside.size(), digits);
  if (error != std::errc() || end != inside.data() + inside.size() || digits < MpDigits::fewest ||
      digits > MpDigits::most) {
    throw Error("mp(d) takes a number of decimal digits from " + std::to_string(MpDigits::fewest) + " to " +
                std::to_string(MpDigits::most) + ", not '" + inside + "'");
  }
  return digits;
}

int digits_beyond_double(const std::string& arithmetic) {
  if (arithmetic == "double-double") return 31;
  if (arithmetic == "quad") return 33;
  return mp_digits(arithmetic);
}

void check_arithmetic(const std::string& arithmetic) {
  if (mp_digits(arithmetic) > 0) return;
  const std::vector<std::string>& names = arithmetics();
  if (arithmetic != "mp(d)" && std::find(names.begin(), names.end(), arithmetic) != names.end()) return;
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  const std::string near = nearest(arithmetic, names);
  throw Error("arithmetic '" + arithmetic + "' is unknown; allowed: " + all + ", e.g. mp(50)" +
              (near.empty() ? "" : "; did you mean " + near + "?"));
}

namespace {
/// The decimal places to which a coefficient is known: all, where it is an expression or a short decimal.
int places_of(std::string_view coefficient) {
  constexpr int exact = 1 << 30;
  constexpr std::size_t longest_exact = 17;  // no set of the literature has decimals that long on purpose
  if (coefficient.size() <= longest_exact || coefficient.find_first_not_of("-.0123456789") != std::string_view::npos) {
    return exact;
  }
  const std::size_t point = coefficient.find('.');
  return point == std::string_view::npos ? exact : static_cast<int>(coefficient.size() - point - 1);
}

/// The digits beyond which the coefficients of a method would cap its order.
int known_digits(const MethodEntry& entry) {
  int places = 1 << 30;
  if (entry.kind == MethodKind::dop853) return dop853::digits;
  if (entry.composition != nullptr) {
    if (!entry.composition->closed_half[0].empty()) return places;
    for (const std::string_view text : entry.composition->half) places = std::min(places, places_of(text));
  }
  if (entry.splitting != nullptr) {
    for (const std::string_view text : entry.splitting->coefficients) places = std::min(places, places_of(text));
  }
  if (entry.force_gradient != nullptr) {
    for (const ForceGradientAction& action : entry.force_gradient->half) {
      places = std::min({places, places_of(action.drift), places_of(action.kick), places_of(action.gradient)});
    }
  }
  return places;
}
}  // namespace

std::string refusal(const MethodSpec& spec, const std::string& arithmetic) {
  const MethodEntry& entry = find_method(spec.name);
  const int digits = digits_beyond_double(arithmetic);
  if (digits > known_digits(entry)) {
    return "the coefficients of " + spec.name + " are known here to " + std::to_string(known_digits(entry)) +
           " digits; allowed up to mp(" + std::to_string(known_digits(entry)) +
           "), or a method whose coefficients are exact, e.g. verlet, stv4, suzuki4, rk4, taylor";
  }
  if (arithmetic != "lattice") return {};
  if (entry.kind == MethodKind::runge_kutta || entry.kind == MethodKind::dop853 || entry.kind == MethodKind::taylor) {
    return spec.name +
           " is no bijection of the lattice, so nothing would come back exactly; use a splitting method, e.g. stv4";
  }
  if (entry.kind == MethodKind::cg) {
    return "an implicit step is no bijection of the lattice; use a splitting method, e.g. stv4";
  }
  if (entry.kind == MethodKind::boris) return "boris rotates velocities, which is no bijection of the lattice";
  return {};
}

}  // namespace hamflow
