// Records the arithmetic of a problem's member templates. A call with S = Trace<R> records a straight-line program,
// from which the Taylor coefficients of a motion are computed (detail/numerics/taylor_series.hpp).
// [GriewankWalther2008, ch. 2, 13]
//
// Constants are folded, common subexpressions are recorded once, and operations that no output needs are dropped: dual
// numbers over Trace, which differentiate a Hamiltonian without a gradient, produce many zeros and ones. A
// straight-line program cannot branch on the state: < and abs throw. A test for equality (a case of measure zero, such
// as p_phi = 0) takes the branch of the recorded state and adds a guard, which detects a later state that would take
// the other branch.
//
// An exact recording (Folding::exact) gives the same bits as numbers of type R, including the signs of zeros: no
// simplification changes a bit for any input, pow is the library's function, and every comparison adds a guard.
// Recorded steps are made this way (src/engine/recorded_step.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hamflow/core/dual.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

/// For functions with one operand, b is the node that their Taylor coefficients need: the cosine for sin, sinh for cosh
/// and vice versa, the square of the node itself for tan and tanh, the square of the operand for atan.
struct TapeNode {
  Operation operation;
  int a = -1;         // nodes
  int b = -1;         // may be a later node if only its lower coefficients are used
  int constant = -1;  // its index among the constants
  int c = -1;         // a third node
};

/// The operations that lead from the inputs, which are the first nodes, to the outputs.
template <class R>
struct Tape {
  enum class Relation { equal, less, greater };
  struct Guard {
    int node;
    R value;
    bool holds;  // whether the relation of node to value holds at the recording
    Relation relation = Relation::equal;
  };
  std::size_t inputs = 0;
  std::vector<TapeNode> nodes;
  std::vector<R> constants;
  std::vector<int> outputs;
  std::vector<Guard> guards;
};

namespace detail {
/// Equal in value and in every derivative. A NaN equals nothing.
template <class T>
bool identical(const T& a, const T& b) {
  if constexpr (IsDual<T>::value) {
    if (!identical(a.value, b.value)) return false;
    for (std::size_t k = 0; k < a.slope.size(); ++k) {
      if (!identical(a.slope[k], b.slope[k])) return false;
    }
    return true;
  } else {
    return a <= b && b <= a;
  }
}
}  // namespace detail

/// The computation is not a straight-line program.
struct CannotRecord : Error {
  using Error::Error;
};

template <class R>
class Recorder;

enum class Folding { usual, exact };

/// A number that remembers how it was computed: a constant, or a node of the recording.
template <class R>
struct Trace {
  R value{};
  Recorder<R>* recorder = nullptr;
  int node = -1;

  Trace() = default;
  template <class U>
  requires(std::is_convertible_v<U, R> || (std::is_arithmetic_v<U> && std::is_constructible_v<R, U>))
      Trace(const U& constant)
      : value(static_cast<R>(constant)) {}  // NOLINT: a constant is a trace
  Trace(const R& v, Recorder<R>* r, int at) : value(v), recorder(r), node(at) {}

  bool is_constant() const { return recorder == nullptr; }
  bool is_exactly(int c) const { return is_constant() && detail::identical(value, R(c)); }

  Trace& operator+=(const Trace& b) { return *this = *this + b; }
  Trace& operator-=(const Trace& b) { return *this = *this - b; }
  Trace& operator*=(const Trace& b) { return *this = *this * b; }
  Trace& operator/=(const Trace& b) { return *this = *this / b; }

  // Friends, so that constants of any type are converted.
  friend Trace operator+(const Trace& a, const Trace& b) { return sum(a, b); }
  friend Trace operator-(const Trace& a, const Trace& b) { return difference(a, b); }
  friend Trace operator-(const Trace& a) { return negative(a); }
  friend Trace operator*(const Trace& a, const Trace& b) { return product(a, b); }
  friend Trace operator/(const Trace& a, const Trace& b) { return quotient(a, b); }
  friend bool operator==(const Trace& a, const Trace& b) { return are_equal(a, b); }
  friend bool operator<(const Trace& a, const Trace& b) { return is_less(a, b); }
  friend bool operator>(const Trace& a, const Trace& b) { return is_less(b, a); }
  friend bool operator<=(const Trace& a, const Trace& b) { return !is_greater(a, b); }
  friend bool operator>=(const Trace& a, const Trace& b) { return !is_greater(b, a); }

  /// Whether this trace belongs to an exact recording.
  bool is_exact() const { return recorder != nullptr && recorder->is_exact(); }

  [[noreturn]] static void refuse() {
    throw CannotRecord(
        "H has branches that depend on the state (a comparison or abs), which taylor cannot differentiate; use dop853");
  }

 private:
  using Relation = typename Tape<R>::Relation;
  // Not inline: a program that uses many traces instantiates them once (extern template, src/engine/erased.hpp).
  static Trace sum(const Trace& a, const Trace& b);
  static Trace difference(const Trace& a, const Trace& b);
  static Trace negative(const Trace& a);
  static Trace product(const Trace& a, const Trace& b);
  static Trace quotient(const Trace& a, const Trace& b);
  static bool are_equal(const Trace& a, const Trace& b);
  static bool is_less(const Trace& a, const Trace& b);
  static bool is_greater(const Trace& a, const Trace& b);
  static void ordered(const Trace& a, const Trace& b);
  static bool compared(const Trace& a, const Trace& b, Relation relation, bool holds);
};

template <class R>
struct BaseScalar<Trace<R>> {
  using type = typename BaseScalar<R>::type;
};
/// The trace itself, since comparisons have to be recorded.
template <class R>
Trace<R> value_of(const Trace<R>& x) {
  return x;
}

/// Records the operations, with the values at one state.
template <class R>
class Recorder {
 public:
  explicit Recorder(Folding folding = Folding::usual, std::size_t most_nodes = static_cast<std::size_t>(-1))
      : exact_(folding == Folding::exact), most_nodes_(most_nodes) {}
  bool is_exact() const { return exact_; }
  /// Removes all nodes and keeps the memory.
  void clear() {
    tape_.inputs = 0;
    tape_.nodes.clear();
    tape_.constants.clear();
    tape_.outputs.clear();
    tape_.guards.clear();
    values_.clear();
    std::fill(known_.begin(), known_.end(), 0);
    entries_ = 0;
  }

  Trace<R> input(const R& value) {
    ++tape_.inputs;
    return push({.operation = Operation::symbol}, value);
  }
  [[gnu::noinline]] Trace<R> of_two(Operation operation, int a, int b, const R& value) {
    if ((operation == Operation::add || operation == Operation::multiply) && b < a) std::swap(a, b);
    return once({.operation = operation, .a = a, .b = b}, value);
  }
  [[gnu::noinline]] Trace<R> with_constant(Operation operation, int a, const R& c, const R& value) {
    return once({.operation = operation, .a = a, .b = -1, .constant = constant(c)}, value);
  }
  /// Two functions that are derivatives of each other (up to sign). @return the first
  [[gnu::noinline]] Trace<R> pair(Operation first, Operation second, int a, const R& value1, const R& value2) {
    const int at = size();
    const Trace<R> found = once({.operation = first, .a = a, .b = at + 1}, value1);
    if (found.node == at) push({.operation = second, .a = a, .b = at}, value2);
    return found;
  }
  Trace<R> second_of_pair(const Trace<R>& first) {
    return {values_[static_cast<std::size_t>(first.node) + 1], this, first.node + 1};
  }
  /// y(a), whose derivative is a function of y^2.
  [[gnu::noinline]] Trace<R> with_square(Operation operation, int a, const R& value) {
    const int at = size();
    const Trace<R> y = once({.operation = operation, .a = a, .b = at + 1}, value);
    if (y.node == at) push({.operation = Operation::square, .a = at}, R(value * value));
    return y;
  }
  /// A function of two numbers, one of which may be constant.
  [[gnu::noinline]] Trace<R> of_any_two(Operation operation, const Trace<R>& a, const Trace<R>& b, const R& value) {
    return of_two(operation, node_of(a), node_of(b), value);
  }
  /// a > 0 ? b : c for a node a.
  [[gnu::noinline]] Trace<R> choice(int a, const Trace<R>& b, const Trace<R>& c, const R& value) {
    return once({.operation = Operation::choose, .a = a, .b = node_of(b), .constant = -1, .c = node_of(c)}, value);
  }
  [[gnu::noinline]] void guard(int node, const R& value, bool holds, typename Tape<R>::Relation relation) {
    tape_.guards.push_back({node, value, holds, relation});
  }

  /// Returns the tape that computes the outputs, without operations that they do not need.
  Tape<R> finish(const std::vector<Trace<R>>& outputs) {
    for (const Trace<R>& output : outputs) {
      tape_.outputs.push_back(
          output.is_constant()
              ? push({.operation = Operation::number, .constant = constant(output.value)}, output.value).node
              : output.node);
    }
    drop_unused();
    return std::move(tape_);
  }

 private:
  int node_of(const Trace<R>& x) {
    return x.is_constant() ? push({.operation = Operation::number, .constant = constant(x.value)}, x.value).node
                           : x.node;
  }
  int size() const { return static_cast<int>(tape_.nodes.size()); }
  TapeNode& node(int i) { return tape_.nodes[static_cast<std::size_t>(i)]; }

  Trace<R> push(const TapeNode& n, const R& value) {
    if (tape_.nodes.size() >= most_nodes_) throw CannotRecord("a recording is longer than allowed");
    tape_.nodes.push_back(n);
    values_.push_back(value);
    return {value, this, size() - 1};
  }
  /// Records the same operation on the same operands only once. A companion (a node b after the node itself) is
  /// determined by a, so it is not part of the key.
  Trace<R> once(const TapeNode& n, const R& value) {
    const bool companion = n.b >= size();
    if (known_.size() < 2 * (entries_ + 1)) enlarge();
    std::size_t at = place_of(n, companion);
    for (; known_[at] != 0; at = (at + 1) & (known_.size() - 1)) {
      const int i = known_[at] - 1;
      const TapeNode& old = node(i);
      if (old.operation == n.operation && old.a == n.a && (companion || old.b == n.b) && old.constant == n.constant &&
          old.c == n.c) {
        return {values_[static_cast<std::size_t>(i)], this, i};
      }
    }
    known_[at] = size() + 1;
    ++entries_;
    return push(n, value);
  }
  /// The index at which the search in the table of known nodes begins.
  std::size_t place_of(const TapeNode& n, bool companion) const {
    std::uint64_t key =
        (static_cast<std::uint64_t>(n.a) * 1000003U + static_cast<std::uint64_t>(companion ? -1 : n.b)) * 64U +
        static_cast<std::uint64_t>(n.operation);
    key *= 0x9e3779b97f4a7c15U;
    return static_cast<std::size_t>(key >> 32) & (known_.size() - 1);
  }
  void enlarge() {
    const std::vector<int> old = std::move(known_);
    known_.assign(std::max<std::size_t>(64, 2 * old.size()), 0);
    for (const int entry : old) {
      if (entry == 0) continue;
      const TapeNode& n = node(entry - 1);
      std::size_t at = place_of(n, n.b >= entry);  // a companion comes after its node
      while (known_[at] != 0) at = (at + 1) & (known_.size() - 1);
      known_[at] = entry;
    }
  }
  int constant(const R& value) {
    const std::size_t count = tape_.constants.size();
    if (exact_) {
      tape_.constants.push_back(value);
      return static_cast<int>(count);
    }
    // Few constants occur many times; in a long list (n masses) only the last ones are compared.
    for (std::size_t i = count; i > 0 && i + 64 > count; --i) {
      if (detail::identical(tape_.constants[i - 1], value)) return static_cast<int>(i - 1);
    }
    tape_.constants.push_back(value);
    return static_cast<int>(count);
  }

  void drop_unused() {
    std::vector<int> place(tape_.nodes.size(), -1);
    std::vector<int> open = tape_.outputs;
    for (const auto& guard : tape_.guards) open.push_back(guard.node);
    for (std::size_t i = 0; i < tape_.inputs; ++i) open.push_back(static_cast<int>(i));
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      if (i < 0 || place[static_cast<std::size_t>(i)] == 0) continue;
      place[static_cast<std::size_t>(i)] = 0;
      open.push_back(node(i).a);
      open.push_back(node(i).b);
      open.push_back(node(i).c);
    }
    int kept = 0;
    for (int& at : place) {
      if (at == 0) at = kept++;
    }
    const auto moved = [&](int i) { return i < 0 ? i : place[static_cast<std::size_t>(i)]; };
    for (std::size_t i = 0; i < tape_.nodes.size(); ++i) {
      if (place[i] < 0) continue;
      TapeNode n = tape_.nodes[i];
      n.a = moved(n.a);
      n.b = moved(n.b);
      n.c = moved(n.c);
      node(place[i]) = n;
    }
    tape_.nodes.resize(static_cast<std::size_t>(kept));
    for (int& output : tape_.outputs) output = moved(output);
    for (auto& guard : tape_.guards) guard.node = moved(guard.node);
  }

  bool exact_;
  std::size_t most_nodes_;
  Tape<R> tape_;
  std::vector<R> values_;
  std::vector<int> known_;  // hash table of nodes + 1, 0: free; the size is a power of two
  std::size_t entries_ = 0;
};

template <class R>
Trace<R> Trace<R>::sum(const Trace& a, const Trace& b) {
  if (a.is_constant() && b.is_constant()) return Trace(R(a.value + b.value));
  if (a.is_exactly(0) && !b.is_exact()) return b;
  if (b.is_exactly(0) && !a.is_exact()) return a;
  const R value = a.value + b.value;
  if (a.is_constant()) return b.recorder->with_constant(Operation::add_constant, b.node, a.value, value);
  if (b.is_constant()) return a.recorder->with_constant(Operation::add_constant, a.node, b.value, value);
  return a.recorder->of_two(Operation::add, a.node, b.node, value);
}
template <class R>
Trace<R> Trace<R>::difference(const Trace& a, const Trace& b) {
  if (b.is_constant()) return a + Trace(R(-b.value));
  if (a.is_constant()) return a + -b;
  return a.recorder->of_two(Operation::subtract, a.node, b.node, R(a.value - b.value));
}
template <class R>
Trace<R> Trace<R>::negative(const Trace& a) {
  if (a.is_constant()) return Trace(R(-a.value));
  return a.recorder->of_two(Operation::negate, a.node, -1, R(-a.value));
}
template <class R>
Trace<R> Trace<R>::product(const Trace& a, const Trace& b) {
  if (a.is_constant() && b.is_constant()) return Trace(R(a.value * b.value));
  if (a.is_constant()) return b * a;
  if (b.is_exactly(0) && !a.is_exact()) return Trace(R(0));
  if (b.is_exactly(1) && !a.is_exact()) return a;
  if (b.is_exactly(-1) && !a.is_exact()) return -a;
  const R value = a.value * b.value;
  if (b.is_constant()) return a.recorder->with_constant(Operation::scale, a.node, b.value, value);
  if (a.node == b.node) return a.recorder->of_two(Operation::square, a.node, -1, value);
  return a.recorder->of_two(Operation::multiply, a.node, b.node, value);
}
template <class R>
Trace<R> Trace<R>::quotient(const Trace& a, const Trace& b) {
  if (a.is_constant() && b.is_constant()) return Trace(R(a.value / b.value));
  if (a.is_exactly(0) && !b.is_exact()) return Trace(R(0));
  if (b.is_exactly(1) && !a.is_exact()) return a;
  const R value = a.value / b.value;
  if (a.is_constant()) return b.recorder->with_constant(Operation::invert, b.node, a.value, value);
  if (b.is_constant()) return a.recorder->with_constant(Operation::divide_constant, a.node, b.value, value);
  return a.recorder->of_two(Operation::divide, a.node, b.node, value);
}
template <class R>
bool Trace<R>::are_equal(const Trace& a, const Trace& b) {
  return compared(a, b, Relation::equal, a.value <= b.value && b.value <= a.value);
}
template <class R>
bool Trace<R>::is_less(const Trace& a, const Trace& b) {
  ordered(a, b);
  return compared(a, b, Relation::less, a.value < b.value);
}
/// True also if the numbers are unordered (NaN).
template <class R>
bool Trace<R>::is_greater(const Trace& a, const Trace& b) {
  ordered(a, b);
  return compared(a, b, Relation::greater, !(a.value <= b.value));
}
template <class R>
void Trace<R>::ordered(const Trace& a, const Trace& b) {
  if (!(a.is_constant() || a.is_exact()) || !(b.is_constant() || b.is_exact())) refuse();
}
/// The result at the recording, with a guard for later states. The sign of the difference decides the comparison,
/// because a difference is 0 only for equal numbers.
template <class R>
bool Trace<R>::compared(const Trace& a, const Trace& b, Relation relation, bool holds) {
  if (a.is_constant() && b.is_constant()) return holds;
  if (b.is_constant()) {
    a.recorder->guard(a.node, b.value, holds, relation);
  } else if (a.is_constant()) {
    const Relation turned = relation == Relation::equal  ? Relation::equal
                            : relation == Relation::less ? Relation::greater
                                                         : Relation::less;
    b.recorder->guard(b.node, a.value, holds, turned);
  } else {
    const Trace off = a - b;
    if (!off.is_constant()) off.recorder->guard(off.node, R(0), holds, relation);
  }
  return holds;
}

namespace detail {
/// f of a constant is computed at once; otherwise it is a new node.
template <class R, class F>
Trace<R> recorded(Operation operation, const Trace<R>& x, F&& f) {
  const R value = f(x.value);
  if (x.is_constant()) return Trace<R>(value);
  return x.recorder->of_two(operation, x.node, -1, value);
}
/// A function of two numbers, at least one of which is not constant.
template <class R>
Trace<R> recorded(Operation operation, const Trace<R>& a, const Trace<R>& b, const R& value) {
  return (a.is_constant() ? b : a).recorder->of_any_two(operation, a, b, value);
}
}  // namespace detail

template <class R>
Trace<R> sqrt(const Trace<R>& x) {
  return detail::recorded(Operation::sqrt, x, [](const R& v) { return R(sqrt(v)); });
}
template <class R>
Trace<R> exp(const Trace<R>& x) {
  return detail::recorded(Operation::exp, x, [](const R& v) { return R(exp(v)); });
}
template <class R>
Trace<R> log(const Trace<R>& x) {
  return detail::recorded(Operation::log, x, [](const R& v) { return R(log(v)); });
}
template <class R>
Trace<R> sin(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(sin(x.value)));
  return x.recorder->pair(Operation::sin, Operation::cos, x.node, R(sin(x.value)), R(cos(x.value)));
}
template <class R>
Trace<R> cos(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(cos(x.value)));
  return x.recorder->second_of_pair(sin(x));
}
template <class R>
Trace<R> sinh(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(sinh(x.value)));
  return x.recorder->pair(Operation::sinh, Operation::cosh, x.node, R(sinh(x.value)), R(cosh(x.value)));
}
template <class R>
Trace<R> cosh(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(cosh(x.value)));
  return x.recorder->second_of_pair(sinh(x));
}
template <class R>
Trace<R> tan(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(tan(x.value)));
  return x.recorder->with_square(Operation::tan, x.node, R(tan(x.value)));
}
template <class R>
Trace<R> tanh(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(tanh(x.value)));
  return x.recorder->with_square(Operation::tanh, x.node, R(tanh(x.value)));
}
template <class R>
Trace<R> atan(const Trace<R>& x) {
  if (x.is_constant()) return Trace<R>(R(atan(x.value)));
  return x.recorder->of_two(Operation::atan, x.node, (x * x).node, R(atan(x.value)));
}
/// x^y for a constant exponent; integer powers are products, so that x may be 0.
template <class R>
Trace<R> pow(const Trace<R>& x, const base_scalar<R>& y) {
  if (x.is_constant()) return Trace<R>(R(pow(x.value, y)));
  if (x.is_exact()) return x.recorder->with_constant(Operation::power_constant, x.node, R(y), R(pow(x.value, y)));
  const double exponent = static_cast<double>(y);
  const int whole = exponent >= -64 && exponent <= 64 ? static_cast<int>(exponent) : 0;
  if (detail::identical(y, base_scalar<R>(whole))) {
    return whole_power(x, whole);
  }
  return x.recorder->with_constant(Operation::power_constant, x.node, R(y), R(pow(x.value, y)));
}
template <class R>
Trace<R> abs(const Trace<R>& x) {
  if (x.is_exact()) return detail::recorded(Operation::abs, x, [](const R& v) { return R(abs(v)); });
  if (!x.is_constant()) Trace<R>::refuse();
  return Trace<R>(R(abs(x.value)));
}
/// a < b ? b : a; an exact recording computes it without a branch.
template <class R>
Trace<R> larger(const Trace<R>& a, const Trace<R>& b) {
  if (a.is_exact() || b.is_exact()) return detail::recorded(Operation::larger, a, b, larger(a.value, b.value));
  return a < b ? b : a;
}
/// a > 0 ? b : c; an exact recording computes both b and c, without a branch.
template <class R>
Trace<R> choose(const Trace<R>& a, const Trace<R>& b, const Trace<R>& c) {
  const bool first = R(0) < a.value;
  if (a.is_constant()) return first ? b : c;
  if (!a.is_exact()) Trace<R>::refuse();
  return a.recorder->choice(a.node, b, c, first ? b.value : c.value);
}
/// Exact recordings record the function itself; for Taylor coefficients it is composed of other functions.
template <class R>
Trace<R> asin(const Trace<R>& x) {
  if (!x.is_constant() && !x.is_exact()) return atan(x / sqrt((Trace<R>(R(1)) - x) * (Trace<R>(R(1)) + x)));
  return detail::recorded(Operation::asin, x, [](const R& v) { return R(asin(v)); });
}
template <class R>
Trace<R> acos(const Trace<R>& x) {
  const Trace<R> one(R(1));
  if (!x.is_constant() && !x.is_exact()) return Trace<R>(R(2)) * atan(sqrt((one - x) / (one + x)));
  return detail::recorded(Operation::acos, x, [](const R& v) { return R(acos(v)); });
}
/// The angle of (x, y), by one of the two half-angle formulas, chosen by the state at the recording. Both give the same
/// function unless one divides by 0; the guard of a test for equality detects this, and the function is recorded again.
template <class R>
Trace<R> atan2(const Trace<R>& y, const Trace<R>& x) {
  const R value = atan2(y.value, x.value);
  if (y.is_constant() && x.is_constant()) return Trace<R>(value);
  if (y.is_exact() || x.is_exact()) return detail::recorded(Operation::atan2, y, x, value);
  const Trace<R> two(R(2));
  const Trace<R> r = sqrt(x * x + y * y);
  const Trace<R> sum = r + x;
  if (!(x.value < R(0)) && !(sum == Trace<R>(R(0)))) return two * atan(y / sum);
  if (y == Trace<R>(R(0))) return Trace<R>(pi_value<R>()) + two * atan(y / (x - r));  // the other half-angle formula
  return two * atan((r - x) / y);
}
template <class R>
Trace<R> pow(const Trace<R>& x, const Trace<R>& y) {
  if (y.is_constant() && !y.is_exact()) return pow(x, y.value);
  if (!x.is_exact() && !y.is_exact()) return exp(y * log(x));
  return detail::recorded(Operation::power, x, y, R(pow(x.value, y.value)));
}

#define HAMFLOW_TRACE_OF_known(name)
#define HAMFLOW_TRACE_OF_unknown(name)                                                  \
  template <class R>                                                                    \
  Trace<R> name(const Trace<R>& x) {                                                    \
    if (!x.is_constant() && !x.is_exact()) Trace<R>::refuse();                          \
    return detail::recorded(Operation::name, x, [](const R& v) { return R(name(v)); }); \
  }
#define HAMFLOW_TRACE_OF(name, symmetry, rule, series) HAMFLOW_TRACE_OF_##series(name)
HAMFLOW_FUNCTIONS(HAMFLOW_TRACE_OF)
#undef HAMFLOW_TRACE_OF
#undef HAMFLOW_TRACE_OF_unknown
#undef HAMFLOW_TRACE_OF_known

}  // namespace hamflow

/// Limits and epsilon are those of the recorded number type.
template <class R>
struct std::numeric_limits<hamflow::Trace<R>> : std::numeric_limits<R> {};
