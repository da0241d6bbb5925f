// **Straight-line code for expressions**: the operations of a graph that the outputs need, one after the other. Parts
// that depend only on numbers and fixed symbols are computed once, in the number type of the parameters. All other
// parts are computed for each state, in any number type.
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/detail/core/pool.hpp"
#include "hamflow/detail/formula/operations.hpp"
#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::formula {

/// An operation. Values are numbered: first the constants, then the varying symbols, then results.
struct CodeStep {
  Op op;
  int a = -1;
  int b = -1;     // unused for a whole power
  int whole = 0;  // the exponent of a power that is a product
};

struct Code {
  struct Constant {
    enum class Kind : std::uint8_t { number, pi, symbol, result } kind;
    std::string text{};  // the text of a number
    int symbol = -1;     // the index of a fixed symbol among all symbols
    CodeStep step{};     // the operation of a result; its operands are earlier constants
  };
  std::vector<Constant> constants;
  std::vector<int> symbols;  // the varying symbols, by their index among all
  std::vector<CodeStep> steps;
  std::vector<int> outputs;  // the numbers of the output values

  std::size_t places() const { return constants.size() + symbols.size() + steps.size(); }
};

/// @param fixed for each symbol, whether its value is constant
Code code_of(const Graph& graph, std::span<const int> outputs, const std::vector<bool>& fixed);

/// Converts code for doubles to a program (detail/numerics/program.hpp). It carries the varying symbols, then the
/// outputs.
Program program_of(const Code& code, const std::vector<double>& constants);

/// Machine code for code in double, with the same bits. It is compiled only after the code has run often.
class MachineCode {
 public:
  /// Returns the loop; null for the first runs.
  const StepLoop* loop(const Code& code, const std::vector<double>& constants) {
    if (const StepLoop* const ready = ready_.load(std::memory_order_acquire)) return ready;
    return runs_.fetch_add(1, std::memory_order_relaxed) < least_runs_to_record ? nullptr : made(code, constants);
  }

 private:
  [[gnu::noinline]] const StepLoop* made(const Code& code, const std::vector<double>& constants) {
    std::call_once(once_, [&] {
      loop_ = make_step_loop(program_of(code, constants));
      ready_.store(loop_.get(), std::memory_order_release);
    });
    return loop_.get();
  }
  static constexpr int least_runs_to_record = 100;
  std::atomic<int> runs_{0};
  std::once_flag once_;
  std::atomic<const StepLoop*> ready_{nullptr};
  std::unique_ptr<const StepLoop> loop_;
};

template <class S>
S applied(const CodeStep& step, const S* values) {
  if (step.op == Op::power && step.b < 0) return whole_power(values[step.a], step.whole);
  return hamflow::applied(step.op, values[step.a], values[step.b < 0 ? step.a : step.b]);
}

/// The constants of a code, computed in R.   @param value_of(symbol) the value of a fixed symbol
template <class R, class ValueOf>
std::vector<R> constants_of(const Code& code, const ValueOf& value_of) {
  std::vector<R> constants;
  constants.reserve(code.constants.size());
  for (const Code::Constant& c : code.constants) {
    switch (c.kind) {
      case Code::Constant::Kind::number:
        constants.push_back(parse_decimal<R>(c.text));
        break;
      case Code::Constant::Kind::pi:
        constants.push_back(pi_value<R>());
        break;
      case Code::Constant::Kind::symbol:
        constants.push_back(value_of(c.symbol));
        break;
      case Code::Constant::Kind::result:
        constants.push_back(applied(c.step, constants.data()));
        break;
    }
  }
  return constants;
}

/// Code whose constants are numbers of type R. Copies share the code.
template <class R>
class BoundCode {
 public:
  BoundCode() = default;
  /// @param value_of(symbol) the value of a fixed symbol
  template <class ValueOf>
  requires std::invocable<const ValueOf&, int> BoundCode(std::shared_ptr<const Code> code, const ValueOf& value_of)
      : code_(std::move(code)), constants_(constants_of<R>(*code_, value_of)) {}
  BoundCode(std::shared_ptr<const Code> code, std::vector<R> constants)
      : code_(std::move(code)), constants_(std::move(constants)) {}

  const Code& code() const { return *code_; }
  const std::vector<R>& constants() const { return constants_; }

  /// @param value_of(symbol) the value of a varying symbol   @param put(k, value) receives the k-th output
  template <class S, class ValueOf, class Put>
  void run(const ValueOf& value_of, const Put& put) const {
    if constexpr (std::is_same_v<R, double> && std::is_same_v<S, double>) {
      if (const StepLoop* const loop = machine_->loop(*code_, constants_)) return run_loop(*loop, value_of, put);
    }
    std::vector<S, PoolAllocator<S>> values;
    values.reserve(code_->places());
    for (const R& c : constants_) values.push_back(lifted<S>(c));
    for (const int symbol : code_->symbols) values.push_back(value_of(symbol));
    for (const CodeStep& step : code_->steps) values.push_back(applied(step, values.data()));
    for (std::size_t k = 0; k < code_->outputs.size(); ++k) {
      put(k, values[static_cast<std::size_t>(code_->outputs[k])]);
    }
  }

 private:
  template <class ValueOf, class Put>
  void run_loop(const StepLoop& loop, const ValueOf& value_of, const Put& put) const {
    const std::size_t inputs = code_->symbols.size();
    const std::size_t outputs = code_->outputs.size();
    constexpr std::size_t few = 32;
    double in_place[few];
    std::vector<double, PoolAllocator<double>> many;
    if (inputs + outputs > few) many.resize(inputs + outputs);
    const std::span<double> carried(many.empty() ? in_place : many.data(), inputs + outputs);
    for (std::size_t i = 0; i < inputs; ++i) carried[i] = value_of(code_->symbols[i]);
    std::fill(carried.begin() + static_cast<std::ptrdiff_t>(inputs), carried.end(), 0.0);
    (void)loop.run(carried, 1);  // without checks
    for (std::size_t k = 0; k < outputs; ++k) put(k, carried[inputs + k]);
  }

  std::shared_ptr<const Code> code_;
  std::vector<R> constants_;
  std::shared_ptr<MachineCode> machine_ = std::make_shared<MachineCode>();
};

}  // namespace hamflow::formula
