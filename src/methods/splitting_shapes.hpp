// Functions shared by the families of splitting methods: the choice of a kernel for a table, and the digits of its
// coefficients.
#pragma once

#include <algorithm>

#include "catalog_tables.hpp"  // generated from the folders of tables
#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/methods/splitting.hpp"

namespace hamflow::families {

/// The shape of a method. The tables of the catalogue exist as long as the program, so each is read once and not again
/// for each member of a sweep.
Shape cached_shape_of(const AnySplitting& method);

/// Calls f with the recipe of the method's shape; the common shapes have kernels of their own.
template <class F>
auto visit_shape(const AnySplitting& method, F&& f) {
  switch (cached_shape_of(method)) {
    case Shape::kick_drift_kick:
      return f(TableRecipe<Shape::kick_drift_kick>{method});
    case Shape::drift_kick_drift:
      return f(TableRecipe<Shape::drift_kick_drift>{method});
    case Shape::kick_drift:
    case Shape::drift_kick:
    case Shape::any:
      break;
  }
  return f(TableRecipe<Shape::any>{method});
}

inline std::string needs_separable(bool nystroem) {
  return std::string("a separable H = T(p) + V(q)") + (nystroem ? ", T quadratic in p with constant mass matrix" : "");
}

/// The advice of a table, completed by the advice for all tables of its kind.
inline MethodAdvice advice_of(const TableAdvice& own, const MethodInfo& info, bool nystroem) {
  MethodAdvice advice{std::string(own.purpose), std::string(own.take), std::string(own.avoid)};
  if (advice.take.empty()) {
    advice.take = "order " + std::to_string(info.order) +
                  " is needed and hamflow compare ranks it before the other methods of that order on your problem";
  }
  if (advice.avoid.empty()) {
    advice.avoid = std::string(nystroem ? "H is not p^T M^-1 p/2 + V(q) with constant M" : "H is not T(p) + V(q)") +
                   ": cg takes any H";
    if (!info.symmetric) advice.avoid += "; the run must be reversible: verlet, stv4, kahan-li8";
  }
  return advice;
}

/// The number of known significant digits of a coefficient; unlimited for an expression or a short decimal.
inline int known_digits(std::string_view coefficient) {
  constexpr std::size_t longest_exact = 17;  // no published set has exact decimals that long
  if (coefficient.size() <= longest_exact || coefficient.find_first_not_of("-.0123456789") != std::string_view::npos) {
    return unlimited_digits;
  }
  const std::string_view digits =
      coefficient.substr(std::min(coefficient.find_first_of("123456789"), coefficient.size()));
  return static_cast<int>(digits.size() - (digits.find('.') == std::string_view::npos ? 0 : 1));
}
/// The fewest known digits of several coefficients.
template <std::size_t count>
int known_digits(const std::array<std::string_view, count>& coefficients) {
  int digits = unlimited_digits;
  for (const std::string_view text : coefficients) digits = std::min(digits, known_digits(text));
  return digits;
}

}  // namespace hamflow::families
