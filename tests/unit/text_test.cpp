// Lists of names in messages, and the name that was probably meant.
#include "hamflow/core/text.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace hamflow {
namespace {

using Words = std::vector<std::string>;

TEST(Text, ListsAreJoinedByCommas) {
  EXPECT_EQ(joined(Words{}), "");
  EXPECT_EQ(joined(Words{"a"}), "a");
  EXPECT_EQ(joined(Words{"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(joined(Words{"", "b"}, "; "), "; b") << "an empty word is a word";
}

TEST(Text, ElementsOfAnyRangeAreJoinedByTheirTexts) {
  const std::map<std::string, int> all{{"x", 1}, {"y", 2}};
  const auto text_of = [](const auto& pair) { return pair.first + " = " + std::to_string(pair.second); };
  EXPECT_EQ(joined(all, text_of), "x = 1, y = 2");
  EXPECT_EQ(joined(all, text_of, " and "), "x = 1 and y = 2");
}

TEST(Text, TheNearestNameIsTheOneWithFewestEdits) {
  const Words names{"verlet", "stv4", "suzuki4", "yoshida6"};
  EXPECT_EQ(nearest("verlett", names), "verlet");
  EXPECT_EQ(nearest("stv", names), "stv4");
  EXPECT_EQ(nearest("yosida6", names), "yoshida6");
  EXPECT_EQ(nearest("completely-different", names), "");
  EXPECT_EQ(nearest("x", Words{}), "");
  EXPECT_EQ(nearest("half", Words{"error", "halve"}), "halve") << "two slips in a word that begins like one candidate";
  EXPECT_EQ(nearest("half", Words{"halve", "halts"}), "") << "or like two";
  EXPECT_EQ(nearest("ab", Words{"ax", "ay"}), "ax") << "the first of equally near ones";
}

TEST(Text, AtMostAThirdOfANameMayBeWrong) {
  EXPECT_EQ(nearest("abcdef", Words{"abcdxy"}), "abcdxy");
  EXPECT_EQ(nearest("abcdef", Words{"abcxyz"}), "");
  EXPECT_EQ(nearest("foo", (Words{"log", "for"})), "for") << "of short names, one character";
  EXPECT_EQ(nearest("foo", Words{"log"}), "");
  EXPECT_EQ(nearest("ab", Words{"xy"}), "");
  EXPECT_EQ(nearest("q", (Words{"x", "q1"})), "q1") << "not all of it";
  EXPECT_EQ(nearest("", (Words{"x", "cg"})), "");
}

TEST(Text, NeighboursExchangedAreOneMistake) {
  EXPECT_EQ(nearest("tiem", (Words{"mass", "time"})), "time");
  EXPECT_EQ(nearest("rk4", (Words{"r4k", "xyz"})), "r4k");
}

TEST(Text, LargeLettersAreNoMistake) { EXPECT_EQ(nearest("KEPLER", (Words{"hooke", "kepler"})), "kepler"); }

TEST(Text, TheBeginningOfANameIsEnough) {
  EXPECT_EQ(nearest("central", (Words{"duffing", "central-force"})), "central-force");
  EXPECT_EQ(nearest("ce", Words{"central-force"}), "") << "three characters at least";
}

TEST(Text, SuggestionsEndASentence) {
  EXPECT_EQ(suggestion("verlett", Words{"verlet"}), "; did you mean verlet?");
  EXPECT_EQ(suggestion("completely-different", Words{"verlet"}), "");
}

TEST(Text, SuggestionsKnowTheNamesOfOthers) {
  EXPECT_EQ(suggestion("Leapfrog", Words{"verlet", "stv4"}), "; did you mean verlet?");
  EXPECT_EQ(suggestion("long double", Words{"double", "double-double"}), "; did you mean double-double?");
  EXPECT_EQ(suggestion("t_max", Words{"dt", "t_end"}), "; did you mean t_end?");
  EXPECT_EQ(suggestion("rk8", Words{"rk4"}), "; did you mean rk4?") << "what it stands for is no candidate";
}

}  // namespace
}  // namespace hamflow
