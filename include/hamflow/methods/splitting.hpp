// The kernel of every explicit splitting method for H = T(p) + V(q): alternating kicks and drifts from a table.
//     kick c:  p <- p - c h V'(q)          drift d:  q <- q + d h T'(p)
// One kernel serves all tables, both orders (kick first, drift first) and every arithmetic. Neighbouring kicks of a
// composition are merged, and a step that begins and ends with a kick keeps the last force for the next step, so that
// no force is computed twice. Kicks of two *steps* are not merged, because advance(1000) must give the bits of 1000
// calls of advance(1). A problem with scaled_force and scaled_velocity gets the factors c h and d h as arguments; a
// multiplication afterwards would lengthen the chain of dependent operations between two forces. On an integer lattice,
// forces between pairs are rounded and summed pair by pair (pair_sums.hpp). The kick is then kept as integers; if the
// last kick of a table differs from the first, it is computed again.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/methods/pair_sums.hpp"
#include "hamflow/methods/tables.hpp"

namespace hamflow {

/// The order of actions in one step.
enum class Shape {
  kick_drift_kick,   // K D ... D K with equal ends: the next step reuses the last force
  drift_kick_drift,  // D K ... K D
  kick_drift,        // K D ... K D
  drift_kick,        // D K ... D K
  any                // one of these, known at run time
};

/// @param ends_alike whether the first and the last action have the same coefficient
constexpr Shape shape_of(bool kick_first, bool kick_last, bool ends_alike) {
  if (!kick_first) return kick_last ? Shape::drift_kick : Shape::drift_kick_drift;
  if (!kick_last) return Shape::kick_drift;
  return ends_alike ? Shape::kick_drift_kick : Shape::any;
}

/// The coefficients of one step in the order in which they act, in the working arithmetic.
template <class R>
struct SplittingSequence {
  StartsWith starts_with;
  std::vector<R> coefficients;

  bool kick_first() const { return starts_with == StartsWith::kick; }
  bool kick_last() const { return kick_first() == (coefficients.size() % 2 == 1); }
  bool ends_alike() const { return coefficients.front() == coefficients.back(); }
  Shape shape() const { return shape_of(kick_first(), kick_last(), ends_alike()); }
};

/// gamma_1 .. gamma_s of a symmetric composition.
template <class R>
std::vector<R> composition_weights(const CompositionTable& table) {
  const auto half = static_cast<std::size_t>(table.half_count());
  std::vector<R> gamma(2 * half + 1);
  R sum(0);
  for (std::size_t i = 0; i < half; ++i) {
    const bool any_digits = std::numeric_limits<R>::digits == 0 && !table.closed_half[i].empty();
    gamma[i] = gamma[2 * half - i] = evaluate_number<R>(any_digits ? table.closed_half[i] : table.half[i]);
    sum += gamma[i];
  }
  gamma[half] = R(1) - R(2) * sum;
  return gamma;
}

/// A composition of Stoermer-Verlet steps with neighbouring half actions joined; palindromic bit for bit.
template <class R>
SplittingSequence<R> sequence_of(const CompositionTable& table, StartsWith starts_with) {
  const std::vector<R> gamma = composition_weights<R>(table);
  std::vector<R> c{gamma.front() / R(2)};
  for (std::size_t i = 0; i < gamma.size(); ++i) {
    c.push_back(gamma[i]);
    c.push_back(i + 1 < gamma.size() ? (gamma[i] + gamma[i + 1]) / R(2) : gamma[i] / R(2));
  }
  return {starts_with, c};
}

template <class R>
SplittingSequence<R> sequence_of(const SplittingTable& table) {
  std::vector<R> c;
  for (int i = 0; i < table.count(); ++i) c.push_back(evaluate_number<R>(table.coefficient(i)));
  return {table.starts_with, c};
}

inline MethodInfo describe(const CompositionTable& table, StartsWith starts_with) {
  const bool kick_first = starts_with == StartsWith::kick;
  return {.name = std::string(table.name) + (kick_first ? "" : "-dkd"),
          .summary = "composition of " + std::to_string(table.stages()) + " Stoermer-Verlet step" +
                     (table.stages() > 1 ? "s, " : ", ") + (kick_first ? "kick first" : "drift first"),
          .reference = std::string(table.reference),
          .order = table.order,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .forces_per_step = table.stages()};
}

inline MethodInfo describe(const SplittingTable& table) {
  const auto sequence = sequence_of<double>(table);
  const int kicks = (table.count() + (table.starts_with == StartsWith::kick ? 1 : 0)) / 2;
  return {.name = std::string(table.name),
          .summary = std::string("splitting, ") +
                     (table.starts_with == StartsWith::kick ? "kick first" : "drift first") +
                     (table.nystroem ? ", for T quadratic in p with constant mass matrix" : ""),
          .reference = std::string(table.reference),
          .order = table.order,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = table.symmetric,
          .reversible = table.symmetric,
          .forces_per_step = sequence.kick_first() && sequence.kick_last() ? kicks - 1 : kicks};
}

inline constexpr int any_length = 0;

/// The type of the step size: a plain number, or A::Length if steps of any length are recorded.
template <class A>
struct StepLengthOf {
  using type = base_scalar<typename A::Real>;
};
template <class A>
requires requires { typename A::Length; }
struct StepLengthOf<A> {
  using type = typename A::Length;
};

/// If an addition has two halves (arithmetic/compensated.hpp), the second half is deferred until the next force is
/// computed. The operations are the same, but come after those of the force in program order, so that they do not
/// compete with operations on which the next force depends.
template <Arithmetic A, std::size_t n>
struct DeferredAdditions {
  Vector<typename A::Axis::Pending, n> q{};
  Vector<typename A::Axis::Pending, n> p{};

  [[gnu::always_inline]] static void add(const auto& value, Vector<typename A::Stored, n>& to,
                                         Vector<typename A::Axis::Pending, n>& pending) {
    for (std::size_t i = 0; i < n; ++i) pending[i] = A::Axis::begin(to[i], value(i));
  }
  [[gnu::always_inline]] void settle(PhasePoint<A, n>& z) const {
    for (std::size_t i = 0; i < n; ++i) {
      A::Axis::settle(z.q[i], q[i]);
      A::Axis::settle(z.p[i], p[i]);
    }
  }
};
struct NoDeferredAdditions {};

/// One step of a splitting method.
/// @tparam Links number of drifts in a step if known at compile time (the loop is then unrolled), else any_length
template <class P, Arithmetic A, Shape shape, int Links = any_length>
class Splitting {
 public:
  static_assert(
      Separable<P>,
      "hamflow: a splitting method needs a Separable problem, H = T(p) + V(q): give kinetic(p) and potential(q), "
      "and for dynamic size velocity(p, v) and force(q, f). Methods that accept any differentiable H: euler, "
      "rk4");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  using Length = typename StepLengthOf<A>::type;
  static constexpr bool sums_integers = PairwiseForces<P> && IntegerSums<A>;

  Splitting(const SplittingSequence<Base>& sequence, MethodInfo (*describe_table)(const void*), const void* table)
      : info_(describe_table), table_(table) {
    const std::vector<Base>& c = sequence.coefficients;
    leading_ = sequence.kick_first();
    trailing_ = sequence.kick_last();
    ends_alike_ = !(leading_ && trailing_) || sequence.ends_alike();
    std::size_t i = 0;
    if (leading()) leading_kick_ = c[i++];
    for (; i < c.size(); i += 2) {
      if (count_ == capacity) throw Error("hamflow: a splitting table is longer than the capacity of the kernel");
      links_[count_++] = {c[i], i + 1 < c.size() ? c[i + 1] : Base(0)};
    }
  }

  /// Asks a problem behind virtual calls which scaled functions it has.
  void ask(const P& problem) {
    if constexpr (knows_at_run_time) {
      force_takes_factor_ = problem.has_scaled_force();
      velocity_takes_factor_ = problem.has_scaled_velocity();
    }
  }

  MethodInfo info() const { return info_(table_); }

  /// z <- Psi_h(z). It always returns `done`; a failure shows in the state. Always inlined into the loop over steps, so
  /// that state and kick stay in registers.
  [[gnu::always_inline]] Outcome step(const P& problem, const Length& h, PhasePoint<A, n>& z) {
    auto&& f = working_copy(kick_);
    [[maybe_unused]] std::conditional_t<defers, DeferredAdditions<A, n>, NoDeferredAdditions> late;
    if constexpr (n == dynamic) {
      if (f.size() == 0) f = zeros<Increment, n>(z.p.size());
    }
    if (leading()) {
      const Length factor = h * leading_kick_;
      if (!(trailing() && kick_is_current_ && kept_factor_ == within(factor))) evaluate(problem, factor, z, f);
      kick(factor, f, z, late);
    }
    const std::size_t count = Links == any_length ? count_ : static_cast<std::size_t>(Links);
#pragma GCC unroll 4
    for (std::size_t i = 0; i + 1 < count; ++i) {
      drift(problem, h * links_[i].drift, z, late);
      const Length factor = h * links_[i].kick;
      evaluate(problem, factor, z, f);
      if constexpr (defers) late.settle(z);
      kick(factor, f, z, late);
    }
    drift(problem, h * links_[count - 1].drift, z, late);
    if (trailing()) {
      const Length factor = h * links_[count - 1].kick;
      evaluate(problem, factor, z, f);
      if constexpr (defers) late.settle(z);
      last_kick(factor, f, z);
      if constexpr (n != dynamic) kick_ = f;
      kept_factor_ = within(factor);
      kick_is_current_ = true;
    } else if constexpr (defers) {
      late.settle(z);
    }
    return Outcome::done;
  }

  /// Call this if steps vary in length: the force is then kept without the factor, which differs from step to step.
  void keep_unscaled_force() { force_takes_factor_ = velocity_takes_factor_ = false; }

  /// Computes the kick with which the next step begins, if it is kept.
  void prepare(const P& problem, const Length& h, PhasePoint<A, n>& z) {
    const Length factor = h * leading_kick_;
    if (!(leading() && trailing()) || (kick_is_current_ && kept_factor_ == within(factor))) return;
    if constexpr (n == dynamic) {
      if (kick_.size() == 0) kick_ = zeros<Increment, n>(z.p.size());
    }
    evaluate(problem, factor, z, kick_);
    kept_factor_ = within(factor);
    kick_is_current_ = true;
  }
  static constexpr bool memory_depends_on_positions_only = true;
  /// Mirrors the kept kick after the i-th position was mirrored.
  void mirror_kept(std::size_t i) {
    if (i < kick_.size()) kick_[i] = -kick_[i];
  }
  /// Call this after the state was changed from outside. It clears the kept force, so that saved bytes do not depend
  /// on the history.
  void invalidate() {
    kick_is_current_ = false;
    for (Increment& x : kick_) x = Increment(0);
    kept_factor_ = Base(0);
  }
  /// Sets the number of threads for the forces; the bits do not depend on it.
  void use_threads(std::size_t count) requires sums_integers { sums_.use_threads(count); }
  Effort effort() const { return {.force = forces_}; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(kick_, kept_factor_, kick_is_current_, forces_);
  }

 private:
  using Increment = typename detail::PairSumsOf<P, A, sums_integers>::Increment;
  static constexpr bool of_any_length = !std::is_same_v<Length, Base>;  // the kept kick has no such factor
  static constexpr bool knows_at_run_time = requires(const P& problem) {
    problem.has_scaled_force();
    problem.has_scaled_velocity();
  };

  constexpr bool leading() const {
    if constexpr (shape == Shape::any) {
      return leading_;
    } else {
      return shape == Shape::kick_drift_kick || shape == Shape::kick_drift;
    }
  }
  constexpr bool trailing() const {
    if constexpr (shape == Shape::any) {
      return trailing_;
    } else {
      return shape == Shape::kick_drift_kick || shape == Shape::drift_kick;
    }
  }
  /// Whether f includes the factor of the kick; not if f serves two kicks of different strength.
  constexpr bool factor_within() const {
    if constexpr (sums_integers) {
      return true;
    } else if constexpr (!HasScaledForce<P, Length, Real>) {
      return false;
    } else if constexpr (knows_at_run_time) {
      return force_takes_factor_ && ends_alike_;
    } else if constexpr (shape == Shape::any) {
      return ends_alike_;
    } else {
      return true;
    }
  }
  constexpr bool drift_takes_factor() const {
    if constexpr (HasScaledVelocity<P, Length, Real> && knows_at_run_time) {
      return velocity_takes_factor_;
    } else {
      return HasScaledVelocity<P, Length, Real>;
    }
  }
  constexpr Base within(const Length& factor) const {
    if constexpr (of_any_length) {
      return Base(1);
    } else {
      return factor_within() ? factor : Base(1);
    }
  }
  static constexpr std::size_t capacity = Links == any_length ? SplittingTable::most : static_cast<std::size_t>(Links);
  struct Link {
    Base drift;
    Base kick;
  };

  /// f <- F(q), or factor F(q).
  [[gnu::always_inline]] void evaluate(const P& problem, [[maybe_unused]] const Length& factor, PhasePoint<A, n>& z,
                                       Vector<Increment, n>& f) {
    if constexpr (sums_integers) {
      if (!sums_.evaluate(problem, factor, z, f)) z.arithmetic.momentum.lost = true;
    } else if (factor_within()) {
      scaled_force(problem, factor, z.positions(), f);
    } else {
      force(problem, z.positions(), f);
    }
    ++forces_;
  }
  /// Whether second halves of additions are deferred. Every step then begins with a kick, so that there is always one
  /// to complete.
  static constexpr bool defers = std::is_floating_point_v<Real> && n != dynamic &&
                                 (shape == Shape::kick_drift_kick || shape == Shape::kick_drift) && requires {
    typename A::Axis::Pending;
  };
  [[gnu::always_inline]] void kick(const Length& factor, const Vector<Increment, n>& f, PhasePoint<A, n>& z,
                                   [[maybe_unused]] auto& late) const {
    if constexpr (sums_integers) {
      z.push(f);
    } else if constexpr (defers) {
      late.add([&](std::size_t i) { return factor_within() ? f[i] : Real(factor * f[i]); }, z.p, late.p);
    } else if (factor_within()) [[likely]] {  // otherwise the compiler makes it one multiplication, by factor or 1
      z.push(f);
    } else {
      z.push(factor, f);
    }
  }
  /// The last kick of a step; the first kick of the next step follows at once.
  [[gnu::always_inline]] void last_kick(const Length& factor, const Vector<Increment, n>& f,
                                        PhasePoint<A, n>& z) const {
    if constexpr (defers) {
      for (std::size_t i = 0; i < n; ++i)
        A::Axis::add_without_branch(z.p[i], factor_within() ? f[i] : Real(factor * f[i]));
    } else {
      NoDeferredAdditions nothing;
      kick(factor, f, z, nothing);
    }
  }
  [[gnu::always_inline]] void drift(const P& problem, const Length& factor, PhasePoint<A, n>& z,
                                    [[maybe_unused]] auto& late) const {
    Vector<Real, n> v = zeros<Real, n>(z.q.size());
    const bool scaled = drift_takes_factor();
    if (scaled) {
      scaled_velocity(problem, factor, z.momenta(), v);
    } else {
      velocity(problem, z.momenta(), v);
    }
    if constexpr (defers) {
      late.add([&](std::size_t i) { return scaled ? v[i] : Real(factor * v[i]); }, z.q, late.q);
    } else if (scaled) {
      z.move(v);
    } else {
      z.move(factor, v);
    }
  }
  /// Vectors stored in place are copied, to stay in registers; others are used by reference.
  [[gnu::always_inline]] static decltype(auto) working_copy(Vector<Increment, n>& kept) {
    if constexpr (n == dynamic) {
      return (kept);
    } else {
      return Vector<Increment, n>(kept);
    }
  }

  [[no_unique_address]] typename detail::PairSumsOf<P, A, sums_integers>::type sums_;
  Vector<Increment, n> kick_{};  // force of the last kick, kept_factor_ F(q)
  Base kept_factor_{};
  bool kick_is_current_ = false;
  bool force_takes_factor_ = true;  // for a problem behind virtual calls
  bool velocity_takes_factor_ = true;
  long long forces_ = 0;
  Base leading_kick_{};
  bool leading_ = false;  // for Shape::any: the first and the last action are kicks with the same coefficient
  bool trailing_ = false;
  bool ends_alike_ = true;
  std::size_t count_ = 0;
  std::array<Link, capacity> links_{};
  MethodInfo (*info_)(const void*);
  const void* table_;
};

namespace detail {
inline MethodInfo describe_kick_first(const void* table) {
  return describe(*static_cast<const CompositionTable*>(table), StartsWith::kick);
}
inline MethodInfo describe_drift_first(const void* table) {
  return describe(*static_cast<const CompositionTable*>(table), StartsWith::drift);
}
inline MethodInfo describe_splitting(const void* table) { return describe(*static_cast<const SplittingTable*>(table)); }
}  // namespace detail

// Recipes, see methods/recipe.hpp. Every kick and drift is one-to-one on a lattice.

/// A table of either kind, chosen at run time.
class AnySplitting {
 public:
  AnySplitting(const CompositionTable& table, StartsWith starts_with)
      : composition_(&table), starts_with_(starts_with) {}
  explicit AnySplitting(const SplittingTable& table) : splitting_(&table) {}

  template <class R>
  SplittingSequence<R> sequence() const {
    return splitting_ != nullptr ? sequence_of<R>(*splitting_) : sequence_of<R>(*composition_, starts_with_);
  }
  MethodInfo (*describe() const)(const void*) {
    if (splitting_ != nullptr) return detail::describe_splitting;
    return starts_with_ == StartsWith::kick ? detail::describe_kick_first : detail::describe_drift_first;
  }
  const void* table() const {
    return splitting_ != nullptr ? static_cast<const void*>(splitting_) : static_cast<const void*>(composition_);
  }
  /// Whether its order holds only for quadratic T.
  bool nystroem() const { return splitting_ != nullptr && splitting_->nystroem; }
  /// Whether the kicks and the drifts each sum to 1.
  bool is_consistent() const {
    std::array<double, 2> sums{};
    const std::vector<double> c = sequence<double>().coefficients;
    for (std::size_t i = 0; i < c.size(); ++i) sums[i % 2] += c[i];
    return adds_up_to_one(sums[0], sums[1]);
  }

 private:
  const CompositionTable* composition_ = nullptr;
  StartsWith starts_with_ = StartsWith::kick;
  const SplittingTable* splitting_ = nullptr;
};

/// Any table of one shape, with a length known at run time.
template <Shape shape>
struct TableRecipe {
  template <class P>
  static constexpr bool accepts = Separable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  static constexpr bool typed = true;
  static constexpr bool recorded = true;
  AnySplitting method;
  bool needs_quadratic_kinetic() const { return method.nystroem(); }
  TableRecipe<Shape::any> with_any_shape() const { return {method}; }
  template <class P, class A>
  using Stepper = Splitting<P, A, shape>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    if (!method.is_consistent()) {
      throw Error("hamflow: the kicks or the drifts of the table " + method.describe()(method.table()).name +
                  " do not add up to 1");
    }
    Stepper<P, A> stepper{method.sequence<typename Stepper<P, A>::Base>(), method.describe(), method.table()};
    stepper.ask(problem);
    return stepper;
  }
};

/// A composition chosen by type: the length of Composition<compositions::stv4> is known at compile time.
template <const CompositionTable& Table, StartsWith starts_with = StartsWith::kick>
struct Composition {
  template <class P>
  static constexpr bool accepts = Separable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  static constexpr bool kick_first = starts_with == StartsWith::kick;
  template <class P, class A>
  using Stepper = Splitting<P, A, kick_first ? Shape::kick_drift_kick : Shape::drift_kick_drift,
                            kick_first ? Table.stages() : Table.stages() + 1>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    using Base = typename Stepper<P, A>::Base;
    Stepper<P, A> stepper{sequence_of<Base>(Table, starts_with),
                          kick_first ? detail::describe_kick_first : detail::describe_drift_first, &Table};
    stepper.ask(problem);
    return stepper;
  }
};

/// A general splitting chosen by type.
template <const SplittingTable& Table>
struct SplittingBy {
  template <class P>
  static constexpr bool accepts = Table.nystroem ? QuadraticKinetic<P> : Separable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  static constexpr Shape shape() {
    constexpr bool kick_first = Table.starts_with == StartsWith::kick;
    constexpr int last = Table.count() - 1;
    return shape_of(kick_first, kick_first == (last % 2 == 0), Table.coefficient(0) == Table.coefficient(last));
  }
  static constexpr int links = (Table.count() + (Table.starts_with == StartsWith::kick ? 0 : 1)) / 2;
  template <class P, class A>
  using Stepper = Splitting<P, A, shape(), links>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    static_assert(accepts<P>,
                  "hamflow: the order of this table holds only for a QuadraticKinetic problem, T = p^T M^-1 p/2");
    static_assert(Table.is_consistent(), "hamflow: the kicks and the drifts of a splitting table must each sum to 1");
    Stepper<P, A> stepper{sequence_of<typename Stepper<P, A>::Base>(Table), detail::describe_splitting, &Table};
    stepper.ask(problem);
    return stepper;
  }
};

}  // namespace hamflow
