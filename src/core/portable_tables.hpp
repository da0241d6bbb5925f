// What the portable functions look up: constants, tables of 33 to 129 rows, and the sums of two doubles that the tables
// are computed with. The compiler computes the tables, with the arithmetic of the target.
#pragma once

#include <array>
#include <cstdint>

namespace hamflow::portable {

/// The sum of two doubles, about 106 binary digits.
struct Pair {
  double hi;
  double lo;
};

/// a + b without a rounding error, if |a| >= |b| or a = 0.   [Dekker1971]
constexpr Pair ordered_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b without a rounding error.   [Knuth1997, 4.2.2]
constexpr Pair exact_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

constexpr Pair plus(Pair a, Pair b) {
  const Pair sum = exact_sum(a.hi, b.hi);
  return ordered_sum(sum.hi, sum.lo + (a.lo + b.lo));
}

/// a as two numbers of 26 digits, the second with a sign: products of such numbers are exact.   [Dekker1971]
constexpr Pair halves(double a) {
  const double large = 134217729.0 * a;
  const double hi = large - (large - a);
  return {hi, a - hi};
}

/// a b without a rounding error, if neither the product nor 2^27 a nor 2^27 b leaves the range of normal numbers.
constexpr Pair exact_product(double a, double b) {
  const Pair x = halves(a);
  const Pair y = halves(b);
  const double product = a * b;
  return {product, ((x.hi * y.hi - product) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
}

constexpr Pair times(Pair a, Pair b) {
  const Pair product = exact_product(a.hi, b.hi);
  return ordered_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

constexpr Pair over(Pair a, Pair b) {
  const double quotient = a.hi / b.hi;
  const Pair back = exact_product(quotient, b.hi);
  return ordered_sum(quotient, (((a.hi - back.hi) - back.lo) + (a.lo - quotient * b.lo)) / b.hi);
}

/// 26 digits and the rest: hi times another number of 27 digits is exact, and both together have 79 digits.
constexpr Pair short_head(Pair a) {
  const double head = halves(a.hi).hi;
  return {head, (a.hi - head) + a.lo};
}

/// pi/128 as 33 + 33 + 53 digits: products of the first two with a whole number below 2^20 are exact.   [CodyWaite1980]
constexpr double pi_128[3] = {0x1.921fb544p-6, 0x1.0b4611a6p-40, 0x1.3198a2e037073p-75};
constexpr Pair half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
/// log 2 as 35 + 53 digits: products of the first with a whole number below 2^18 are exact.
constexpr Pair log_2{0x1.62e42fef8p-1, 0x1.1cf79abc9e3b4p-36};

/// 2^(j/128)
constexpr auto exp_table = [] {
  std::array<Pair, 128> table{};
  const Pair x = times(plus({log_2.hi, 0}, {log_2.lo, 0}), {0x1p-7, 0});
  Pair term{1, 0};
  Pair step{1, 0};
  for (int n = 1; n < 13; ++n) {  // the Taylor series of exp(log(2)/128)
    term = over(times(term, x), {static_cast<double>(n), 0});
    step = plus(step, term);
  }
  Pair power{1, 0};
  for (Pair& row : table) {
    row = short_head(power);
    power = times(power, step);
  }
  return table;
}();

/// sin and cos of j pi/128 for a whole turn, j = 0 .. 255.
struct SineRow {
  Pair sine;
  Pair cosine;
};
/// The Taylor series x - x^3/3! + ... or, from 1 on, 1 - x^2/2! + ...
constexpr Pair alternating_series(Pair first, Pair square, int n) {
  Pair term = first;
  Pair sum = first;
  for (; n < 28; n += 2) {
    term = over(times(term, square), {-static_cast<double>(n * (n + 1)), 0});
    sum = plus(sum, term);
  }
  return sum;
}
constexpr auto sine_table = [] {
  std::array<SineRow, 256> table{};
  const Pair unit = plus(plus({pi_128[0], 0}, {pi_128[1], 0}), {pi_128[2], 0});
  const auto minus = [](Pair a) { return Pair{0 - a.hi, 0 - a.lo}; };  // 0 - 0 is a 0 without a sign
  for (std::size_t j = 0; j <= 32; ++j) {
    const Pair x = times({static_cast<double>(j), 0}, unit);
    const Pair square = times(x, x);
    const Pair s = short_head(alternating_series(x, square, 2));
    const Pair c = j == 32 ? s : short_head(alternating_series({1, 0}, square, 1));
    // Eight places of the circle that mirror each other, so that the functions have the symmetries exactly.
    table[j] = {s, c};
    table[64 - j] = {c, s};
    table[64 + j] = {c, minus(s)};
    table[128 - j] = {s, minus(c)};
    table[128 + j] = {minus(s), minus(c)};
    table[192 - j] = {minus(c), minus(s)};
    table[192 + j] = {minus(c), s};
    table[(256 - j) % 256] = {minus(s), c};
  }
  return table;
}();

/// artanh(1/n) and arctan(1/n) for large n: 1/n +- 1/(3 n^3) + ...
constexpr Pair inverse_series(Pair z, double sign) {
  const Pair square = times(z, z);
  Pair power = z;
  Pair sum = z;
  for (int n = 3; n < 20; n += 2) {
    power = times(power, {sign * square.hi, sign * square.lo});
    sum = plus(sum, over(power, {static_cast<double>(n), 0}));
  }
  return sum;
}

/// arctan(j/64), j = 0 .. 64. arctan b - arctan a = arctan((b - a)/(1 + a b)).
constexpr auto arctan_table = [] {
  std::array<Pair, 65> table{};
  for (std::size_t j = 0; j < 64; ++j) {
    const auto product = static_cast<double>(j * (j + 1));
    table[j + 1] = plus(table[j], inverse_series(over({64, 0}, {4096 + product, 0}), -1));
  }
  return table;
}();

/// For numbers near m = 1 + j/128: an approximation of 1/m with 8 digits behind the point, and -log of it, of which the
/// head is a multiple of 2^-35, like that of log 2. Beyond sqrt(2), `logarithm` is that of m/2.
struct LogRow {
  double inverse;
  Pair logarithm;
};
constexpr std::size_t log_middle = 53;
constexpr auto log_table = [] {
  // log((i + 1)/i) = 2 artanh(1/(2 i + 1)); of_half[i] = log(i/128), of_one[i] = log(i/256), i = 128 .. 256
  std::array<Pair, 257> of_half{};
  std::array<Pair, 257> of_one{};
  const auto step = [](std::size_t i) {
    const Pair half = inverse_series(over({1, 0}, {static_cast<double>(2 * i + 1), 0}), 1);
    return Pair{2 * half.hi, 2 * half.lo};
  };
  for (std::size_t i = 128; i < 256; ++i) of_half[i + 1] = plus(of_half[i], step(i));
  for (std::size_t i = 256; i-- > 128;) {
    const Pair down = step(i);
    of_one[i] = plus(of_one[i + 1], {-down.hi, -down.lo});
  }
  std::array<LogRow, 129> table{};
  for (std::size_t j = 0; j <= 128; ++j) {
    const std::size_t i = (2 * 256 * 128 + (128 + j)) / (2 * (128 + j));
    const Pair log = j > log_middle ? of_half[i] : of_one[i];
    const double head = (0 - log.hi + 0x1.8p17) - 0x1.8p17;
    table[j] = {static_cast<double>(i) / 256, {head, (0 - log.hi - head) - log.lo}};
  }
  return table;
}();

/// The binary digits of 2/pi behind the point, after 64 zeros.
constexpr std::array<std::uint64_t, 21> two_over_pi = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561,
    0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41,
    0x3991d639835339f4, 0x9c845f8bbdf9283b, 0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d, 0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab,
    0xf0cfbc209af4361d};

}  // namespace hamflow::portable
