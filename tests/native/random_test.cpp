// Machine code, and the passes before it, against the interpreter, on programs drawn at random. HAMFLOW_RANDOM_PROGRAMS
// sets how many (a longer search: 100000), HAMFLOW_RANDOM_SEED which.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "native/machine_code.hpp"
#include "native/passes.hpp"
#include "random_program.hpp"

namespace hamflow {
namespace {

std::uint64_t setting(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text ? std::stoull(text) : otherwise;
}

struct Comparisons {
  std::uint64_t programs = 0, operations = 0, failed = 0, values = 0, finite = 0, longest = 0, ended = 0;
};

/// `made(program)` runs a program in the way that is tested; null skips it.
template <class Form, class Make>
Comparisons compare(std::uint64_t seed, std::uint64_t count, const Form& form, const Make& made) {
  Comparisons tally;
  for (std::uint64_t i = 0; i < count; ++i) {
    Draw draw(counter_bits(seed, i));
    const RandomCase random = random_case(draw, form(draw));
    const auto loop = made(random.program);
    if (!loop) return tally;
    std::vector<double> expected = random.start, found = random.start;
    const std::int64_t taken = make_interpreter(random.program)->take(expected, random.steps);
    const bool held = taken >= 0;
    EXPECT_EQ(loop->take(found, random.steps), taken) << "program " << i << " of seed " << seed;
    for (std::size_t k = 0; held && k < expected.size(); ++k) {
      EXPECT_TRUE(same_bits(found[k], expected[k])) << "program " << i << " of seed " << seed << ", value " << k << ": "
                                                    << found[k] << " instead of " << expected[k];
      ++tally.values;
      tally.finite += std::isfinite(expected[k]);
    }
    ++tally.programs;
    tally.operations += random.program.operations.size();
    tally.longest = std::max<std::uint64_t>(tally.longest, random.program.operations.size());
    tally.failed += !held;
    tally.ended += held && taken < random.steps;
    if (testing::Test::HasFailure()) break;
  }
  return tally;
}

auto up_to(std::size_t operations) {
  return [operations](Draw& draw) { return random_form(draw, operations); };
}

/// So much is compared that a fault would show.
void expect_substance(const Comparisons& tally) {
  EXPECT_GT(tally.finite * 2, tally.values);
  EXPECT_GT(tally.failed, tally.programs / 100);
  EXPECT_LT(tally.failed, tally.programs / 3);
  testing::Test::RecordProperty("operations", static_cast<int>(tally.operations));
  std::printf("%lu programs, %lu operations, at most %lu; %lu stopped by a check; %lu values, %lu finite\n",
              tally.programs, tally.operations, tally.longest, tally.failed, tally.values, tally.finite);
}

const std::uint64_t seed = setting("HAMFLOW_RANDOM_SEED", 1);
const std::uint64_t count = setting("HAMFLOW_RANDOM_PROGRAMS", 5000);

TEST(RandomPrograms, PassesKeepTheBits) {
  const auto passed = [](const Program& program) {
    return make_interpreter(native::scheduled(native::simplified(program)));
  };
  expect_substance(compare(seed, count / 4, up_to(2000), passed));
}

TEST(RandomPrograms, PassesKeepSpecialNumbers) {
  const auto passed = [](const Program& program) { return make_interpreter(native::simplified(program)); };
  EXPECT_GT(compare(seed, 20 * count, special_form, passed).finite, count);
}

TEST(RandomPrograms, MachineCodeHasTheBitsOfTheInterpreter) {
  if (native::scalar_registers() == 0) GTEST_SKIP() << "this processor is no x86-64 with AVX";
  expect_substance(compare(seed + 1, count, up_to(20000), native::make_machine_code));
}

TEST(RandomPrograms, RegistersHoldWhatTheyShouldHoweverFewThereAre) {
  if (native::scalar_registers() == 0) GTEST_SKIP() << "this processor is no x86-64 with AVX";
  class Loop final : public StepLoop {
   public:
    Loop(const Program& program, unsigned registers)
        : function_(native::assembled(native::placed(program, registers), program.constants)) {}
    std::int64_t take(std::span<double> carried, std::int64_t steps) const override {
      const std::int64_t left = function_->entry()(carried.data(), steps, nullptr, nullptr);
      return left < 0 ? -1 : steps - left;
    }

   private:
    std::unique_ptr<const native::Function> function_;
  };
  for (unsigned registers = 4; registers <= native::scalar_registers(); ++registers) {  // no pass before
    const Comparisons tally = compare(seed + registers, count / 30, up_to(1000), [&](const Program& program) {
      return std::make_unique<Loop>(program, registers);
    });
    EXPECT_GT(tally.programs, 0u);
  }
}

}  // namespace
}  // namespace hamflow
