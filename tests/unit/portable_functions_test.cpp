// The portable functions: special values, symmetries, and the bits of their results. How accurate they are is measured
// by tests/reference/portable_functions_accuracy_test.cpp.
#include "hamflow/detail/core/portable_functions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "hamflow/detail/core/hash.hpp"

namespace hamflow {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 0x1.921fb54442d18p+1;
constexpr double least = 0x1p-1074;  // the least subnormal number
constexpr double largest = std::numeric_limits<double>::max();

struct Unary {
  const char* name;
  double (*function)(double);
  int symmetry;  // -1 odd, 1 even, 0 none
};
constexpr std::array unary_functions{
    Unary{"exp", portable::exp, 0},   Unary{"log", portable::log, 0},    Unary{"sin", portable::sin, -1},
    Unary{"cos", portable::cos, 1},   Unary{"tan", portable::tan, -1},   Unary{"asin", portable::asin, -1},
    Unary{"acos", portable::acos, 0}, Unary{"atan", portable::atan, -1}, Unary{"sinh", portable::sinh, -1},
    Unary{"cosh", portable::cosh, 1}, Unary{"tanh", portable::tanh, -1},
};

std::uint64_t bits_of(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

double number_of(std::uint64_t bits) {
  double x = 0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// Arguments of every size and of usual sizes, made without rounding errors that could depend on the machine.
class Arguments {
 public:
  double finite() {
    for (;;) {
      const double x = number_of(random_());
      if (std::fabs(x) < inf) return x;
    }
  }
  /// From -8 to 8.
  double usual() { return (static_cast<double>(random_() >> 11) - 0x1p52) * 0x1p-49; }
  /// Of a size between 2^-32 and 2^32.
  double moderate() {
    const std::uint64_t bits = random_();
    return number_of((bits & 0x800fffffffffffff) | ((1023 - 32 + (bits >> 52 & 63)) << 52));
  }
  double next(int kind) { return kind == 0 ? finite() : kind == 1 ? usual() : kind == 2 ? moderate() : usual() / 8; }

 private:
  std::mt19937_64 random_{20240229};
};

struct UnaryCase {
  double (*function)(double);
  double x;
  double expected;
};
struct BinaryCase {
  double (*function)(double, double);
  double x;
  double y;
  double expected;
};

TEST(PortableFunctions, HaveTheSpecialValuesOfAnnexFForOneArgument) {
  using namespace portable;
  const std::vector<UnaryCase> cases{
      {exp, 0.0, 1},         {exp, -0.0, 1},        {exp, -inf, 0},       {exp, inf, inf},      {exp, 710, inf},
      {exp, -746, 0},        {exp, largest, inf},   {exp, -largest, 0},   {exp, least, 1},      {log, 0.0, -inf},
      {log, -0.0, -inf},     {log, 1, 0.0},         {log, -1, nan},       {log, -least, nan},   {log, inf, inf},
      {log, -inf, nan},      {sin, 0.0, 0.0},       {sin, -0.0, -0.0},    {sin, inf, nan},      {sin, -inf, nan},
      {sin, least, least},   {sin, -least, -least}, {cos, 0.0, 1},        {cos, -0.0, 1},       {cos, inf, nan},
      {cos, -inf, nan},      {tan, 0.0, 0.0},       {tan, -0.0, -0.0},    {tan, inf, nan},      {tan, -inf, nan},
      {tan, -least, -least}, {asin, 0.0, 0.0},      {asin, -0.0, -0.0},   {asin, 1, pi / 2},    {asin, -1, -pi / 2},
      {asin, 1.5, nan},      {asin, -inf, nan},     {acos, 1, 0.0},       {acos, 0, pi / 2},    {acos, -1, pi},
      {acos, 1.5, nan},      {acos, -1.5, nan},     {acos, inf, nan},     {atan, 0.0, 0.0},     {atan, -0.0, -0.0},
      {atan, inf, pi / 2},   {atan, -inf, -pi / 2}, {atan, 1, pi / 4},    {atan, least, least}, {sinh, 0.0, 0.0},
      {sinh, -0.0, -0.0},    {sinh, inf, inf},      {sinh, -inf, -inf},   {sinh, 711, inf},     {sinh, -711, -inf},
      {cosh, 0.0, 1},        {cosh, -0.0, 1},       {cosh, inf, inf},     {cosh, -inf, inf},    {cosh, 711, inf},
      {cosh, least, 1},      {tanh, 0.0, 0.0},      {tanh, -0.0, -0.0},   {tanh, inf, 1},       {tanh, -inf, -1},
      {tanh, 30, 1},         {tanh, largest, 1},    {tanh, least, least},
  };
  for (const UnaryCase& one : cases) {
    EXPECT_EQ(bits_of(one.function(one.x)), bits_of(one.expected)) << "case " << &one - cases.data() << ", x " << one.x;
  }
  for (const Unary& one : unary_functions) {
    for (const double x : {nan, -nan, number_of(0xfff8000000000123)}) {
      EXPECT_EQ(bits_of(one.function(x)), bits_of(nan)) << one.name;
    }
  }
}

TEST(PortableFunctions, HaveTheSpecialValuesOfAnnexFForAngles) {
  using portable::atan2;
  const std::vector<BinaryCase> cases{
      {atan2, 0.0, -0.0, pi},
      {atan2, 0.0, 0.0, 0.0},
      {atan2, 0.0, -1, pi},
      {atan2, 0.0, 1, 0.0},
      {atan2, 1, 0.0, pi / 2},
      {atan2, 1, -0.0, pi / 2},
      {atan2, 1, -inf, pi},
      {atan2, 1, inf, 0.0},
      {atan2, inf, 1, pi / 2},
      {atan2, inf, -1, pi / 2},
      {atan2, inf, -inf, 3 * pi / 4},
      {atan2, inf, inf, pi / 4},
      {atan2, 0.0, -inf, pi},
      {atan2, 0.0, inf, 0.0},
      {atan2, inf, 0.0, pi / 2},
      {atan2, least, largest, 0.0},
      {atan2, least, -largest, pi},
      {atan2, largest, least, pi / 2},
      {atan2, largest, -least, pi / 2},
      {atan2, least, 1, least},
      {atan2, least, 2, 0.0},
      {atan2, least, least, pi / 4},
      {atan2, largest, -largest, 3 * pi / 4},
  };
  for (const BinaryCase& one : cases) {
    EXPECT_EQ(bits_of(atan2(one.x, one.y)), bits_of(one.expected)) << one.x << ' ' << one.y;
    EXPECT_EQ(bits_of(atan2(-one.x, one.y)), bits_of(-one.expected)) << -one.x << ' ' << one.y;
  }
  for (const double x : {0.0, -1.0, inf, -nan}) {
    EXPECT_EQ(bits_of(atan2(-nan, x)), bits_of(nan));
    EXPECT_EQ(bits_of(atan2(x, nan)), bits_of(nan));
  }
}

TEST(PortableFunctions, HaveTheSpecialValuesOfAnnexFForPowers) {
  using portable::pow;
  const double odd = 0x1.fffffffffffffp52;  // the largest odd double
  const std::vector<BinaryCase> cases{
      {pow, 0.0, -3, inf},
      {pow, -0.0, -3, -inf},
      {pow, 0.0, -odd, inf},
      {pow, -0.0, -odd, -inf},
      {pow, 0.0, -2, inf},
      {pow, -0.0, -2, inf},
      {pow, -0.0, -2.5, inf},
      {pow, -0.0, -inf, inf},
      {pow, 0.0, 3, 0.0},
      {pow, -0.0, 3, -0.0},
      {pow, -0.0, 2, 0.0},
      {pow, -0.0, 2.5, 0.0},
      {pow, 0.0, inf, 0.0},
      {pow, -1, inf, 1},
      {pow, -1, -inf, 1},
      {pow, 1, nan, 1},
      {pow, 1, inf, 1},
      {pow, nan, 0.0, 1},
      {pow, nan, -0.0, 1},
      {pow, inf, 0.0, 1},
      {pow, -2, 0.5, nan},
      {pow, -largest, 0.1, nan},
      {pow, 0.5, -inf, inf},
      {pow, -0.5, -inf, inf},
      {pow, 2, -inf, 0.0},
      {pow, -2, -inf, 0.0},
      {pow, 0.5, inf, 0.0},
      {pow, -2, inf, inf},
      {pow, -inf, -3, -0.0},
      {pow, -inf, -2, 0.0},
      {pow, -inf, -2.5, 0.0},
      {pow, -inf, 3, -inf},
      {pow, -inf, 2, inf},
      {pow, -inf, 2.5, inf},
      {pow, inf, -1, 0.0},
      {pow, inf, 0.5, inf},
      {pow, -1, odd, -1},
      {pow, -1, odd + 1, 1},
      {pow, -1, largest, 1},
      {pow, nan, 1, nan},
      {pow, 2, nan, nan},
      {pow, 2, 1024, inf},
      {pow, -2, 1025, -inf},
      {pow, 2, -1074, least},
      {pow, -2, -1073, -2 * least},
      {pow, 2, -1080, 0.0},
      {pow, -2, -1081, -0.0},
      {pow, 2, largest, inf},
      {pow, 2, -largest, 0.0},
      {pow, 0.5, largest, 0.0},
      {pow, 2, least, 1},
      {pow, least, least, 1},
      {pow, 2, 10, 1024},
      {pow, 3, 33, 5559060566555523},
      {pow, -3, 33, -5559060566555523},
      {pow, 4, 0.5, 2},
      {pow, 0x1p-1074, 0.5, 0x1p-537},
      {pow, 16, 0.75, 8},
      {pow, 10, 22, 1e22},
      {pow, 1.5, 1, 1.5},
      {pow, least, 1, least},
      {pow, largest, 1, largest},
      {pow, largest, -1, 0x1p-1024},
  };
  for (const BinaryCase& one : cases) {
    EXPECT_EQ(bits_of(pow(one.x, one.y)), bits_of(one.expected)) << one.x << ' ' << one.y << ' ' << pow(one.x, one.y);
  }
}

TEST(PortableFunctions, HaveTheSpecialValuesOfAnnexFForHypotenuses) {
  using portable::hypot;
  const std::vector<BinaryCase> cases{
      {hypot, inf, nan, inf},
      {hypot, -inf, nan, inf},
      {hypot, 1, nan, nan},
      {hypot, 0.0, -0.0, 0},
      {hypot, 0.0, -3, 3},
      {hypot, largest, largest, inf},
      {hypot, 3, 4, 5},
      {hypot, 3 * least, 4 * least, 5 * least},
      {hypot, 0x3p1020, 0x4p1020, 0x5p1020},
      {hypot, least, 0, least},
      {hypot, largest, 1, largest},
      {hypot, least, least, least},
  };
  for (const BinaryCase& one : cases) {
    for (const double x : {one.x, -one.x}) {
      EXPECT_EQ(bits_of(hypot(x, one.y)), bits_of(one.expected)) << x << ' ' << one.y;
      EXPECT_EQ(bits_of(hypot(-one.y, x)), bits_of(one.expected)) << x << ' ' << one.y;
    }
  }
}

TEST(PortableFunctions, AreExactlySymmetric) {
  Arguments arguments;
  for (int n = 0; n < 40000; ++n) {
    const double x = arguments.next(n % 4);
    const double y = arguments.next(n / 4 % 4);
    for (const Unary& one : unary_functions) {
      if (one.symmetry == 0) continue;
      const double value = one.function(x);
      const double expected = value != value ? value : one.symmetry * value;
      ASSERT_EQ(bits_of(one.function(-x)), bits_of(expected)) << one.name << " of " << x;
    }
    ASSERT_EQ(bits_of(portable::atan2(-y, x)), bits_of(-portable::atan2(y, x))) << y << ' ' << x;
    ASSERT_EQ(bits_of(portable::hypot(x, y)), bits_of(portable::hypot(-y, x))) << x << ' ' << y;
    ASSERT_EQ(bits_of(portable::pow(-std::fabs(x), 3)), bits_of(-portable::pow(std::fabs(x), 3))) << x;
  }
}

/// Another compiler, processor or setting (contraction to fused multiply-adds) that changes one bit changes this hash.
TEST(PortableFunctions, HaveTheSameBitsEverywhere) {
  Arguments arguments;
  std::uint64_t hash = fnv1a_of_nothing;
  const auto add = [&hash](double value) {
    std::array<std::byte, 8> bytes{};
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(bits_of(value) >> 8 * i & 0xff);
    hash = fnv1a(bytes, hash);
  };
  for (int n = 0; n < 40000; ++n) {
    const double x = arguments.next(n % 4);
    const double y = arguments.next(n / 4 % 4);
    for (const Unary& one : unary_functions) add(one.function(x));
    add(portable::atan2(x, y));
    add(portable::hypot(x, y));
    add(portable::pow(std::fabs(x), y));
  }
  EXPECT_EQ(hash, 0x91911b7ab639235eu);
}

}  // namespace
}  // namespace hamflow
