// Many members at once against each alone: every lane of every set has the bits of the interpreter.
#include "native/lanes.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "numerics/program_lanes.hpp"
#include "random_program.hpp"

namespace hamflow {
namespace {

constexpr LaneSet all_sets[] = {LaneSet::generic, LaneSet::avx2, LaneSet::avx512};

/// Members of one program: starts, and the constants in which they differ.
struct Family {
  RandomCase base;
  std::unique_ptr<bool[]> differs;
  std::vector<Program> programs;
  std::vector<std::vector<double>> starts;
};

Family random_family(Draw& draw, const RandomForm& form, std::size_t members) {
  Family family{random_case(draw, form), nullptr, {}, {}};
  const std::size_t constants = family.base.program.constants.size();
  family.differs = std::make_unique<bool[]>(constants);
  const double share = draw.uniform();
  for (std::size_t c = 0; c < constants; ++c) family.differs[c] = draw.chance(share);
  const auto other = [&](double x) { return draw.chance(0.02) ? draw.special() : x * (1 + 0.01 * draw.uniform()); };
  for (std::size_t i = 0; i < members; ++i) {
    family.programs.push_back(family.base.program);
    for (std::size_t c = 0; c < constants; ++c) {
      if (family.differs[c]) family.programs[i].constants[c] = other(family.base.program.constants[c]);
    }
    family.starts.push_back(family.base.start);
    for (double& x : family.starts[i]) x = other(x);
  }
  return family;
}

struct Tally {
  std::uint64_t failed = 0, lanes = 0, values = 0, finite = 0;
};

/// Runs the family in lanes and one after the other. @param steps one: asked for step by step, one register to a number
void compare(Family family, LaneSet set, StepsOfLoop steps, Tally& tally) {
  const Program& program = family.base.program;
  const std::size_t values = program.values(), constants = program.constants.size();
  const bool one = steps == StepsOfLoop::one;
  const auto loop = make_lane_loop(program, {family.differs.get(), constants}, set, one ? 1 : 4, steps);
  const std::size_t lanes = loop->lanes();
  ASSERT_LE(lanes, family.programs.size());
  LaneNumbers carried(values * lanes);
  std::vector<double> given;
  for (std::size_t k = 0; k < values; ++k) {
    for (std::size_t i = 0; i < lanes; ++i) carried[k * lanes + i] = family.starts[i][k];
  }
  for (std::size_t c = 0; c < constants; ++c) {
    for (std::size_t i = 0; family.differs[c] && i < lanes; ++i) given.push_back(family.programs[i].constants[c]);
  }
  const auto failed = std::make_unique<bool[]>(lanes);
  const LaneNumbers prepared = loop->prepared(given);
  std::int64_t taken = 0;
  for (std::int64_t k = 0; k < (one ? family.base.steps : 1); ++k) {
    taken += loop->run(carried, prepared, one ? 1 : family.base.steps, {failed.get(), lanes});
  }
  std::int64_t first_end = family.base.steps;  // of the members run alone
  for (std::size_t i = 0; i < lanes; ++i) {
    std::vector<double> expected = family.starts[i];
    if (!one && !failed[i]) {
      std::vector<double> alone = expected;
      const std::int64_t until_end = make_interpreter(family.programs[i])->take(alone, family.base.steps);
      if (until_end >= 0) first_end = std::min(first_end, until_end);
    }
    family.programs[i].ends_at.clear();
    const bool held = make_interpreter(family.programs[i])->run(expected, taken);
    EXPECT_EQ(failed[i], !held) << name(set) << " lane " << i;
    ++tally.lanes;
    tally.failed += !held;
    for (std::size_t k = 0; held && k < values; ++k) {
      const double found = carried[k * lanes + i];
      EXPECT_TRUE(same_bits(found, expected[k]))
          << name(set) << ", lane " << i << ", value " << k << ": " << found << " instead of " << expected[k];
      ++tally.values;
      tally.finite += std::isfinite(expected[k]);
    }
  }
  // What a lane carries whose check has failed may end the loop as well.
  EXPECT_LE(taken, first_end);
  if (std::none_of(failed.get(), failed.get() + lanes, [](bool lane) { return lane; })) {
    EXPECT_EQ(taken, first_end);
  }
}

void compare_random(std::uint64_t seed, std::uint64_t count, std::size_t most_operations) {
  for (const LaneSet set : all_sets) {
    Tally tally;
    for (std::uint64_t i = 0; i < count; ++i) {
      SCOPED_TRACE("family " + std::to_string(i) + " of seed " + std::to_string(seed));
      Draw draw(counter_bits(seed, i));
      RandomForm form = i % 8 == 0 ? special_form(draw) : random_form(draw, most_operations);
      compare(random_family(draw, form, 32), set, i % 3 == 0 ? StepsOfLoop::one : StepsOfLoop::many, tally);
      if (testing::Test::HasFailure()) return;
    }
    std::printf("%s: %lu lanes, %lu stopped by a check, %lu values, %lu finite\n", std::string(name(set)).c_str(),
                tally.lanes, tally.failed, tally.values, tally.finite);
    EXPECT_GT(tally.finite * 2, tally.values);
    EXPECT_GT(tally.failed, tally.lanes / 100);
    EXPECT_LT(tally.failed, tally.lanes / 3);
  }
}

TEST(LaneLoop, RandomFamiliesHaveTheBitsOfTheirMembers) {
  const char* const text = std::getenv("HAMFLOW_RANDOM_PROGRAMS");
  compare_random(5, (text ? std::stoull(text) : 10000) / 10, 1000);
}

TEST(LaneLoop, RandomFamiliesInterpreted) {
  ASSERT_EQ(setenv("HAMFLOW_NATIVE", "0", 1), 0);
  compare_random(6, 100, 1000);
  ASSERT_EQ(unsetenv("HAMFLOW_NATIVE"), 0);
}

TEST(LaneLoop, AFailedLaneStopsNoOther) {
  using Kind = Operand::Kind;
  Program p;  // x <- x d as long as x is finite
  p.constants = {2};
  p.operations = {{Instruction::multiply, {Kind::carried, 0}, {Kind::constant, 0}}};
  p.outputs = {{Kind::result, 0}};
  p.checks = {{Program::Check::Kind::finite, {Kind::result, 0}, {}}};
  const bool differs[] = {true};
  for (const LaneSet set : all_sets) {
    const auto loop = make_lane_loop(p, differs, set);
    const std::size_t lanes = loop->lanes();
    for (std::size_t bad = 0; bad < lanes; ++bad) {
      LaneNumbers x(lanes, 1), d(lanes, 0.5);
      d[bad] = 0x1p600;
      const auto failed = std::make_unique<bool[]>(lanes);
      loop->run(x, loop->prepared(d), 10, {failed.get(), lanes});
      for (std::size_t i = 0; i < lanes; ++i) {
        EXPECT_EQ(failed[i], i == bad);
        if (i != bad) {
          EXPECT_EQ(x[i], 0x1p-10);
        }
      }
    }
  }
}

TEST(LaneLoop, WhatFollowsFromConstantsAloneIsComputedOnce) {
  using Kind = Operand::Kind;
  Program p;  // x <- x + sqrt(d d + 1)
  p.constants = {0, 1};
  p.operations = {{Instruction::multiply, {Kind::constant, 0}, {Kind::constant, 0}},
                  {Instruction::add, {Kind::result, 0}, {Kind::constant, 1}},
                  {Instruction::sqrt, {Kind::result, 1}, {}},
                  {Instruction::add, {Kind::carried, 0}, {Kind::result, 2}}};
  p.outputs = {{Kind::result, 3}};
  const bool differs[] = {true, false};
  const native::LaneProgram parts = native::lane_program(p, differs);
  EXPECT_EQ(parts.step.operations.size(), 1u);
  EXPECT_EQ(parts.before.operations.size(), 3u);
  EXPECT_EQ(parts.given, 1u);
}

TEST(LaneLoop, ALaneReadsTheNumbersOfOthers) {
  using Kind = Operand::Kind;
  for (const LaneSet set : all_sets) {
    for (const std::size_t registers : {1u, 2u, 3u, 4u}) {
      const std::size_t lanes = registers * (set == LaneSet::avx512 ? 8 : 4);
      for (std::size_t of = 0; of < lanes; ++of) {
        Program p;  // y <- y + x of one lane
        p.constants = {static_cast<double>(of)};
        p.operations = {{Instruction::of_lane, {Kind::carried, 0}, {Kind::constant, 0}},
                        {Instruction::add, {Kind::carried, 1}, {Kind::result, 0}}};
        p.outputs = {{Kind::carried, 0}, {Kind::result, 1}};
        const bool differs[] = {false};
        for (const StepsOfLoop steps : {StepsOfLoop::one, StepsOfLoop::many}) {
          const auto loop = make_lane_loop(p, differs, set, registers, steps);
          ASSERT_EQ(loop->lanes(), lanes);
          LaneNumbers numbers(2 * lanes);
          for (std::size_t i = 0; i < 2 * lanes; ++i) numbers[i] = static_cast<double>(i);
          const auto failed = std::make_unique<bool[]>(lanes);
          const int count = steps == StepsOfLoop::one ? 1 : 3;
          loop->run(numbers, loop->prepared({}), count, {failed.get(), lanes});
          for (std::size_t i = 0; i < lanes; ++i) {
            EXPECT_EQ(numbers[i], static_cast<double>(i));
            EXPECT_EQ(numbers[lanes + i], static_cast<double>(lanes + i + of * static_cast<std::size_t>(count)));
          }
        }
      }
    }
  }
}

TEST(LaneLoop, RefusesWhatHasNoMeaning) {
  Program p;
  p.constants = {1};
  const bool differs[] = {true};
  EXPECT_THROW(make_lane_loop(p, {}, LaneSet::avx2), std::invalid_argument);
  EXPECT_THROW(make_lane_loop(p, differs, LaneSet::none), std::invalid_argument);
}

TEST(LaneLoop, LanesAreThoseOfTheSet) {
  EXPECT_EQ(make_lane_loop({}, {}, LaneSet::generic)->lanes(), 16u);
  EXPECT_EQ(make_lane_loop({}, {}, LaneSet::avx2)->lanes(), 16u);
  EXPECT_EQ(make_lane_loop({}, {}, LaneSet::avx512)->lanes(), 32u);
}

}  // namespace
}  // namespace hamflow
