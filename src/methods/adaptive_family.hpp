// Options of the families with adaptive sub-steps: dop853 and taylor.
#pragma once

#include <cmath>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/methods/adaptive_options.hpp"
#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/step_control.hpp"

namespace hamflow::families {

/// @param tolerance_position the position of the tolerance among options given by position
inline BoundOptions<AdaptiveOptions> adaptive_options(int tolerance_position) {
  BoundOption<AdaptiveOptions> tolerance =
      bind_number({.name = tolerance_option,
                   .default_value = "1e-12",
                   .meaning = "relative error of q and of p allowed in a sub-step; with more digits than double the "
                              "default is 10^4 times the rounding",
                   .range = Range::between(0, 1),
                   .position = tolerance_position,
                   .beyond_double = true},
                  &AdaptiveOptions::tolerance);
  return {tolerance, bind_word({.name = step_control_option,
                                .default_value = "adaptive",
                                .meaning = "fixed: one sub-step per step, whatever its error"},
                               &AdaptiveOptions::fixed, {{"adaptive", false}, {fixed_steps, true}})};
}

/// The least tolerance of a long double, rounded up.
inline constexpr int most_digits_of_tolerances = 4900;

/// A number in its shortest spelling; as typed where a double does not hold it.
inline std::string number_text(const std::string& text) {
  const double x = number_value(text);
  return std::isnormal(x) ? shortest(x) : text;
}

/// "taylor(order=20,tolerance=1e-10)": the options that were given, in the order of their declaration.
inline std::string canonical_name(const std::string& method, const BoundOptions<AdaptiveOptions>& options,
                                  const Texts& given) {
  std::vector<std::string> parts;
  for (const auto& [info, set] : options) {
    const auto text = given.find(info.name);
    if (text == given.end() || (info.type == OptionType::word && text->second == info.default_value)) continue;
    parts.push_back(info.name + "=" + (info.type == OptionType::word ? text->second : number_text(text->second)));
  }
  return parts.empty() ? method : method + "(" + joined(parts, ",") + ")";
}

/// Adds a tolerance for arithmetics with more digits than double: four digits are left to rounding.
inline Texts with_tolerance_of(const Texts& given, int digits) {
  Texts all = given;
  if (digits > 300) {
    all.try_emplace(tolerance_option, "1e-" + std::to_string(std::min(digits, most_digits_of_tolerances) - 4));
  } else if (digits > 0) {
    all.try_emplace(tolerance_option, shortest(pow(10.0, 4 - digits)));
  }
  return all;
}

inline MethodFamily adaptive_family(const std::string& name, int rank, const BoundOptions<AdaptiveOptions>& options) {
  return {.name = name,
          .methods = {name},
          .options = declarations_of(options),
          .rank = rank,
          .not_on_lattice = name + " is not a bijection of the lattice, so it could not be reversed exactly",
          .completed = with_tolerance_of};
}

}  // namespace hamflow::families
