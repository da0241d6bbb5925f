// Programs as WebAssembly modules, in place of src/native/step_loop.cpp: a function that repeats a step. Each carried
// value and each result is a local variable, which the engine of the browser puts into registers.
#include <emscripten.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <vector>

#include "native/functions.hpp"
#include "native/passes.hpp"

// Returns the place of the function in the table of functions, or 0 if the browser refuses the module.
EM_JS(int, hamflow_compile, (const unsigned char* bytes, int size), {
  try {
    var module = new WebAssembly.Module(HEAPU8.slice(bytes, bytes + size));
    var instance = new WebAssembly.Instance(module, {"e" : {"m" : wasmMemory, "t" : wasmTable}});
    var free_places = Module["free_places"] || (Module["free_places"] = []);
    var place = free_places.length > 0 ? free_places.pop() : wasmTable.grow(1);
    wasmTable.set(place, instance.exports["f"]);
    return place;
  } catch (error) {
    return 0;
  }
});
EM_JS(void, hamflow_forget, (int place), {
  wasmTable.set(place, null);
  Module["free_places"].push(place);
});

namespace hamflow {
namespace {

using Bytes = std::vector<unsigned char>;

/// Browsers allow 50 000 local variables in a function.
constexpr std::size_t most_locals = 40'000;

class Encoder {
 public:
  explicit Encoder(const Program& program) : program_(program) {}

  Bytes module() {
    Bytes out{0, 'a', 's', 'm', 1, 0, 0, 0};
    constexpr unsigned char i32 = 0x7f, f64 = 0x7c, of_function = 0x60;
    section(out, 1,
            {3, of_function, 2, i32, i32, 1, i32, of_function, 1, f64, 1, f64, of_function, 2, f64, f64, 1, f64});
    section(out, 2, {2, 1, 'e', 1, 'm', 2, 0, 0, 1, 'e', 1, 't', 1, 0x70, 0, 0});
    section(out, 3, {1, 0});
    section(out, 7, {1, 1, 'f', 0, 0});
    code();
    Bytes body{2, 1, i32};
    unsigned_number(body, program_.values() + program_.operations.size());
    body.push_back(f64);
    body.insert(body.end(), code_.begin(), code_.end());
    Bytes bodies{1};
    unsigned_number(bodies, body.size());
    bodies.insert(bodies.end(), body.begin(), body.end());
    section(out, 10, bodies);
    return out;
  }

 private:
  enum Code : unsigned char {
    block = 0x02,
    loop = 0x03,
    if_true = 0x04,
    end = 0x0b,
    br = 0x0c,
    br_if = 0x0d,
    give_back = 0x0f,
    call_indirect = 0x11,
    select = 0x1b,
    local_get = 0x20,
    local_set = 0x21,
    load = 0x2b,
    store = 0x39,
    i32_const = 0x41,
    f64_const = 0x44,
    i32_eqz = 0x45,
    i32_ge = 0x4e,
    f64_eq = 0x61,
    f64_ne = 0x62,
    f64_lt = 0x63,
    f64_gt = 0x64,
    i32_add = 0x6a,
    i32_or = 0x72,
    f64_abs = 0x99,
    f64_neg = 0x9a,
    f64_sqrt = 0x9f,
    f64_add = 0xa0,
    f64_sub = 0xa1,
    f64_mul = 0xa2,
    f64_div = 0xa3,
    no_result = 0x40
  };
  static constexpr std::size_t carried = 0, steps = 1, step = 2, first_value = 3;  // local variables

  static void unsigned_number(Bytes& out, std::size_t x) {
    for (; x >= 0x80; x >>= 7) out.push_back(static_cast<unsigned char>(x | 0x80));
    out.push_back(static_cast<unsigned char>(x));
  }
  static void section(Bytes& out, unsigned char number, const Bytes& content) {
    out.push_back(number);
    unsigned_number(out, content.size());
    out.insert(out.end(), content.begin(), content.end());
  }

  void emit(std::initializer_list<unsigned char> codes) { code_.insert(code_.end(), codes); }
  void with_number(Code code, std::size_t x) {
    code_.push_back(code);
    unsigned_number(code_, x);
  }
  /// A constant of the kind that has a signed encoding.
  void whole(std::int64_t x) {
    code_.push_back(i32_const);
    for (;;) {
      const auto low = static_cast<unsigned char>(x & 0x7f);
      x >>= 7;
      if ((x == 0 && (low & 0x40) == 0) || (x == -1 && (low & 0x40) != 0)) {
        code_.push_back(low);
        return;
      }
      code_.push_back(low | 0x80);
    }
  }
  void constant(double x) {
    code_.push_back(f64_const);
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (int shift = 0; shift < 64; shift += 8) code_.push_back(static_cast<unsigned char>(bits >> shift));
  }
  void get(const Operand& operand) {
    switch (operand.kind) {
      case Operand::Kind::carried:
        return with_number(local_get, first_value + operand.index);
      case Operand::Kind::result:
        return with_number(local_get, first_value + program_.values() + operand.index);
      case Operand::Kind::constant:
        return constant(program_.constants[operand.index]);
      case Operand::Kind::none:
        return constant(0);
    }
  }
  void memory(Code code, std::size_t value) {  // 8-byte alignment, and the offset
    emit({code, 3});
    unsigned_number(code_, 8 * value);
  }

  void operation(const Program::Operation& line) {
    const auto two = [&](Code code) {
      get(line.a);
      get(line.b);
      emit({code});
    };
    const auto one = [&](Code code) {
      get(line.a);
      emit({code});
    };
    switch (line.instruction) {
      case Operation::add:
        return two(f64_add);
      case Operation::subtract:
        return two(f64_sub);
      case Operation::multiply:
        return two(f64_mul);
      case Operation::divide:
        return two(f64_div);
      case Operation::negate:
        return one(f64_neg);
      case Operation::abs:
        return one(f64_abs);
      case Operation::sqrt:
        return one(f64_sqrt);
      case Operation::larger:
        get(line.b);
        get(line.a);
        two_compared(line.a, line.b, f64_lt);
        return emit({select});
      case Operation::choose:
        get(line.b);
        get(line.c);
        get(line.a);
        constant(0);
        return emit({f64_gt, select});
      case Operation::of_lane:
        return get(line.a);
      default:
        break;
    }
    get(line.a);
    if (const auto function = native::function_of_one(line.instruction)) {
      call(reinterpret_cast<std::intptr_t>(function), 1);
    } else {
      get(line.b);
      call(reinterpret_cast<std::intptr_t>(native::function_of_two(line.instruction)), 2);
    }
  }
  void two_compared(const Operand& a, const Operand& b, Code code) {
    get(a);
    get(b);
    emit({code});
  }
  void call(std::intptr_t function, unsigned char type) {
    whole(function);
    emit({call_indirect, type, 0});
  }

  /// Leaves the function with -1 if a check fails.
  void check(const Program::Check& check) {
    using Kind = Program::Check::Kind;
    switch (check.kind) {
      case Kind::finite:  // x - x is NaN if x is not finite
        get(check.a);
        get(check.a);
        emit({f64_sub});
        constant(0);
        emit({f64_eq, i32_eqz});
        break;
      case Kind::equal:
        two_compared(check.a, check.b, f64_eq);
        emit({i32_eqz});
        break;
      case Kind::unequal:
        two_compared(check.a, check.b, f64_ne);
        emit({i32_eqz});
        break;
      case Kind::less:
        two_compared(check.a, check.b, f64_lt);
        emit({i32_eqz});
        break;
      case Kind::not_less:
        two_compared(check.a, check.b, f64_lt);
        break;
    }
    emit({if_true, no_result});
    whole(-1);
    emit({give_back, end});
  }

  void code() {
    const std::size_t values = program_.values();
    for (std::size_t k = 0; k < values; ++k) {
      with_number(local_get, carried);
      memory(load, k);
      with_number(local_set, first_value + k);
    }
    emit({block, no_result, loop, no_result});
    with_number(local_get, step);
    with_number(local_get, steps);
    emit({i32_ge, br_if, 1});
    for (std::size_t i = 0; i < program_.operations.size(); ++i) {
      operation(program_.operations[i]);
      with_number(local_set, first_value + values + i);
    }
    for (const Program::Check& each : program_.checks) check(each);
    for (const Operand& output : program_.outputs) get(output);  // all of them first: outputs may permute values
    for (std::size_t k = values; k-- > 0;) with_number(local_set, first_value + k);
    with_number(local_get, step);
    whole(1);
    emit({i32_add});
    with_number(local_set, step);
    for (std::size_t i = 0; i < program_.ends_at.size(); ++i) {
      with_number(local_get, first_value + program_.ends_at[i]);
      constant(0);
      emit({f64_ne});
      if (i > 0) emit({i32_or});
    }
    if (!program_.ends_at.empty()) emit({br_if, 1});
    emit({br, 0, end, end});
    for (std::size_t k = 0; k < values; ++k) {
      with_number(local_get, carried);
      with_number(local_get, first_value + k);
      memory(store, k);
    }
    with_number(local_get, step);
    emit({end});
  }

  const Program& program_;
  Bytes code_;
};

class CompiledLoop final : public StepLoop {
 public:
  explicit CompiledLoop(int place) : place_(place) {}
  ~CompiledLoop() override { hamflow_forget(place_); }
  CompiledLoop(const CompiledLoop&) = delete;
  CompiledLoop& operator=(const CompiledLoop&) = delete;

  std::int64_t take(std::span<double> carried, std::int64_t steps) const override {
    constexpr std::int64_t most = 1 << 30;
    const auto function = reinterpret_cast<std::int32_t (*)(double*, std::int32_t)>(static_cast<std::intptr_t>(place_));
    for (std::int64_t taken = 0;;) {
      const std::int64_t part = std::min(steps - taken, most);
      const std::int32_t now = function(carried.data(), static_cast<std::int32_t>(part));
      if (now < 0) return -1;
      taken += now;
      if (taken == steps || now < part) return taken;
    }
  }

 private:
  int place_;
};

}  // namespace

std::unique_ptr<const StepLoop> make_step_loop(const Program& program) {
  const Program ready = native::simplified(program);
  if (ready.values() + ready.operations.size() <= most_locals) {
    const Bytes bytes = Encoder(ready).module();
    if (const int place = hamflow_compile(bytes.data(), static_cast<int>(bytes.size()))) {
      return std::make_unique<CompiledLoop>(place);
    }
  }
  return make_interpreter(ready);
}

}  // namespace hamflow
