// Each function is a value from a table and a short series for the distance to the place of the table [Tang1989]. What
// decides the last digit is carried as the sum of two doubles, the tail of the series as one. The relative error of a
// sum is some 2^-66 and its rounding to a double comes last, so that one result in ten thousand or fewer is the wrong
// one of its two neighbours.
#include "hamflow/detail/core/portable_functions.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "portable_tables.hpp"

namespace hamflow::portable {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
/// A number below 2^51 plus this is rounded to a whole number, which stands in the last bits of the sum.
constexpr double to_whole = 0x1.8p52;

std::uint64_t bits_of(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

double number_of(std::uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// 2^e, e = -1022 .. 1023
double power_of_two(int e) { return number_of(static_cast<std::uint64_t>(e + 1023) << 52); }

/// e of |x| = m 2^e, 1 <= m < 2, for a normal number.
int exponent_of(double x) { return static_cast<int>(bits_of(x) >> 52 & 0x7ff) - 1023; }

double rounded(Pair x) { return x.hi + x.lo; }
Pair minus(Pair x) { return {-x.hi, -x.lo}; }
Pair normal(Pair x) { return ordered_sum(x.hi, x.lo); }

/// value 2^e, rounded once also if it is subnormal. 1/2 <= value < 4.
double scaled(Pair value, int e) {
  double x = rounded(value);
  if (e > 1000) return e > 1030 ? infinity : x * 0x1p1000 * power_of_two(e - 1000);
  if (e > -1020) return x * power_of_two(e);
  if (e < -1080) return 0;
  // A sum with 2^-1022 in these units ends where subnormal numbers end.
  const double least_normal = power_of_two(-1022 - e);
  if (x < least_normal) {
    const Pair sum = ordered_sum(least_normal, value.hi);
    x = (sum.hi + (sum.lo + value.lo)) - least_normal;
  }
  return x * power_of_two(e + 100) * 0x1p-100;
}

Pair square_root(Pair x) {
  const double root = std::sqrt(x.hi);
  if (root == 0) return {0, 0};
  const Pair square = exact_product(root, root);
  return ordered_sum(root, (((x.hi - square.hi) - square.lo) + x.lo) / (2 * root));
}

/// x rounded to a multiple of `unit`, for |x| < 2^51 unit.
double multiple(double x, double unit) { return (x + to_whole * unit) - to_whole * unit; }

/// r^3/3. `s` is r rounded to at most 17 digits, so that its cube is exact, and so is the remainder of its division
/// by 3.
Pair third_of_cube(double r, double s) {
  const double cube = s * s * s;
  const double quotient = cube * (1.0 / 3);
  const double rest = ((cube - 2 * quotient) - quotient) + (r - s) * (r * r + r * s + s * s);
  return {quotient, rest * (1.0 / 3)};
}

// exp ----------------------------------------------------------------------------------------------------------------

/// value 2^exponent, 1 <= value < 2 but for the size of its error.
struct ScaledPair {
  Pair value;
  int exponent;
};

/// e^x = 2^(k/128) e^r, |r| < 0.0028, for |x| < 1000.
ScaledPair exp_of(Pair x) {
  const double shifted = x.hi * 0x1.71547652b82fep+7 + to_whole;
  const double count = shifted - to_whole;
  const auto k = static_cast<std::int32_t>(static_cast<std::uint32_t>(bits_of(shifted)));
  const double most = x.hi - count * (log_2.hi / 128);  // exact
  const double less = count * (log_2.lo / 128) - x.lo;
  const double r = most - less;
  const double r_head = multiple(r, 0x1p-35);  // at most 27 digits
  const double square = r * r;
  const double series = square * (0.5 + r * (1.0 / 6) + square * (1.0 / 24 + r * (1.0 / 120) + square * (1.0 / 720)));
  const Pair& power = exp_table[static_cast<std::size_t>(k & 127)];
  const Pair sum = ordered_sum(power.hi, power.hi * r_head);
  const double rest = ((most - r) - less) + (r - r_head) + series;
  return {{sum.hi, sum.lo + (power.lo + (power.lo * (r + series) + power.hi * rest))}, k >> 7};
}

double exp_far(double x) {
  if (x != x) return not_a_number;
  if (x > 710) return infinity;
  if (x < -746) return 0;
  const ScaledPair power = exp_of({x, 0});
  return scaled(power.value, power.exponent);
}

/// For |x| < 600, where nothing leaves the range.
Pair exp_pair(double x) {
  const ScaledPair power = exp_of({x, 0});
  const double scale = power_of_two(power.exponent);
  return {power.value.hi * scale, power.value.lo * scale};
}

// log ----------------------------------------------------------------------------------------------------------------

/// log x = e log 2 - log c + log(1 + r), r = m c - 1 exactly, |r| < 0.0059, for finite x > 0, with 76 digits.
Pair log_of(double x) {
  std::uint64_t bits = bits_of(x);
  int e = -1023;
  if (bits < (1ULL << 52)) {
    bits = bits_of(x * 0x1p54);
    e -= 54;
  }
  const std::size_t j = ((bits >> 44 & 0xff) + 1) >> 1;
  const double exponent = e + static_cast<int>(bits >> 52) + (j > log_middle ? 1 : 0);
  const double m = number_of((bits & 0xfffffffffffff) | 0x3ff0000000000000);
  const double m_head = number_of((bits & 0xffffff0000000) | 0x3ff0000000000000);
  const LogRow& row = log_table[j];
  const double r = (m_head * row.inverse - 1) + (m - m_head) * row.inverse;
  const double r_head = multiple(r, 0x1p-33);  // at most 26 digits
  const double square = r * r;
  const Pair cube = third_of_cube(r, multiple(r, 0x1p-24));
  const double low = 1.0 / 4 - r * (1.0 / 5) + square * (1.0 / 6 - r * (1.0 / 7));
  const double high = 1.0 / 8 - r * (1.0 / 9) + square * (1.0 / 10);
  const double tail = square * square * (low + square * square * high);

  const Pair first = ordered_sum(exponent * log_2.hi + row.logarithm.hi, r);  // its first argument is exact
  const Pair second = ordered_sum(first.hi, -0.5 * (r_head * r_head));
  const Pair third = ordered_sum(second.hi, cube.hi);
  const double constants = exponent * log_2.lo + row.logarithm.lo;
  const double rest = (cube.lo - tail) + (constants - 0.5 * ((r - r_head) * (r + r_head)));
  return ordered_sum(third.hi, (first.lo + second.lo) + (third.lo + rest));
}

// sin and cos --------------------------------------------------------------------------------------------------------

/// x = place pi/128 + rest, apart from whole turns.
struct Reduced {
  Pair rest;
  std::uint64_t place;
};

std::uint64_t high_product(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t half = 0xffffffff;
  const std::uint64_t low = (a & half) * (b & half);
  const std::uint64_t middle = (a >> 32) * (b & half) + (low >> 32);
  const std::uint64_t other = (a & half) * (b >> 32) + (middle & half);
  return (a >> 32) * (b >> 32) + (middle >> 32) + (other >> 32);
}

/// The first 106 of 192 binary digits behind the point. At least one of the first 128 is 1: no double is closer than
/// 2^-62 to a multiple of pi/2.
Pair fraction(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  double unit = 0x1p-53;
  if (a == 0) {
    a = b;
    b = c;
    c = 0;
    unit *= 0x1p-64;
  }
  const int zeros = std::countl_zero(a);
  if (zeros > 0) {
    a = a << zeros | b >> (64 - zeros);
    b = b << zeros | c >> (64 - zeros);
    unit *= power_of_two(-zeros);
  }
  const std::uint64_t next = (a << 53 | b >> 11) >> 11;
  return {static_cast<double>(a >> 11) * unit, static_cast<double>(next) * (unit * 0x1p-53)};
}

/// For any x >= 0.01: multiplies its 53 digits by those 192 digits of 1/(2 pi) that decide the place on the circle and
/// the rest.   [PayneHanek1983]
Reduced reduced_exactly(double x) {
  const std::uint64_t bits = bits_of(x);
  const std::uint64_t digits = (bits & 0xfffffffffffff) | 1ULL << 52;
  // x = digits 2^e. Digits of 2/pi in front of the one with the weight 2^(1 - e) make whole turns.
  const std::size_t first = (bits >> 52) - 1075 + 62;
  std::array<std::uint64_t, 3> window{};
  for (std::size_t i = 0; i < window.size(); ++i) {
    const std::size_t word = first / 64 + i;
    const std::size_t shift = first % 64;
    window[i] = two_over_pi[word] << shift;
    if (shift > 0) window[i] |= two_over_pi[word + 1] >> (64 - shift);
  }
  std::uint64_t c = digits * window[2];
  const std::uint64_t carry = high_product(digits, window[2]);
  std::uint64_t b = digits * window[1] + carry;
  std::uint64_t a = digits * window[0] + high_product(digits, window[1]) + (b < carry ? 1 : 0);
  const std::uint64_t place = ((a >> 55) + 1) >> 1;  // of 256 on the circle
  a -= place << 56;
  const bool negative = a >> 63 != 0;
  if (negative) {
    c = 0 - c;
    b = ~b + (c == 0 ? 1 : 0);
    a = ~a + (b == 0 && c == 0 ? 1 : 0);
  }
  const Pair rest = times(fraction(a, b, c), {4 * half_pi.hi, 4 * half_pi.lo});
  return {negative ? minus(rest) : rest, place};
}

/// |x| >= 2^-27. Three parts of pi/128 suffice unless x is large or next to a place of the table, where digits of the
/// difference are lost.   [CodyWaite1980]
Reduced reduced(double x) {
  const double shifted = x * 0x1.45f306dc9c883p+5 + to_whole;
  const double count = shifted - to_whole;
  const double most = x - count * pi_128[0];  // exact
  const double less = count * pi_128[1];
  const double rest = most - less;
  if (std::fabs(x) < 25000 && (std::fabs(rest) > 0x1p-18 || count == 0)) [[likely]]
    return {ordered_sum(rest, ((most - rest) - less) - count * pi_128[2]), bits_of(shifted)};
  const Reduced exact = reduced_exactly(std::fabs(x));
  return x < 0 ? Reduced{minus(exact.rest), 0 - exact.place} : exact;
}

/// sin(s + y) = sin s cos y + cos s sin y at the place s of the table, |y| < 0.0123.
Pair sine_of(std::uint64_t place, Pair y) {
  const auto& [sine, cosine] = sine_table[place & 255];
  const Pair y_halves = halves(y.hi);
  const double square = y.hi * y.hi;
  const double fourth = square * square;
  const double of_sine = y.hi * square * (-1.0 / 6 + square * (1.0 / 120) - fourth * (1.0 / 5040));
  const double of_cosine = square * (-0.5 + square * (1.0 / 24) + fourth * (-1.0 / 720 + square * (1.0 / 40320)));
  const Pair sum = ordered_sum(sine.hi, cosine.hi * y_halves.hi);
  const double rest = (y_halves.lo + y.lo) + of_sine;
  const double small = cosine.lo * (y.hi + of_sine) + (sine.hi + sine.lo) * of_cosine;
  return {sum.hi, sum.lo + (sine.lo + (cosine.hi * rest + small))};
}

// arctan -------------------------------------------------------------------------------------------------------------

/// arctan(y/x) for 2^-62 x <= y <= x or y = 0, neither near the ends of the range. It is arctan c + arctan u with
/// c = j/64 near y/x and u = (y - c x)/(x + c y), |u| < 0.008.
Pair arctan_of_ratio(Pair y, Pair x) {
  const double shifted = 64 * (y.hi / x.hi) + to_whole;
  const double c = (shifted - to_whole) * 0x1p-6;
  const Pair& middle = arctan_table[bits_of(shifted) & 127];
  const Pair x_halves = halves(x.hi);
  const Pair y_halves = halves(y.hi);
  const Pair above = exact_sum(y.hi - c * x_halves.hi, -c * x_halves.lo);
  const double product = c * y.hi;
  const double product_rest = (c * y_halves.hi - product) + c * y_halves.lo;
  const Pair below = ordered_sum(x.hi, product);
  const double below_rest = below.lo + (product_rest + (c * y.lo + x.lo));
  const double inverse = 1 / below.hi;
  const double u = halves(above.hi * inverse).hi;
  const Pair below_halves = halves(below.hi);
  // u has 26 digits, so that its products with both halves are exact
  const double back = (above.hi - u * below_halves.hi) - u * below_halves.lo;
  const double u_rest = (back + ((above.lo + (y.lo - c * x.lo)) - u * below_rest)) * inverse;
  const double all = u + u_rest;
  const double square = all * all;
  const double series =
      all * square * (-1.0 / 3 + square * (1.0 / 5) + square * square * (-1.0 / 7 + square * (1.0 / 9)));
  const Pair sum = ordered_sum(middle.hi, u);
  return {sum.hi, sum.lo + (middle.lo + (u_rest + series))};
}

/// The angle of the point (x, y), y >= 0, from 0 to pi; both coordinates as arctan_of_ratio takes them.
Pair angle(Pair y, Pair x) {
  const bool left = x.hi < 0;
  if (left) x = minus(x);
  Pair base{0, 0};
  Pair turn;
  if (y.hi > x.hi) {
    turn = arctan_of_ratio(x, y);
    if (!left) turn = minus(turn);
    base = half_pi;
  } else {
    turn = arctan_of_ratio(y, x);
    if (left) {
      turn = minus(turn);
      base = {2 * half_pi.hi, 2 * half_pi.lo};
    }
  }
  const Pair sum = ordered_sum(base.hi, turn.hi);
  return {sum.hi, sum.lo + (base.lo + turn.lo)};
}

/// x = value 2^exponent, 1 <= value < 2, for finite x > 0.
struct Normalised {
  double value;
  int exponent;
};
Normalised normalised(double x) {
  if (x < 0x1p-1022) {
    const Normalised large = normalised(x * 0x1p54);
    return {large.value, large.exponent - 54};
  }
  return {number_of((bits_of(x) & 0xfffffffffffff) | 0x3ff0000000000000), exponent_of(x)};
}

/// atan2 of y >= 0 for arguments that are special or far from 1 or from each other.
double far_angle(double y, double x) {
  const bool left = std::signbit(x);
  const double size = std::fabs(x);
  if (size == infinity && y == infinity) return left ? 3 * (half_pi.hi / 2) : half_pi.hi / 2;
  if (y == 0 || size == infinity) return left ? 2 * half_pi.hi : 0;
  if (size == 0 || y == infinity) return half_pi.hi;
  const Normalised up = normalised(y);
  const Normalised along = normalised(size);
  const int difference = up.exponent - along.exponent;
  if (difference > 60) return half_pi.hi;
  if (difference < -60) return left ? 2 * half_pi.hi : y / x;
  return rounded(angle({up.value * power_of_two(difference), 0}, {std::copysign(along.value, x), 0}));
}

/// sqrt(1 - x^2), |x| <= 1
Pair other_side(double x) {
  const Pair square = exact_product(x, x);
  const Pair difference = exact_sum(1, -square.hi);
  return square_root(ordered_sum(difference.hi, difference.lo - square.lo));
}

// sinh, cosh, tanh, pow ----------------------------------------------------------------------------------------------

/// For 0 <= x < 600.
Pair sinh_of(double x) {
  if (x < 0.125) {  // x + x^3/6 + ..., where e^x - e^-x loses digits
    const double square = x * x;
    const double low = 1.0 / 120 + square * (1.0 / 5040);
    const double tail = x * square * square * (low + square * square * (1.0 / 362880 + square * (1.0 / 39916800)));
    const Pair third = third_of_cube(x, multiple(x, 0x1p-20));
    const Pair sum = ordered_sum(x, 0.5 * third.hi);
    return {sum.hi, sum.lo + (0.5 * third.lo + tail)};
  }
  const Pair twice = plus(exp_pair(x), minus(exp_pair(-x)));
  return {0.5 * twice.hi, 0.5 * twice.lo};
}

Pair cosh_of(double x) {
  const Pair twice = plus(exp_pair(x), exp_pair(-x));
  return {0.5 * twice.hi, 0.5 * twice.lo};
}

/// For 0 <= x < 300: (1 - e^-2x)/(1 + e^-2x), unless the difference loses digits.
Pair tanh_of(double x) {
  if (x < 0.125) return over(normal(sinh_of(x)), cosh_of(x));
  const Pair power = exp_pair(-2 * x);
  return over(plus({1, 0}, minus(power)), plus({1, 0}, power));
}

/// e^x/2 for 40 < x, beyond which e^-x is no part of sinh and cosh.
double half_exp(double x) {
  if (x > 712) return infinity;
  const ScaledPair power = exp_of({x, 0});
  return scaled(power.value, power.exponent - 1);
}

enum class Kind { fraction, even, odd };
Kind kind_of(double y) {
  const double size = std::fabs(y);
  if (size >= 0x1p53) return Kind::even;
  const auto whole = static_cast<std::uint64_t>(size);
  if (static_cast<double>(whole) != size) return Kind::fraction;
  return whole % 2 == 1 ? Kind::odd : Kind::even;
}

/// x^y for finite x > 0 other than 1 and y other than 0.
double power_of(double x, double y) {
  const double size = std::fabs(y);
  if (size > 0x1p65) return (x > 1) == (y > 0) ? infinity : 0;
  if (size < 0x1p-65) return 1;
  const Pair log = log_of(x);
  const Pair product = exact_product(y, log.hi);
  if (product.hi > 710) return infinity;
  if (product.hi < -746) return 0;
  const ScaledPair power = exp_of({product.hi, product.lo + y * log.lo});
  return scaled(power.value, power.exponent);
}

}  // namespace

double exp(double x) {
  if (!(std::fabs(x) < 708)) return exp_far(x);
  const ScaledPair power = exp_of({x, 0});
  return rounded(power.value) * power_of_two(power.exponent);
}

double log(double x) {
  if (!(x > 0)) return x == 0 ? -infinity : not_a_number;
  if (x == infinity) return infinity;
  return rounded(log_of(x));
}

double sin(double x) {
  if (std::fabs(x) < 0x1p-27) return x;
  if (!(std::fabs(x) < infinity)) return not_a_number;
  const Reduced angle = reduced(x);
  return rounded(sine_of(angle.place, angle.rest));
}

double cos(double x) {
  if (std::fabs(x) < 0x1p-27) return 1;
  if (!(std::fabs(x) < infinity)) return not_a_number;
  const Reduced angle = reduced(x);
  return rounded(sine_of(angle.place + 64, angle.rest));
}

double tan(double x) {
  if (std::fabs(x) < 0x1p-27) return x;
  if (!(std::fabs(x) < infinity)) return not_a_number;
  const Reduced angle = reduced(x);
  return rounded(over(normal(sine_of(angle.place, angle.rest)), normal(sine_of(angle.place + 64, angle.rest))));
}

double asin(double x) {
  const double size = std::fabs(x);
  if (size < 0x1p-27) return x;
  if (!(size <= 1)) return not_a_number;
  return std::copysign(rounded(angle({size, 0}, other_side(x))), x);
}

double acos(double x) {
  if (std::fabs(x) < 0x1p-60) return half_pi.hi;
  if (!(std::fabs(x) <= 1)) return not_a_number;
  return rounded(angle(other_side(x), {x, 0}));
}

double atan(double x) { return atan2(x, 1); }

double atan2(double y, double x) {
  if (x != x || y != y) return not_a_number;
  const int of_y = exponent_of(y);
  const int of_x = exponent_of(x);
  const bool near = of_y - of_x <= 60 && of_x - of_y <= 60 && of_y > -400 && of_y < 400;
  const double size = std::fabs(y);
  return std::copysign(near ? rounded(angle({size, 0}, {x, 0})) : far_angle(size, x), y);
}

double sinh(double x) {
  const double size = std::fabs(x);
  if (size < 0x1p-27) return x;
  if (x != x) return not_a_number;
  return std::copysign(size > 40 ? half_exp(size) : rounded(sinh_of(size)), x);
}

double cosh(double x) {
  const double size = std::fabs(x);
  if (x != x) return not_a_number;
  return size > 40 ? half_exp(size) : rounded(cosh_of(size));
}

double tanh(double x) {
  const double size = std::fabs(x);
  if (size < 0x1p-27) return x;
  if (x != x) return not_a_number;
  return std::copysign(size > 22 ? 1 : rounded(tanh_of(size)), x);
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return not_a_number;
  const double size = std::fabs(x);
  if (std::fabs(y) == infinity) return size == 1 ? 1 : (size > 1) == (y > 0) ? infinity : 0;
  const Kind kind = std::signbit(x) ? kind_of(y) : Kind::even;
  double result;
  if (size == 0 || size == infinity) {
    result = (size == 0) == (y > 0) ? 0 : infinity;
  } else if (kind == Kind::fraction) {
    return not_a_number;
  } else {
    result = size == 1 ? 1 : power_of(size, y);
  }
  return kind == Kind::odd ? -result : result;
}

double hypot(double x, double y) {
  if (std::fabs(x) == infinity || std::fabs(y) == infinity) return infinity;
  if (x != x || y != y) return not_a_number;
  double large = std::fabs(x);
  double small = std::fabs(y);
  if (large < small) std::swap(large, small);
  if (small <= large * 0x1p-60) return large;
  int exponent = 0;
  if (large > 0x1p400 || small < 0x1p-400) {
    const Normalised unit = normalised(large);
    exponent = unit.exponent;
    large = unit.value;
    small = small * power_of_two(-exponent / 2) * power_of_two(-exponent - -exponent / 2);
  }
  const Pair root = square_root(plus(exact_product(large, large), exact_product(small, small)));
  return exponent == 0 ? rounded(root) : scaled(root, exponent);
}

}  // namespace hamflow::portable
