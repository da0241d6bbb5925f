// Loops of WebAssembly, in place of src/native/step_loop.cpp and src/native/lane_function.cpp.
#include <algorithm>

#include "native/lanes.hpp"
#include "native/passes.hpp"
#include "portable/emscripten/module.hpp"

namespace hamflow {
namespace native {
namespace {

class ModuleLoop final : public StepLoop {
 public:
  explicit ModuleLoop(std::shared_ptr<const ModuleFunction> function) : function_(std::move(function)) {}

  /// A browser optimises a function between calls and not within one, so that a call takes some steps only.
  std::int64_t take(std::span<double> carried, std::int64_t steps) const override {
    constexpr std::int64_t most = 4096;
    const auto entry = function_->entry();
    for (std::int64_t taken = 0;;) {
      const std::int64_t part = std::min(steps - taken, most);
      const std::int64_t left = entry(carried.data(), part, nullptr, nullptr);
      if (left < 0) return -1;
      taken += part - left;
      if (taken == steps || left > 0) return taken;
    }
  }

 private:
  std::shared_ptr<const ModuleFunction> function_;
};

class LaneModule final : public Function {
 public:
  explicit LaneModule(std::shared_ptr<const ModuleFunction> function) : function_(std::move(function)) {}
  Entry entry() const override { return function_->entry(); }
  std::size_t bytes() const override { return 0; }

 private:
  std::shared_ptr<const ModuleFunction> function_;
};

}  // namespace

std::unique_ptr<const Function> lane_function(const LaneProgram& program, std::size_t registers, LaneSet, StepsOfLoop) {
  const std::size_t locals = 2 * registers;  // four lanes in two local variables
  constexpr std::size_t run_of_one = 32;
  auto function = module_function(interleaved(program, locals, run_of_one), Local::two_lanes, locals, program.uniform);
  return function ? std::make_unique<const LaneModule>(std::move(function)) : nullptr;
}

}  // namespace native

std::unique_ptr<const StepLoop> make_step_loop(const Program& program) {
  const Program ready = native::simplified(program);
  if (auto function = native::module_function(ready, native::Local::number, 1, ready.constants.size())) {
    return std::make_unique<native::ModuleLoop>(std::move(function));
  }
  return make_interpreter(ready);
}

/// Implicit steps have no stages in lanes.
LaneSet widest_native_lanes() { return LaneSet::generic; }

}  // namespace hamflow
