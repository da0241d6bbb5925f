// What is judged of the T-tube's table and trends, pages 94, 99 and 100 of [Sonnleitner2010].
#include <gtest/gtest.h>

#include <cmath>

#include "trend_counts.hpp"
#include "tube_changes.hpp"

namespace hamflow::reproduction::t_tube_table {
namespace {

ClaimVerdict verdict_of(const Measured& measured, const Rule& rule) {
  return judge(rule, std::vector{measured}, Grounds::program).verdict;
}

/// Two blocks, the changes of both bodies the same in each.
TubeWatch run_with(double change1, double change2, double energy_error = 0) {
  const double light = 18 + change1, heavy = 50 + change2;
  return {.start = {.v1 = 6}, .blocks = {light, light}, .heavy = {heavy, heavy}, .energy_error = energy_error};
}
Ensembles ensembles(const std::vector<TubeWatch>& near, const std::vector<TubeWatch>& grid) {
  return {changes_over(near, 2), changes_over(grid, 2), 10, 10};
}
ClaimVerdict verdict_of_pair(const Ensembles& changes) {
  return verdict_of(worse_of(distance_of("0.1756", changes, &Changes::first, "kinEnKx"),
                             distance_of("-0.9333", changes, &Changes::second, "kinEnKy")),
                    at_most(half_a_unit, "half a unit"));
}

TEST(TubeTable, TheScatterIsThatOfTheStartsThatDifferMore) {
  // Neighbours that stay together, and starts around them that do not.
  const std::vector<TubeWatch> together{run_with(-0.1753, 0.1073), run_with(-0.1753, 0.1073)};
  const Ensembles apart = ensembles(together, {run_with(-0.2, 0.15), run_with(0.36, -0.46)});
  EXPECT_GT(apart.scatter(&Changes::first), 3 * 0.39);
  EXPECT_EQ(verdict_of_pair(apart), ClaimVerdict::undecided);
  // Far from the printed ones by each of them.
  EXPECT_EQ(verdict_of_pair(ensembles(together, together)), ClaimVerdict::differs);
  // Each together, but not with the other.
  EXPECT_EQ(verdict_of_pair(ensembles(together, {run_with(1.2, -1.9), run_with(1.2, -1.9)})), ClaimVerdict::undecided);
  const std::vector<TubeWatch> printed{run_with(0.1756, -0.9333), run_with(0.1756, -0.9333)};
  EXPECT_EQ(verdict_of_pair(ensembles(printed, printed)), ClaimVerdict::holds);
  // One number of the pair is known, the other differs from start to start.
  EXPECT_EQ(verdict_of_pair(ensembles(printed, {run_with(0.1756, -0.9), run_with(0.1756, -0.95)})),
            ClaimVerdict::undecided);
}

TEST(TubeTable, AnotherRuleIsUncertainByWhatItChanges) {
  const auto verdict = [](double change, double usual_change) {
    const std::vector<TubeWatch> runs{run_with(change, -0.9), run_with(change, -0.9)};
    const std::vector<TubeWatch> of_the_table{run_with(usual_change, -0.9), run_with(usual_change, -0.9)};
    const Ensembles changes = ensembles(runs, runs), usual = ensembles(of_the_table, of_the_table);
    return verdict_of(
        by_another_way(distance_of("0.1756", changes, &Changes::first, "kinEnKx"), changes, usual, &Changes::first),
        at_most(half_a_unit, "half a unit"));
  };
  EXPECT_EQ(verdict(0.1756, 0.1756), ClaimVerdict::holds);
  EXPECT_EQ(verdict(0.3, 0.3), ClaimVerdict::differs);  // the rule changes nothing, and the number is another
  EXPECT_EQ(verdict(0.3, 0.31), ClaimVerdict::differs);
  EXPECT_EQ(verdict(0.3, 0.1), ClaimVerdict::undecided);
  EXPECT_EQ(verdict(0.1756, 0.1), ClaimVerdict::undecided);  // agreement by chance decides as little
}

TEST(TubeTable, ARunThatLosesItsEnergyIsNoMeasurement) {
  const Ensembles changes = ensembles({run_with(1, -1), run_with(1, -1, 0.02), run_with(80, -3, 5.2)},
                                      {run_with(1, -1), run_with(7, 7, std::nan(""))});
  EXPECT_EQ(changes.near.first.members, 2);
  EXPECT_EQ(changes.near.left_out, 1);
  EXPECT_DOUBLE_EQ(changes.near.first.mean, 1);
  EXPECT_DOUBLE_EQ(changes.near.energy_error, 0.02);
  EXPECT_EQ(changes.grid.left_out, 1);
  EXPECT_FALSE(changes.measured());  // one start does not tell how starts scatter
  EXPECT_NE(changes.left_out().find("2 of 5"), std::string::npos) << changes.left_out();
}

Followers followers(const std::vector<Count>& of_starts) { return {of_starts}; }

TEST(TubeTable, ATrendIsWhatMoreThanHalfOfTheRunsDo) {
  const auto verdict = [](const Followers& all) { return verdict_of(all.share(0), trend_rule()); };
  // Exceptions as in the thesis' own table, 2 of 6.
  EXPECT_EQ(verdict(followers({{40, 20, 0}, {40, 20, 0}, {41, 19, 0}})), ClaimVerdict::holds);
  EXPECT_EQ(verdict(followers({{20, 40, 0}, {20, 40, 0}, {19, 41, 0}})), ClaimVerdict::differs);
  // Runs that are cut or open may do either.
  EXPECT_EQ(verdict(followers({{11, 5, 44}, {11, 5, 44}})), ClaimVerdict::undecided);
  // What depends on v1 depends on which v1 there were.
  EXPECT_EQ(verdict(followers({{0, 60, 0}, {60, 0, 0}, {60, 0, 0}})), ClaimVerdict::undecided);
}

TEST(TubeTable, ARunCountsByItsOwnScatter) {
  Followers all = followers({Count{}});
  all.count(0.4, 0.1), all.count(-0.4, 0.1), all.count(-0.4, 0.1), all.count(0.2, 0.1), all.count(-0.2, std::nan(""));
  all.leave_open();
  const Count sum = all.all();
  EXPECT_EQ(sum.with, 2);
  EXPECT_EQ(sum.against, 1);
  EXPECT_EQ(sum.open, 3);
}

}  // namespace
}  // namespace hamflow::reproduction::t_tube_table
