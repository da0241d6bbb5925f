// A verdict is what the numbers and the rule make of it, and nothing else.
#include "claim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sign_test.hpp"

namespace hamflow {
namespace {

ClaimVerdict verdict_of(const Rule& rule, std::vector<Measured> measured, Grounds grounds = Grounds::program) {
  return judge(rule, measured, grounds).verdict;
}

TEST(Claim, HoldsWhereAllThatTheNumberMayBeIsWithinTheRule) {
  const Rule rule = within(4, 0.3, "order 2");
  EXPECT_EQ(verdict_of(rule, {{4.1, 0.1}}), ClaimVerdict::holds);
  EXPECT_EQ(verdict_of(rule, {{4.1, 0.25}}), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of(rule, {{4.5, 0.25}}), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of(rule, {{4.5, 0.15}}), ClaimVerdict::differs);
}

TEST(Claim, AsPrintedAllowsHalfAUnitOfTheLastDigit) {
  EXPECT_EQ(verdict_of(as_printed("-0.25"), {{-0.2549}}), ClaimVerdict::holds);
  EXPECT_EQ(verdict_of(as_printed("-0.25"), {{-0.2551}}), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of(as_printed("3"), {{3.49}}), ClaimVerdict::holds);
  EXPECT_EQ(verdict_of(as_printed("3"), {{2.49}}), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of(as_printed("-3.747e-15"), {{-3.7474e-15}}), ClaimVerdict::holds);
  EXPECT_EQ(verdict_of(as_printed("-3.747e-15"), {{-3.7476e-15}}), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of(as_printed("1e3"), {{1400.0}}), ClaimVerdict::holds);
}

TEST(Claim, WhatIsNoNumberIsUndecided) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const Rule& rule : {at_most(1, ""), at_least(1, ""), none_of("rows"), as_printed("0.5")}) {
    EXPECT_EQ(verdict_of(rule, {{nothing}}), ClaimVerdict::undecided);
    EXPECT_EQ(verdict_of(rule, {{0.5, nothing}}), ClaimVerdict::undecided);
    EXPECT_EQ(verdict_of(rule, {{0.5, std::numeric_limits<double>::infinity()}}), ClaimVerdict::undecided);
    EXPECT_EQ(verdict_of(rule, {}), ClaimVerdict::undecided);
  }
}

TEST(Claim, ReasonsHaveTheDigitsThatDecide) {
  const std::string reason =
      judge(as_printed("-0.167875643"), std::vector<Measured>{{-0.16787564376854627, 7e-15}}, Grounds::program).reason;
  EXPECT_NE(reason.find("-0.167875643768546 +- 7e-15"), std::string::npos) << reason;
}

/// The verdict of a count of twelve.
ClaimVerdict verdict_of_majority(int with, int against) {
  const reproduction::Majority count{with, against};
  return verdict_of(count.rule("orbits"), {count.measured("")});
}

TEST(Claim, AMajorityIsMoreThanChanceAllows) {
  EXPECT_EQ(verdict_of_majority(6, 6), ClaimVerdict::undecided);  // a tie is no advantage
  EXPECT_EQ(verdict_of_majority(9, 3), ClaimVerdict::undecided);  // P = 2 * 299/4096
  EXPECT_EQ(verdict_of_majority(10, 2), ClaimVerdict::holds);     // P = 2 * 79/4096
  EXPECT_EQ(verdict_of_majority(3, 9), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of_majority(2, 10), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of_majority(5, 0), ClaimVerdict::undecided);  // P = 2/32
  EXPECT_EQ(verdict_of_majority(6, 0), ClaimVerdict::holds);      // P = 2/64
  EXPECT_EQ(verdict_of_majority(4, 3), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of_majority(0, 0), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of_majority(40, 60), ClaimVerdict::undecided);  // P = 0.057
  EXPECT_EQ(verdict_of_majority(39, 61), ClaimVerdict::differs);    // P = 0.035
}

TEST(Claim, WhatASearchDidNotFindMayBeThere) {
  const auto verdict = [](int number, int of) {
    return verdict_of(reproduction::none_of_all("starts"), {reproduction::seen_among(number, of, "")});
  };
  EXPECT_NEAR(reproduction::largest_share_unseen(2), 0.776, 1e-3);
  EXPECT_NEAR(reproduction::largest_share_unseen(1000), 0.003, 1e-5);
  EXPECT_EQ(verdict(0, 0), ClaimVerdict::undecided);
  EXPECT_EQ(verdict(0, 2), ClaimVerdict::undecided);
  EXPECT_EQ(verdict(0, 58), ClaimVerdict::undecided);
  EXPECT_EQ(verdict(0, 59), ClaimVerdict::holds);
  EXPECT_EQ(verdict(1, 2), ClaimVerdict::differs);  // one is enough
  EXPECT_EQ(verdict(1, 1000), ClaimVerdict::differs);
}

TEST(Claim, OneProgramAloneRefutesNothing) {
  const Rule rule = none_of("counter-examples");
  const Measured found{2, 0, "first way"}, again{3, 0, "second way"}, none{0, 0, "second way"};
  EXPECT_EQ(verdict_of(rule, {found}), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of(rule, {found}, Grounds::ways), ClaimVerdict::differs);
  EXPECT_EQ(verdict_of(rule, {found, again}, Grounds::ways), ClaimVerdict::cannot_hold);
  EXPECT_EQ(verdict_of(rule, {found, none}, Grounds::ways), ClaimVerdict::undecided);
  EXPECT_EQ(verdict_of(rule, {found}, Grounds::identity), ClaimVerdict::cannot_hold);
  EXPECT_EQ(verdict_of(rule, {none}, Grounds::identity), ClaimVerdict::holds);
}

}  // namespace
}  // namespace hamflow
