// The kinds of coefficient table for explicit splitting methods. A table is data with its source; the one kernel in
// splitting.hpp runs them all, those with force gradients that in force_gradient.hpp. Coefficients are decimal strings
// (or fractions), read in the working arithmetic, because a double literal would silently cap an extended one.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace hamflow {

/// The value of a plain decimal ("-0.39") or of a fraction of two ("1/6"), to some roundings of double; NaN of any
/// other expression, which only evaluate_number reads.
constexpr double plain_number(std::string_view text) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    return plain_number(text.substr(0, slash)) / plain_number(text.substr(slash + 1));
  }
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  double digits = 0;
  double unit = 0;  // of the last digit behind the point; 0 before the point
  bool any = false;
  for (const char c : text) {
    if (c == '.' && unit == 0) {
      unit = 1;
    } else if (c >= '0' && c <= '9') {
      any = true;
      if (unit == 0) {
        digits = 10 * digits + (c - '0');
      } else {
        unit /= 10;
        digits += unit * (c - '0');
      }
    } else {
      return unknown;
    }
  }
  return !any ? unknown : negative ? -digits : digits;
}

/// Whether the kicks and the drifts of a step each add up to 1, which every consistent method needs; true where a
/// coefficient is an expression that cannot be read here.
constexpr bool adds_up_to_one(double kicks, double drifts) {
  const auto is_one = [](double sum) { return !(sum < 1 - 1e-12 || sum > 1 + 1e-12); };  // true of NaN
  return is_one(kicks) && is_one(drifts);
}

/// What `list methods` and `show` say of a table, where there is more to say than of all of its kind.
struct TableAdvice {
  std::string_view purpose{};  // of one of the few methods with which the list begins: for what
  std::string_view take{};     // when to take it
  std::string_view avoid{};    // when not, and what is better then
};

/// Psi_h = StV(gamma_s h) o ... o StV(gamma_1 h), gamma palindromic, StV the Stoermer-Verlet step.
/// `half` lists gamma_1 .. up to, not including, the middle one, which is 1 - 2 sum(half): consistency is exact.
struct CompositionTable {
  static constexpr std::size_t most = 20;
  std::string_view name;
  int order;
  std::string_view reference;
  std::array<std::string_view, most> half{};
  std::array<std::string_view, most> closed_half{};  // expressions, where there are, for any number of digits
  TableAdvice advice{};

  constexpr int half_count() const {
    int count = 0;
    while (count < static_cast<int>(most) && !half[static_cast<std::size_t>(count)].empty()) ++count;
    return count;
  }
  constexpr int stages() const { return 2 * half_count() + 1; }
};

enum class StartsWith { kick, drift };

/// Alternating kicks (p <- p - c h V'(q)) and drifts (q <- q + d h T'(p)), in the order in which they act.
/// Of a symmetric one `coefficients` lists the first half with the middle one; the rest is its mirror image.
struct SplittingTable {
  static constexpr std::size_t most = 40;
  std::string_view name;
  int order;
  std::string_view reference;
  StartsWith starts_with;
  bool symmetric = false;
  bool nystroem = false;  // has its order for T = p^T M^-1 p/2 with constant M only
  std::array<std::string_view, most> coefficients{};
  TableAdvice advice{};

  /// How many coefficients are listed.
  constexpr int listed() const {
    int n = 0;
    while (n < static_cast<int>(most) && !coefficients[static_cast<std::size_t>(n)].empty()) ++n;
    return n;
  }
  /// How many actions a step has.
  constexpr int count() const { return symmetric ? 2 * listed() - 1 : listed(); }
  /// Of action i = 0 .. count() - 1.
  constexpr std::string_view coefficient(int i) const {
    return coefficients[static_cast<std::size_t>(i < listed() ? i : count() - 1 - i)];
  }
  constexpr bool is_consistent() const {
    std::array<double, 2> sums{};
    for (int i = 0; i < count(); ++i) sums[static_cast<std::size_t>(i % 2)] += plain_number(coefficient(i));
    return adds_up_to_one(sums[0], sums[1]);
  }
};

/// One action of a step with force gradient. A kick is p <- p - h b V'(q) + h^3 g (|V'|^2)'(q), |V'|^2 = V'^T M^-1 V'.
struct ForceGradientAction {
  std::string_view drift{};
  std::string_view kick{};      // b
  std::string_view gradient{};  // g; empty: 0
};

/// A symmetric splitting whose kicks may carry the gradient of |V'|^2. `half` lists its actions with the middle one.
struct ForceGradientTable {
  static constexpr std::size_t most = 8;
  std::string_view name;
  int order;
  std::string_view reference;
  std::array<ForceGradientAction, most> half{};

  constexpr int listed() const {
    int n = 0;
    while (n < static_cast<int>(most) &&
           !(half[static_cast<std::size_t>(n)].drift.empty() && half[static_cast<std::size_t>(n)].kick.empty())) {
      ++n;
    }
    return n;
  }
  constexpr int count() const { return 2 * listed() - 1; }
  constexpr const ForceGradientAction& action(int i) const {
    return half[static_cast<std::size_t>(i < listed() ? i : count() - 1 - i)];
  }
  constexpr bool is_consistent() const {
    double kicks = 0;
    double drifts = 0;
    for (int i = 0; i < count(); ++i) {
      if (!action(i).kick.empty()) kicks += plain_number(action(i).kick);
      if (!action(i).drift.empty()) drifts += plain_number(action(i).drift);
    }
    return adds_up_to_one(kicks, drifts);
  }
};

}  // namespace hamflow
