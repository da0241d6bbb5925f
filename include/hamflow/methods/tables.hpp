// The types of coefficient tables for explicit splitting methods. A table is data with its source; the kernel in
// splitting.hpp runs all of them, and the one in force_gradient.hpp those with force gradients. Coefficients are
// decimal strings or fractions, read in the working arithmetic, because a double literal would limit the digits of
// other arithmetics.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace hamflow {

/// The value of a decimal ("-0.39") or of a fraction ("1/6"), to a few roundings of double; NaN for other expressions,
/// which need evaluate_number.
constexpr double plain_number(std::string_view text) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    return plain_number(text.substr(0, slash)) / plain_number(text.substr(slash + 1));
  }
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  double digits = 0;
  double unit = 0;  // of the last digit after the point; 0 before the point
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

/// Whether the kicks and the drifts of a step each sum to 1, as consistency requires; true if a coefficient is an
/// expression that cannot be evaluated at compile time.
constexpr bool adds_up_to_one(double kicks, double drifts) {
  const auto is_one = [](double sum) { return !(sum < 1 - 1e-12 || sum > 1 + 1e-12); };  // true for NaN
  return is_one(kicks) && is_one(drifts);
}

/// Advice about a table for `list methods` and `show`, in addition to the advice for all tables of its kind.
struct TableAdvice {
  std::string_view purpose{};  // its use, if it is one of the methods recommended first
  std::string_view take{};     // when to use it
  std::string_view avoid{};    // when not to use it, and a better choice
};

/// Psi_h = StV(gamma_s h) o ... o StV(gamma_1 h), gamma palindromic, StV the Stoermer-Verlet step.
/// `half` lists gamma_1 .. up to, not including, the middle one, which is 1 - 2 sum(half): consistency is exact.
struct CompositionTable {
  static constexpr std::size_t most = 20;
  std::string_view name;
  int order;
  std::string_view reference;
  std::array<std::string_view, most> half{};
  std::array<std::string_view, most> closed_half{};  // closed forms, if known, for any number of digits
  TableAdvice advice{};

  constexpr int half_count() const {
    int count = 0;
    while (count < static_cast<int>(most) && !half[static_cast<std::size_t>(count)].empty()) ++count;
    return count;
  }
  constexpr int stages() const { return 2 * half_count() + 1; }
};

enum class StartsWith { kick, drift };

/// Alternating kicks (p <- p - c h V'(q)) and drifts (q <- q + d h T'(p)), in the order in which they act. For a
/// symmetric splitting `coefficients` lists the first half with the middle; the rest is its mirror image.
struct SplittingTable {
  static constexpr std::size_t most = 40;
  std::string_view name;
  int order;
  std::string_view reference;
  StartsWith starts_with;
  bool symmetric = false;
  bool nystroem = false;  // the order holds only for T = p^T M^-1 p/2 with constant M
  std::array<std::string_view, most> coefficients{};
  TableAdvice advice{};

  /// The number of listed coefficients.
  constexpr int listed() const {
    int n = 0;
    while (n < static_cast<int>(most) && !coefficients[static_cast<std::size_t>(n)].empty()) ++n;
    return n;
  }
  /// The number of actions in a step.
  constexpr int count() const { return symmetric ? 2 * listed() - 1 : listed(); }
  /// The coefficient of action i = 0 .. count() - 1.
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

/// A symmetric splitting whose kicks may carry the gradient of |V'|^2. `half` lists the actions up to and including the
/// middle one.
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
