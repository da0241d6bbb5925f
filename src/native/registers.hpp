// Register allocation: translates a program to lines that a processor can execute one by one. Only the number of
// registers depends on the processor.
#pragma once

#include "numerics/program_lanes.hpp"

namespace hamflow::native {

/// The place of a number.
struct Place {
  enum class Kind : std::uint8_t {
    none,
    reg,       // in a register
    home,      // in the array of carried values, which the caller owns
    slot,      // on the stack
    constant,  // in the table of constants
  };
  Kind kind = Kind::none;
  std::uint32_t index = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

struct Line {
  enum class Kind : std::uint8_t {
    move,       // to <- a; one of the two is a register
    operation,  // to <- instruction(a, b). `to` and a are registers, b may be anywhere. larger(a, b) is a > b ? a : b.
                // For fused operations and choose, c is the old value of `to`. For of_lane, a is a home, b the constant
    call,       // register 0 <- instruction(register 0, register 1). All registers lose their numbers. sine_of_both
                // also sets register 1 <- cosine
    check,      // checks the register a, with b anywhere; `to` is a scratch register
  };
  Kind kind = Kind::move;
  Instruction instruction{};
  Program::Check::Kind check{};
  Place to, a, b;
  std::uint32_t index = 0;  // the index of a check in the program
};

/// The lines that run once before the steps, in every step, and once after the last step.
struct PlacedProgram {
  std::vector<Line> entry, body, exit;
  std::vector<Place> ends_at;  // the places of Program::ends_at after a step
  std::uint32_t slots = 0;
};

/// Allocates the numbers of a program to `registers` (at least 4) registers, keeping the order of operations. Carried
/// values keep the same registers from step to step, as far as there are enough. If a register is needed, the number
/// whose next use is latest is stored.
/// @param steps with StepsOfLoop::one, values that the step does not change stay in memory and are not stored again
PlacedProgram placed(const Program& program, unsigned registers, StepsOfLoop steps = StepsOfLoop::many);

}  // namespace hamflow::native
