// Which number is in which register, and when: a program as a list of lines that a processor can do one by one. Nothing
// here depends on the processor but how many registers there are.
#pragma once

#include "numerics/program_lanes.hpp"

namespace hamflow::native {

/// Where a number is.
struct Place {
  enum class Kind : std::uint8_t {
    none,
    reg,       // in a register
    home,      // in the caller's array of what is carried
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
    operation,  // to <- instruction(a, b): registers, but that b may be anywhere. larger(a, b) is a > b ? a : b; of
                // fused operations and of choose c is what `to` was; of of_lane a is a home, b the constant
    call,       // register 0 <- instruction(register 0, register 1); no register keeps its number. Of sine_of_both
                // register 1 <- the cosine
    check,      // of the register a, with b anywhere; `to` is a register that it may use
  };
  Kind kind = Kind::move;
  Instruction instruction{};
  Program::Check::Kind check{};
  Place to, a, b;
  std::uint32_t index = 0;  // of the check in the program
};

/// What is done once before the steps, in every step, and once after the last.
struct PlacedProgram {
  std::vector<Line> entry, body, exit;
  std::vector<Place> ends_at;  // numbers behind a step, see Program::ends_at
  std::uint32_t slots = 0;
};

/// Places every number of the program, at most `registers` (at least 4) of them in registers at a time. Program order
/// is kept. Carried values have fixed registers in which a step finds and leaves them, as long as there are registers;
/// where one is wanted, the number that is used last is stored.
/// @param steps one: what the step does not change stays in memory, and is not stored again
PlacedProgram placed(const Program& program, unsigned registers, StepsOfLoop steps = StepsOfLoop::many);

}  // namespace hamflow::native
