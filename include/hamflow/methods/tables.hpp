// The two kinds of coefficient table for explicit splitting methods. A table is data with its source; the one kernel in
// splitting.hpp runs all of them. Coefficients are decimal strings (or fractions), read in the working arithmetic,
// because a double literal would silently cap an extended one.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace hamflow {

/// Psi_h = StV(gamma_s h) o ... o StV(gamma_1 h), gamma palindromic, StV the Stoermer-Verlet step.
/// `half` lists gamma_1 .. up to, not including, the middle one, which is 1 - 2 sum(half): consistency is exact.
struct CompositionTable {
  static constexpr std::size_t most = 20;
  std::string_view name;
  int order;
  std::string_view reference;
  std::array<std::string_view, most> half{};

  constexpr int half_count() const {
    int count = 0;
    while (!half[static_cast<std::size_t>(count)].empty()) ++count;
    return count;
  }
  constexpr int stages() const { return 2 * half_count() + 1; }
};

enum class StartsWith { kick, drift };

/// Alternating kicks (p <- p - c h V'(q)) and drifts (q <- q + d h T'(p)), in the order in which they act.
struct SplittingTable {
  static constexpr std::size_t most = 40;
  std::string_view name;
  int order;
  std::string_view reference;
  StartsWith starts_with;
  bool symmetric = false;
  std::array<std::string_view, most> coefficients{};

  constexpr int count() const {
    int n = 0;
    while (!coefficients[static_cast<std::size_t>(n)].empty()) ++n;
    return n;
  }
};

}  // namespace hamflow
