// Declared options: what is allowed, what is refused and how, defaults and TOML texts.
#include "hamflow/detail/core/option_info.hpp"

#include <gtest/gtest.h>

namespace {

using namespace hamflow;

const OptionInfo points{.name = "points", .range = Range::whole_from(1, 64), .words = {"auto"}};
const OptionInfo length{.name = "length", .range = Range::positive};
const OptionInfo step{.name = "step", .range = {.not_zero = true}};
const OptionInfo halves{.name = "halves", .type = OptionType::yes_no};
const OptionInfo remedy{.name = "remedy", .type = OptionType::word, .words = {"error", "halve"}};
const OptionInfo masses{.name = "masses", .range = Range::positive, .type = OptionType::list, .length = 2};
const OptionInfo exponents{.name = "exponents", .range = Range::whole_from(1, 4), .words = {"true", "false"}};

TEST(OptionInfo, WhatIsAllowed) {
  EXPECT_EQ(allowed_text(points), "a whole number from 1 to 64, or \"auto\"");
  EXPECT_EQ(allowed_text(length), "a positive number");
  EXPECT_EQ(allowed_text(step), "a number other than 0");
  EXPECT_EQ(allowed_text(halves), "true, false");
  EXPECT_EQ(allowed_text(remedy), "error, halve");
  EXPECT_EQ(allowed_text(masses), "an array of 2 numbers, each positive");
  EXPECT_EQ(allowed_text(exponents), "a whole number from 1 to 4, or true, false");
}

TEST(OptionInfo, WhatIsAccepted) {
  for (const char* text : {"1", "64", "6e1", "10^1", "2*32", "auto"})
    EXPECT_EQ(refused_value(points, text), "") << text;
  for (const char* text : {"0.5", "1/3", "2*pi/100", "1e-300"}) EXPECT_EQ(refused_value(length, text), "") << text;
  for (const char* text : {"-1", "1e-3"}) EXPECT_EQ(refused_value(step, text), "") << text;
  for (const char* text : {"[1, 2]", "[1/3, pi]"}) EXPECT_EQ(refused_value(masses, text), "") << text;
  for (const char* text : {"true", "false", "4"}) EXPECT_EQ(refused_value(exponents, text), "") << text;
}

TEST(OptionInfo, WhatIsRefused) {
  EXPECT_EQ(refused_value(points, "65"), "found '65'; allowed a whole number from 1 to 64, or \"auto\"");
  EXPECT_EQ(refused_value(points, "1.5"), "found '1.5'; allowed a whole number from 1 to 64, or \"auto\"");
  EXPECT_EQ(refused_value(points, "aut"),
            "found 'aut'; allowed a whole number from 1 to 64, or \"auto\"; did you mean auto?");
  EXPECT_EQ(refused_value(length, "0"), "found '0'; allowed a positive number");
  EXPECT_EQ(refused_value(step, "0"), "found '0'; allowed a number other than 0");
  EXPECT_EQ(refused_value(remedy, "halv"), "found 'halv'; allowed error, halve; did you mean halve?");
  EXPECT_EQ(refused_value(halves, "tru"), "found 'tru'; allowed true, false; did you mean true?");
  EXPECT_EQ(refused_value(masses, "[1]"), "found '[1]'; allowed an array of 2 numbers, each positive");
  EXPECT_EQ(refused_value(masses, "[1, -2]"), "found '[1, -2]'; allowed an array of 2 numbers, each positive");
}

TEST(OptionInfo, FormulasHaveErrorsOfTheirOwn) {
  EXPECT_EQ(refused_value(length, "2*pi/0"),
            "found \"2*pi/0\", column 5: 2*pi divided by 0; allowed a divisor other than 0");
  EXPECT_NE(refused_value(length, "2pi").find("did you mean 2*pi?"), std::string::npos);
  EXPECT_NE(refused_value(length, "foo(3)").find("function foo"), std::string::npos);
}

TEST(OptionInfo, TomlTexts) {
  for (const char* number : {"1", "-0.5", "1e6", "2.5e-3", "0", "+3"}) EXPECT_EQ(toml_text(length, number), number);
  // What TOML would not take for a number, or not for the same one.
  for (const char* formula : {"1-2", "1/3", ".5", "5.", "01", "1e", "pi", "-", "1+1"}) {
    EXPECT_EQ(toml_text(length, formula), "\"" + std::string(formula) + "\"");
  }
  EXPECT_EQ(toml_text(points, "auto"), "\"auto\"");
  EXPECT_EQ(toml_text(halves, "true"), "true");
  EXPECT_EQ(toml_text(exponents, "true"), "true");
  EXPECT_EQ(toml_text(exponents, "3"), "3");
  EXPECT_EQ(toml_text(masses, "[1, 1/3]"), "[1, \"1/3\"]");
}

TEST(OptionInfo, Defaults) {
  EXPECT_EQ(default_text({.name = "a", .default_value = "1"}), "[1]");
  EXPECT_EQ(default_text({.name = "a", .unset = "its rounding level"}), "[unset: its rounding level]");
  EXPECT_EQ(default_text({.name = "a", .required = true}), "[required]");
}

}  // namespace
