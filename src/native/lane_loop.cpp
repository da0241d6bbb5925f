#include <algorithm>
#include <array>
#include <stdexcept>

#include "lanes.hpp"

namespace hamflow {
namespace native {
namespace {

constexpr std::size_t most_registers = 4;

class LaneLoopOf final : public LaneLoop {
 public:
  LaneLoopOf(LaneProgram program, std::size_t lanes, std::size_t registers, std::unique_ptr<const Function> function)
      : program_(std::move(program)), lanes_(lanes), width_(lanes / registers), function_(std::move(function)) {}

  std::size_t lanes() const override { return lanes_; }

  LaneNumbers prepared(std::span<const double> constants) const override {
    LaneNumbers all(program_.before.values() * lanes_);
    std::copy_n(constants.data(), program_.given * lanes_, all.data());
    interpret_lanes(program_.before, program_.uniform, lanes_, all.data(), nullptr, 1, nullptr);
    return all;
  }

  std::int64_t run(LaneNumbers& carried, const LaneNumbers& constants, std::int64_t steps,
                   std::span<bool> failed) const override {
    if (!function_) {
      return interpret_lanes(program_.step, program_.uniform, lanes_, carried.data(), constants.data(), steps,
                             failed.data());
    }
    std::array<std::uint64_t, most_registers> flags{};
    const std::int64_t left = function_->entry()(carried.data(), steps, constants.data(), flags.data());
    if (std::any_of(flags.begin(), flags.end(), [](std::uint64_t lanes) { return lanes != 0; })) {
      for (std::size_t i = 0; i < lanes_; ++i) failed[i] |= (flags[i / width_] >> (i % width_) & 1) != 0;
    }
    return steps - left;
  }

 private:
  LaneProgram program_;
  std::size_t lanes_;
  std::size_t width_;                         // numbers per register
  std::unique_ptr<const Function> function_;  // null: interpreted
};

}  // namespace
}  // namespace native

std::unique_ptr<const LaneLoop> make_lane_loop(const Program& program, std::span<const bool> differs, LaneSet lanes,
                                               std::size_t registers, StepsOfLoop steps) {
  if (lanes == LaneSet::none)
    throw std::invalid_argument("make_lane_loop: found no lanes; allowed generic, avx2, avx512");
  if (differs.size() != program.constants.size())
    throw std::invalid_argument("make_lane_loop: found " + std::to_string(differs.size()) + " flags for " +
                                std::to_string(program.constants.size()) + " constants");
  if (registers < 1 || registers > native::most_registers)
    throw std::invalid_argument("make_lane_loop: found " + std::to_string(registers) +
                                " registers to a number; allowed 1 to 4");
  native::LaneProgram ready = native::lane_program(program, differs);
  std::unique_ptr<const native::Function> function = native::lane_function(ready, registers, lanes, steps);
  const std::size_t count = registers * (lanes == LaneSet::avx512 ? 8 : 4);
  return std::make_unique<native::LaneLoopOf>(std::move(ready), count, registers, std::move(function));
}

}  // namespace hamflow
