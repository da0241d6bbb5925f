// The texts of numbers in the laboratory, whose library has no std::to_chars for double, are those of the library here.
#include "portable/emscripten/shortest_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include "hamflow/core/counter_random.hpp"

namespace hamflow {
namespace {

std::string of_library(double x) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

TEST(ShortestText, KnownTexts) {
  EXPECT_EQ(shortest_text(0.0), "0");
  EXPECT_EQ(shortest_text(-0.0), "-0");
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(shortest_text(100.0), "100");
  EXPECT_EQ(shortest_text(1e5), "1e+05");
  EXPECT_EQ(shortest_text(123456.0), "123456");
  EXPECT_EQ(shortest_text(9007199254740993.0), "9007199254740992");
  EXPECT_EQ(shortest_text(1e23), "1e+23");
  EXPECT_EQ(shortest_text(-1.5e-7), "-1.5e-07");
  EXPECT_EQ(shortest_text(0.001), "0.001");
  EXPECT_EQ(shortest_text(0.0001), "1e-04");
  EXPECT_EQ(shortest_text(5e-324), "5e-324");
  EXPECT_EQ(shortest_text(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
  EXPECT_EQ(shortest_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(shortest_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(ShortestText, AsTheLibrary) {
  for (std::uint64_t k = 0; k < 100'000; ++k) {
    const double any = std::bit_cast<double>(counter_bits(1, k));
    if (any == any) {
      EXPECT_EQ(shortest_text(any), of_library(any));
    }
    const double usual = (counter_uniform(2, k) - 0.5) * std::pow(10.0, static_cast<double>(k % 40) - 20);
    EXPECT_EQ(shortest_text(usual), of_library(usual));
    const double whole = std::floor(usual);
    EXPECT_EQ(shortest_text(whole), of_library(whole));
    const double few_digits = std::floor(1000 * (1 + counter_uniform(3, k))) / 1000;
    EXPECT_EQ(shortest_text(few_digits), of_library(few_digits));
  }
}

}  // namespace
}  // namespace hamflow
