// Fractions of whole numbers below 2^53: coefficients and exponents of expressions.
#pragma once

#include <cstdint>
#include <numeric>
#include <optional>
#include <string>

namespace hamflow::formula {

/// Holds sums of products of two numbers up to 2^53.
__extension__ using Wide = __int128;

struct Rational {
  std::int64_t up = 0;
  std::int64_t down = 1;  // positive, without a common divisor with `up`

  friend bool operator==(const Rational&, const Rational&) = default;
  bool is_zero() const { return up == 0; }
  bool is_whole() const { return down == 1; }
  bool is(std::int64_t whole) const { return up == whole && down == 1; }
  Rational operator-() const { return {-up, down}; }
  std::string key() const { return std::to_string(up) + "/" + std::to_string(down); }
};

/// Returns the fraction in lowest terms; nullopt beyond 2^53, above which a double cannot represent every whole number.
inline std::optional<Rational> fraction(Wide up, Wide down) {
  constexpr Wide most = std::int64_t{1} << 53;
  if (down == 0) return std::nullopt;
  Wide a = up < 0 ? -up : up;
  Wide b = down < 0 ? -down : down;
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  if (a == 0) a = 1;
  if (down < 0) a = -a;
  up /= a;
  down /= a;
  if (up > most || up < -most || down > most) return std::nullopt;
  return Rational{static_cast<std::int64_t>(up), static_cast<std::int64_t>(down)};
}
inline std::optional<Rational> sum(const Rational& a, const Rational& b) {
  return fraction(static_cast<Wide>(a.up) * b.down + static_cast<Wide>(b.up) * a.down,
                  static_cast<Wide>(a.down) * b.down);
}
inline std::optional<Rational> product(const Rational& a, const Rational& b) {
  return fraction(static_cast<Wide>(a.up) * b.up, static_cast<Wide>(a.down) * b.down);
}
/// Returns c^n for a whole number n.
inline std::optional<Rational> power(const Rational& c, std::int64_t n) {
  if (n > 64 || n < -64 || (n < 0 && c.is_zero())) return std::nullopt;
  Rational all{1, 1};
  for (std::int64_t k = 0; k < (n < 0 ? -n : n); ++k) {
    const auto next = product(all, c);
    if (!next) return std::nullopt;
    all = *next;
  }
  return n < 0 ? fraction(all.down, all.up) : all;
}

}  // namespace hamflow::formula
