#include "portable/emscripten/module.hpp"

#include <emscripten.h>

#include <algorithm>
#include <bit>
#include <deque>
#include <initializer_list>
#include <utility>
#include <vector>

#include "native/functions.hpp"

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

namespace hamflow::native {
namespace {

using Bytes = std::vector<unsigned char>;

/// Browsers allow 50 000 local variables in a function.
constexpr std::size_t most_locals = 40'000;

class Encoder {
 public:
  Encoder(const Program& program, Local local, std::size_t locals, std::size_t uniform)
      : program_(program),
        in_lanes_(local == Local::two_lanes),
        locals_(locals),
        uniform_(uniform),
        number_type_(in_lanes_ ? 0x7b : 0x7c),
        first_value_(first_mask + (in_lanes_ ? locals : 0)) {}

  Bytes module() {
    Bytes out{0, 'a', 's', 'm', 1, 0, 0, 0};
    constexpr unsigned char i32 = 0x7f, i64 = 0x7e, f64 = 0x7c, of_function = 0x60;
    section(out, 1, {3, of_function, 4, i32, i64,         i32, i32, 1,   i64, of_function,
                     1, f64,         1, f64, of_function, 2,   f64, f64, 1,   f64});
    section(out, 2, {2, 1, 'e', 1, 'm', 2, 0, 0, 1, 'e', 1, 't', 1, 0x70, 0, 0});
    section(out, 3, {1, 0});
    section(out, 7, {1, 1, 'f', 0, 0});
    code();
    Bytes body{1};
    unsigned_number(body, first_value_ - first_mask + program_.values() + program_.operations.size());
    body.push_back(number_type_);
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
    store_i32 = 0x36,
    i32_const = 0x41,
    i64_const = 0x42,
    f64_const = 0x44,
    i64_eqz = 0x50,
    i32_eqz = 0x45,
    i32_or = 0x72,
    i32_shift = 0x74,
    i64_sub = 0x7d,
    no_result = 0x40
  };
  /// An instruction of one number and the one of two lanes.
  struct Both {
    unsigned char of_number;
    unsigned char of_lanes;
  };
  static constexpr Both load{0x2b, 0x00}, store{0x39, 0x0b}, equal{0x61, 0x47}, unequal{0x62, 0x48}, less{0x63, 0x49},
      greater{0x64, 0x4a}, abs{0x99, 0xec}, negate{0x9a, 0xed}, root{0x9f, 0xef}, add{0xa0, 0xf0}, subtract{0xa1, 0xf1},
      multiply{0xa2, 0xf2}, divide{0xa3, 0xf3};
  // instructions of lanes alone
  static constexpr unsigned char lanes_const = 0x0c, splat = 0x14, extract_lane = 0x21, replace_lane = 0x22,
                                 lanes_not = 0x4d, lanes_or = 0x50, bitselect = 0x52, any_true = 0x53, bitmask = 0xc4,
                                 larger_of = 0xf7;
  static constexpr std::size_t carried = 0, steps = 1, varying = 2, failed = 3, first_mask = 4;  // local variables

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
  void of_lanes(unsigned char code) {
    code_.push_back(0xfd);
    unsigned_number(code_, code);
  }
  void emit(const Both& code) {
    if (in_lanes_) return of_lanes(code.of_lanes);
    code_.push_back(code.of_number);
  }
  void with_number(Code code, std::size_t x) {
    code_.push_back(code);
    unsigned_number(code_, x);
  }
  void whole(Code code, std::int64_t x) {  // a constant in signed LEB128
    code_.push_back(code);
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
    const auto bits = std::bit_cast<std::uint64_t>(x);
    if (in_lanes_) {
      of_lanes(lanes_const);
    } else {
      code_.push_back(f64_const);
    }
    for (int lane = 0; lane < (in_lanes_ ? 2 : 1); ++lane) {
      for (int shift = 0; shift < 64; shift += 8) code_.push_back(static_cast<unsigned char>(bits >> shift));
    }
  }
  void memory(const Both& code, std::size_t value) {  // 8-byte alignment, and the offset
    emit(code);
    code_.push_back(3);
    unsigned_number(code_, (in_lanes_ ? 16 : 8) * value);
  }
  void get(const Operand& operand) {
    switch (operand.kind) {
      case Operand::Kind::carried:
        return with_number(local_get, first_value_ + operand.index);
      case Operand::Kind::result:
        return with_number(local_get, first_value_ + program_.values() + operand.index);
      case Operand::Kind::constant:
        if (operand.index < uniform_) return constant(program_.constants[operand.index]);
        with_number(local_get, varying);
        return memory(load, operand.index - uniform_);
      case Operand::Kind::none:
        return constant(0);
    }
  }

  void operation(const Program::Operation& line) {
    const auto two = [&](const Both& code) {
      get(line.a);
      get(line.b);
      emit(code);
    };
    const auto one = [&](const Both& code) {
      get(line.a);
      emit(code);
    };
    switch (line.instruction) {
      case Operation::add:
        return two(add);
      case Operation::subtract:
        return two(subtract);
      case Operation::multiply:
        return two(multiply);
      case Operation::divide:
        return two(divide);
      case Operation::negate:
        return one(negate);
      case Operation::abs:
        return one(abs);
      case Operation::sqrt:
        return one(root);
      case Operation::larger:
        if (in_lanes_) return get(line.a), get(line.b), of_lanes(larger_of);
        get(line.b);
        get(line.a);
        compared(line.a, line.b, less);
        return emit({select});
      case Operation::choose: {
        get(line.b);
        get(line.c);
        get(line.a);
        constant(0);
        emit(greater);
        return in_lanes_ ? of_lanes(bitselect) : emit({select});
      }
      case Operation::of_lane:
        return get(line.a);  // a single number is the only lane
      default:
        return call(line);
    }
  }
  void compared(const Operand& a, const Operand& b, const Both& code) {
    get(a);
    get(b);
    emit(code);
  }
  /// Calls a function of the C library, in lanes once for each of them.
  void call(const Program::Operation& line) {
    const auto of_one = native::function_of_one(line.instruction);
    const auto place = of_one ? reinterpret_cast<std::intptr_t>(of_one)
                              : reinterpret_cast<std::intptr_t>(native::function_of_two(line.instruction));
    for (unsigned char lane = 0; lane < (in_lanes_ ? 2 : 1); ++lane) {
      for (int k = 0; k < (of_one ? 1 : 2); ++k) {
        get(k == 0 ? line.a : line.b);
        if (in_lanes_) of_lanes(extract_lane), code_.push_back(lane);
      }
      whole(i32_const, place);
      emit({call_indirect, static_cast<unsigned char>(of_one ? 1 : 2), 0});
      if (in_lanes_) of_lanes(lane == 0 ? splat : replace_lane);
      if (lane == 1) code_.push_back(1);
    }
  }

  void not_held(const Program::Check& check) {
    using Kind = Program::Check::Kind;
    switch (check.kind) {
      case Kind::finite:  // x - x is NaN if x is not finite
        compared(check.a, check.a, subtract);
        constant(0);
        emit(equal);
        break;
      case Kind::equal:
        compared(check.a, check.b, equal);
        break;
      case Kind::unequal:
        compared(check.a, check.b, unequal);
        break;
      case Kind::less:
        compared(check.a, check.b, less);
        break;
      case Kind::not_less:
        return compared(check.a, check.b, less);
    }
    in_lanes_ ? of_lanes(lanes_not) : emit({i32_eqz});
  }
  /// Leaves the function with -1 if a check fails; in lanes it notes them. Checks are interleaved like values.
  void check(std::size_t number) {
    if (!in_lanes_) {
      not_held(program_.checks[number]);
      emit({if_true, no_result});
      whole(i64_const, -1);
      return emit({give_back, end});
    }
    const std::size_t mask = first_mask + number % locals_;
    with_number(local_get, mask);
    not_held(program_.checks[number]);
    of_lanes(lanes_or);
    with_number(local_set, mask);
  }

  void code() {
    const std::size_t values = program_.values();
    for (std::size_t k = 0; k < values; ++k) {
      with_number(local_get, carried);
      memory(load, k);
      with_number(local_set, first_value_ + k);
    }
    emit({block, no_result, loop, no_result});
    with_number(local_get, steps);
    emit({i64_eqz, br_if, 1});
    for (std::size_t i = 0; i < program_.operations.size(); ++i) {
      operation(program_.operations[i]);
      with_number(local_set, first_value_ + values + i);
    }
    for (std::size_t i = 0; i < program_.checks.size(); ++i) check(i);
    for (const Operand& output : program_.outputs) get(output);  // all of them first: outputs may permute values
    for (std::size_t k = values; k-- > 0;) with_number(local_set, first_value_ + k);
    with_number(local_get, steps);
    whole(i64_const, 1);
    emit({i64_sub});
    with_number(local_set, steps);
    for (std::size_t i = 0; i < program_.ends_at.size(); ++i) {
      with_number(local_get, first_value_ + program_.ends_at[i]);
      constant(0);
      emit(unequal);
      if (in_lanes_) of_lanes(any_true);
      if (i > 0) emit({i32_or});
    }
    if (!program_.ends_at.empty()) emit({br_if, 1});
    emit({br, 0, end, end});
    for (std::size_t k = 0; k < values; ++k) {
      with_number(local_get, carried);
      with_number(local_get, first_value_ + k);
      memory(store, k);
    }
    for (std::size_t mask = first_mask; mask < first_value_; mask += 2) {
      with_number(local_get, failed);
      with_number(local_get, mask);
      of_lanes(bitmask);
      with_number(local_get, mask + 1);
      of_lanes(bitmask);
      whole(i32_const, 2);
      emit({i32_shift, i32_or, store_i32, 2});
      unsigned_number(code_, 4 * (mask - first_mask));
    }
    with_number(local_get, steps);
    emit({end});
  }

  const Program& program_;
  bool in_lanes_;
  std::size_t locals_;
  std::size_t uniform_;
  unsigned char number_type_;
  std::size_t first_value_;
  Bytes code_;
};

/// The last functions that were made. The browser optimises a function while it runs, so that one that was made before
/// is faster than a new one.
class Made {
 public:
  std::shared_ptr<const ModuleFunction> find(const Bytes& bytes) {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const auto& each) { return each.first == bytes; });
    if (found == all_.end()) return nullptr;
    std::rotate(all_.begin(), found, found + 1);
    return all_.front().second;
  }
  void add(Bytes bytes, std::shared_ptr<const ModuleFunction> function) {
    constexpr std::size_t most = 32;
    all_.emplace_front(std::move(bytes), std::move(function));
    if (all_.size() > most) all_.pop_back();
  }

 private:
  std::deque<std::pair<Bytes, std::shared_ptr<const ModuleFunction>>> all_;
};

}  // namespace

ModuleFunction::~ModuleFunction() { hamflow_forget(place_); }

std::shared_ptr<const ModuleFunction> module_function(const Program& program, Local local, std::size_t locals,
                                                      std::size_t uniform) {
  const auto needs_lanes = [](const auto& line) { return line.instruction == Operation::of_lane; };
  if (program.values() + program.operations.size() > most_locals) return nullptr;
  if (local == Local::two_lanes && std::any_of(program.operations.begin(), program.operations.end(), needs_lanes)) {
    return nullptr;
  }
  static Made made;
  Bytes bytes = Encoder(program, local, locals, uniform).module();
  if (auto known = made.find(bytes)) return known;
  const int place = hamflow_compile(bytes.data(), static_cast<int>(bytes.size()));
  if (place == 0) return nullptr;
  auto function = std::make_shared<const ModuleFunction>(place);
  made.add(std::move(bytes), function);
  return function;
}

}  // namespace hamflow::native
