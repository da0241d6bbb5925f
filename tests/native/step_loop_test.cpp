// The interpreter against plain C++, and machine code on the same programs.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "native/machine_code.hpp"
#include "random_program.hpp"

namespace hamflow {
namespace {

using I = Instruction;
using K = Operand::Kind;

Operand carried(std::uint32_t k) { return {K::carried, k}; }
Operand result(std::uint32_t k) { return {K::result, k}; }
Operand constant(std::uint32_t k) { return {K::constant, k}; }

/// Verlet on the Kepler problem with the kick kept: x, y, px, py, fx, fy.
Program kepler_verlet(double h) {
  Program p;
  p.constants = {h, h / 2, 1};
  const auto add = [&](I instruction, Operand a, Operand b = {}) {
    p.operations.push_back({instruction, a, b});
    return result(static_cast<std::uint32_t>(p.operations.size() - 1));
  };
  const Operand half_x = add(I::add, carried(2), add(I::multiply, constant(1), carried(4)));
  const Operand half_y = add(I::add, carried(3), add(I::multiply, constant(1), carried(5)));
  const Operand x = add(I::add, carried(0), add(I::multiply, constant(0), half_x));
  const Operand y = add(I::add, carried(1), add(I::multiply, constant(0), half_y));
  const Operand u = add(I::add, add(I::multiply, x, x), add(I::multiply, y, y));
  const Operand slope = add(I::negate, add(I::divide, constant(2), add(I::multiply, u, add(I::sqrt, u))));
  const Operand fx = add(I::multiply, slope, x), fy = add(I::multiply, slope, y);
  const Operand px = add(I::add, half_x, add(I::multiply, constant(1), fx));
  const Operand py = add(I::add, half_y, add(I::multiply, constant(1), fy));
  p.outputs = {x, y, px, py, fx, fy};
  p.checks = {{Program::Check::Kind::finite, u, {}}};
  return p;
}

void plain_kepler_verlet(std::span<double> z, double h, std::int64_t steps) {
  double x = z[0], y = z[1], px = z[2], py = z[3], fx = z[4], fy = z[5];
  for (std::int64_t i = 0; i < steps; ++i) {
    px += h / 2 * fx;
    py += h / 2 * fy;
    x += h * px;
    y += h * py;
    const double u = x * x + y * y;
    const double slope = -(1 / (u * std::sqrt(u)));
    fx = slope * x;
    fy = slope * y;
    px += h / 2 * fx;
    py += h / 2 * fy;
  }
  const double end[] = {x, y, px, py, fx, fy};
  std::copy(std::begin(end), std::end(end), z.begin());
}

const std::vector<double> kepler_start = {0.5, 0, 0, 1.7, -4, 0};

/// Every way to run a program; machine code only where this machine has it.
std::vector<std::unique_ptr<const StepLoop>> loops(const Program& program) {
  std::vector<std::unique_ptr<const StepLoop>> all;
  all.push_back(make_interpreter(program));
  all.push_back(make_step_loop(program));
  return all;
}

TEST(StepLoop, StepsOfVerletHaveTheBitsOfALoop) {
  for (const auto& loop : loops(kepler_verlet(0.01))) {
    for (const std::int64_t steps : {0, 1, 2, 3, 1000, 100000}) {
      std::vector<double> z = kepler_start, expected = kepler_start;
      EXPECT_TRUE(loop->run(z, steps));
      plain_kepler_verlet(expected, 0.01, steps);
      EXPECT_EQ(z, expected) << steps;
    }
  }
}

TEST(StepLoop, StopsWhereACheckFails) {
  for (const auto& loop : loops(kepler_verlet(0.01))) {
    std::vector<double> z = kepler_start;
    z[2] = 0x1p1020;
    EXPECT_TRUE(loop->run(z, 0));
    EXPECT_FALSE(loop->run(z, 3));
  }
}

TEST(StepLoop, EveryInstructionOnSpecialNumbers) {
  constexpr double inf = std::numeric_limits<double>::infinity(), tiny = 0x1p-1074;
  const double numbers[] = {0.0,  -0.0,         1,    -1,    0.5,       -2.5,  inf,
                            -inf, std::nan(""), tiny, -tiny, 0x1p-1022, 1e308, -1e308};
  for (int i = static_cast<int>(I::negate); i <= static_cast<int>(I::choose); ++i) {
    Program p;
    const auto instruction = static_cast<I>(i);
    const int arity = native::arity(instruction);
    p.operations = {{instruction, carried(0), arity > 1 ? carried(1) : Operand{}, arity > 2 ? carried(0) : Operand{}}};
    p.outputs = {carried(0), carried(1), result(0)};
    for (const auto& loop : loops(p)) {
      for (const double a : numbers) {
        for (const double b : numbers) {
          std::vector<double> z = {a, b, 0};
          ASSERT_TRUE(loop->run(z, 1));
          EXPECT_TRUE(same_bits(z[2], native::applied(instruction, a, b, a))) << i << ": " << a << ", " << b;
        }
      }
    }
  }
}

TEST(StepLoop, EveryCheckOnSpecialNumbers) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const double numbers[] = {0.0, -0.0, 1, -2.5, inf, -inf, std::nan(""), 1e308};
  for (int i = 0; i < 5; ++i) {
    Program p;
    const auto kind = static_cast<Program::Check::Kind>(i);
    p.outputs = {carried(0), carried(1)};
    p.checks = {{kind, carried(0), i == 0 ? Operand{} : carried(1)}};
    for (const auto& loop : loops(p)) {
      for (const double a : numbers) {
        for (const double b : numbers) {
          std::vector<double> z = {a, b};
          EXPECT_EQ(loop->run(z, 1), native::holds(kind, a, b)) << i << ": " << a << ", " << b;
        }
      }
    }
  }
}

TEST(StepLoop, ExchangesWhatIsCarried) {
  for (const std::uint32_t n : {1u, 2u, 5u, 14u, 15u, 16u, 17u, 40u}) {
    for (std::uint32_t turn = 0; turn < std::min(n, 20u); ++turn) {  // cycles of every length, in registers and memory
      Program p;
      for (std::uint32_t k = 0; k < n; ++k) p.outputs.push_back(carried((k + turn) % n));
      for (const auto& loop : loops(p)) {
        std::vector<double> z;
        for (std::uint32_t k = 0; k < n; ++k) z.push_back(k);
        ASSERT_TRUE(loop->run(z, 3));
        for (std::uint32_t k = 0; k < n; ++k) ASSERT_EQ(z[k], (k + 3 * turn) % n) << n << " " << turn;
      }
    }
  }
}

TEST(StepLoop, ThreadsShareALoop) {
  const Program program = kepler_verlet(0.02);
  for (const auto& loop : loops(program)) {
    std::vector<std::vector<double>> ends(4, kepler_start);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      ends[i][0] += 0.1 * static_cast<double>(i);
      threads.emplace_back([&, i] { EXPECT_TRUE(loop->run(ends[i], 20000)); });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < ends.size(); ++i) {
      std::vector<double> expected = kepler_start;
      expected[0] += 0.1 * static_cast<double>(i);
      plain_kepler_verlet(expected, 0.02, 20000);
      EXPECT_EQ(ends[i], expected);
    }
  }
}

TEST(StepLoop, ThreadsMakeLoopsAtOnce) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([i] {
      for (int j = 1; j <= 50; ++j) {
        const double h = 0.001 * i + 0.0001 * j;
        std::vector<double> z = kepler_start, expected = kepler_start;
        EXPECT_TRUE(make_step_loop(kepler_verlet(h))->run(z, 100));
        plain_kepler_verlet(expected, h, 100);
        EXPECT_EQ(z, expected);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(StepLoop, IsInterpretedWhereThatIsAskedFor) {
  ASSERT_EQ(setenv("HAMFLOW_NATIVE", "0", 1), 0);
  const auto loop = make_step_loop(kepler_verlet(0.01));
  ASSERT_EQ(unsetenv("HAMFLOW_NATIVE"), 0);
  const auto other = make_step_loop(kepler_verlet(0.01));
  const bool has_native = native::make_machine_code(kepler_verlet(0.01)) != nullptr;
  const auto interpreter = make_interpreter(kepler_verlet(0.01));
  const StepLoop &asked = *loop, &native = *other, &interpreted = *interpreter;
  EXPECT_EQ(typeid(asked), typeid(interpreted));
  EXPECT_EQ(typeid(native) == typeid(interpreted), !has_native);
}

/// Memory to be mapped twice is a file without a name: where none may grow, none can be had.
TEST(StepLoop, IsInterpretedWhereExecutableMemoryIsRefused) {
  const auto check = [] {
    Program p;
    p.outputs = {result(99999)};
    for (std::uint32_t i = 0; i < 100000; ++i)  // more than what may be left of memory had before
      p.operations.push_back({I::sin, i == 0 ? carried(0) : result(i - 1), {}});
    signal(SIGXFSZ, SIG_IGN);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_FSIZE, &none);
    const bool refused = native::make_machine_code(p) == nullptr;
    std::vector<double> z = {1}, expected = {1};
    const bool held = make_step_loop(p)->run(z, 2) && make_interpreter(p)->run(expected, 2);
    std::exit(refused && held && z == expected ? 0 : 1);
  };
  EXPECT_EXIT(check(), testing::ExitedWithCode(0), "");
}

/// One call for both, and the bits of two.
TEST(StepLoop, SineAndCosineOfOneNumber) {
  Draw draw(11);
  for (int k = 0; k < 200'000; ++k) {
    const double x =
        draw.chance(0.05) ? draw.special() : std::ldexp(draw.uniform() - 0.5, static_cast<int>(draw.below(80)) - 30);
    const native::SineAndCosine both = native::sine_and_cosine(x);
    if (std::isfinite(x)) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(both.sine), std::bit_cast<std::uint64_t>(std::sin(x))) << x;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(both.cosine), std::bit_cast<std::uint64_t>(std::cos(x))) << x;
    }
  }
  // Several numbers at once, in either order, with others between, and a check of the sine.
  Program p;
  const auto add = [&](I instruction, Operand a, Operand b = {}) {
    p.operations.push_back({instruction, a, b});
    return result(static_cast<std::uint32_t>(p.operations.size() - 1));
  };
  const Operand difference = add(I::subtract, carried(0), carried(1));
  const Operand cosine0 = add(I::cos, carried(0));
  const Operand sine1 = add(I::sin, difference);
  const Operand scaled = add(I::multiply, cosine0, sine1);
  const Operand sine0 = add(I::sin, carried(0));
  const Operand cosine1 = add(I::cos, difference);
  const Operand only = add(I::sin, carried(1));
  const Operand more = add(I::add, add(I::multiply, sine0, cosine1), add(I::multiply, only, scaled));
  p.outputs = {add(I::add, carried(0), more), add(I::subtract, carried(1), scaled), cosine1, sine0};
  p.checks = {{Program::Check::Kind::finite, sine1, {}}, {Program::Check::Kind::finite, sine0, {}}};
  std::vector<double> a{0.3, -1.7, 0, 0};
  std::vector<double> b = a;
  ASSERT_TRUE(make_step_loop(p)->run(a, 1000));
  ASSERT_TRUE(make_interpreter(p)->run(b, 1000));
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace hamflow
