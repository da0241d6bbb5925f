// Connects typed problems with the methods that are compiled once for each number type (detail/run/any_problem.hpp).
#pragma once

#include <memory>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/detail/arithmetic/more_digits.hpp"
#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/catalog.hpp"
#include "mp_simulation.hpp"

namespace hamflow {

struct StepWalls;

// Recordings are compiled once for each number type, in traces.cpp.
#define HAMFLOW_FOR_EACH_TRACED(X) X(double) X(long double) X(DoubleDouble) X(Quad) X(Mp)
#define HAMFLOW_TRACED(R)          \
  extern template struct Trace<R>; \
  extern template class Recorder<R>;
HAMFLOW_FOR_EACH_TRACED(HAMFLOW_TRACED)
#undef HAMFLOW_TRACED

/// The problem in R. It can be recorded on a tape, for taylor; in double it can also be differentiated, for the
/// Jacobian of a step.
template <class R>
struct ErasedFunctions {
  Capability capability{};
  std::size_t size = 0;
  std::shared_ptr<const Functions<R>> plain;
  std::shared_ptr<const Functions<Trace<R>>> trace;
  std::shared_ptr<const Functions<Dual<double, 1>>> dual;

  template <Capability c>
  auto as() const {
    if constexpr (std::is_same_v<R, double>) {
      return AnyProblem<double, c, Trace<double>, Dual<double, 1>>(size, plain, trace, dual);
    } else {
      return AnyProblem<R, c, Trace<R>>(size, plain, trace);
    }
  }
};
template <class R, Capability c>
using Erased = decltype(std::declval<ErasedFunctions<R>>().template as<c>());

/// A problem in R with its start.
template <class R>
struct ErasedRun {
  ErasedFunctions<R> functions;
  Vector<R, dynamic> q;
  Vector<R, dynamic> p;
  R h;
  std::shared_ptr<const StepWalls> walls{};  // a recorded step must stay within these walls
};
/// Uses only the method and the arithmetic of the request. Each number type has its definition in a separate file.
template <class R>
std::unique_ptr<Simulation> simulate_erased(const ErasedRun<R>& run, const Request& request);

/// The number types of a StepMap: double for structure, more digits for orders.
struct ErasedProblem {
  ErasedFunctions<double> in_double;
  ErasedFunctions<long double> in_long;
  ErasedFunctions<Quad> in_quad;
  template <class R>
  const ErasedFunctions<R>& in() const {
    if constexpr (std::is_same_v<R, double>) {
      return in_double;
    } else if constexpr (std::is_same_v<R, long double>) {
      return in_long;
    } else {
      return in_quad;
    }
  }
};
/// Uses only the method and the walls of the request.
std::unique_ptr<StepMap> erased_step_map(const ErasedProblem& problem, const Request& request);

/// The part of a catalogue entry that is compiled with light optimisation, apart from the kernels.
struct ErasedEntry {
  ProblemEntry facts;  // the entry without simulations
  /// The simulation in an arithmetic of `extended`, or in double for methods without a typed kernel.
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate;
  std::function<std::unique_ptr<StepMap>(const Request&, std::size_t size)> step_map;
  /// The change of coordinates to the reference chart of the problem and back, in an arithmetic of `extended`; empty in
  /// that chart itself.
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> to_reference{};
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> from_reference{};
  /// In double, from numbers.
  std::function<std::unique_ptr<Simulation>(const Request&, const Parameters<double>&, const std::vector<double>& q,
                                            const std::vector<double>& p, double h)>
      simulate_member{};
};

/// Calls action.template operator()<R>() with the number type R of an arithmetic beyond double.
template <class Action>
auto in_arithmetic(const std::string& arithmetic, const Action& action) {
  if constexpr (has_quad_and_mp) {
    if (arithmetic == "quad") return action.template operator()<Quad>();
    if (const int digits = mp_digits(arithmetic); digits > 0) {
      const MpDigits scope(digits);
      return action.template operator()<Mp>();
    }
  }
  if (arithmetic != "double-double") throw Error("found '" + arithmetic + "'; allowed more digits than double has");
  return action.template operator()<DoubleDouble>();
}

/// The StepMap of the problem whose functions in the number type R are functions.template operator()<R>(); null in the
/// laboratory, because it needs more digits.
template <class Functions>
std::unique_ptr<StepMap> step_map_of(const Functions& functions, const Request& request) {
  if constexpr (!has_more_digits) {
    return nullptr;
  } else {
    return erased_step_map({functions.template operator()<double>(), functions.template operator()<long double>(),
                            functions.template operator()<Quad>()},
                           request);
  }
}

/// The simulation that action.template operator()<R>() makes in the number type of any arithmetic.
template <class Action>
std::unique_ptr<Simulation> simulated_in(const std::string& arithmetic, const Action& action) {
  if (digits_beyond_double(arithmetic) > 0) {
    auto simulation = in_arithmetic(arithmetic, action);
    const int digits = mp_digits(arithmetic);
    return digits > 0 ? with_digits(digits, std::move(simulation)) : std::move(simulation);
  }
  return action.template operator()<double>();
}

}  // namespace hamflow
