// **One step of anybody's integrator**, seen from outside: its order, symplecticity, time symmetry and invariants,
// measured in double from the numbers that it returns. `hamflow verify` measures the methods of the catalogue more
// sharply, since it has their steps in long double and their exact Jacobians.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// From (q, p) over the time h, which may be negative, in place. @throws Error where it cannot
using ForeignStep = std::function<void(std::vector<double>& q, std::vector<double>& p, double h)>;

/// The problem that a step integrates.
struct StepProblem {
  std::shared_ptr<const ProblemEntry> entry{};
  std::map<std::string, std::string> variant{};
  Texts parameters{};       // complete
  std::vector<double> q{};  // a state of the motion; empty: the one that the catalogue declares
  std::vector<double> p{};
};

/// Claims about a step. A property without a claim is measured, but not compared.
struct StepClaims {
  std::optional<int> order{};
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::string> preserves{};  // "energy", and the invariants of the problem
};

/// What was measured. None: undecided.
struct StepCertificate {
  std::optional<double> order{};  // infinite where each step is exact to rounding
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::pair<std::string, std::optional<bool>>> preserves{};
  std::optional<bool> agrees = true;  // false: a claim is refuted; none: one is undecided and none is refuted
  std::string reason{};               // what refutes a claim, or leaves a property undecided
};

/// Measures a step on a problem.
///
/// - Order: errors of single steps from four states, against Taylor series in long double, with steps from a third of a
///   period down until the error is no smooth function of h; the exponent of log E = a + (r + 1) log h + b h + c h^2
///   over the finest that fit.   [HLW2006, Sect. II.1]
/// - Symplecticity: the Jacobian by central differences of order 6, with three difference lengths whose disagreement is
///   the error bound. [HLW2006, Def. VI.2.1]   Time symmetry: the distance after a step of h and one of -h. [HLW2006,
///   Def. II.3.1]   Invariants: their change over a step.
///   Each defect is compared with the error of the step: `true` where it is rounding, at two step lengths at which an
///   error of the method stands 1000 times above rounding; `false` where it is more than a thousandth of that error.
///   In between, as with equations that are solved to a coarse tolerance, the property is undecided.
///
/// A property is one of the step on this problem: on a linear problem the trapezoidal rule is symplectic. There a
/// higher order than the one that is claimed, or a property that is denied, refutes nothing; with one degree of freedom
/// such a claim is undecided. An order agrees within 0.5, from order 7 on within 1.
/// @throws Error for a step that fails, keeps hidden state or changes nothing, for names of invariants that the problem
/// does not have, and for problems with walls, with constraints or an H that depends on t
StepCertificate certify_step(const ForeignStep& step, const StepProblem& problem, const StepClaims& claims = {});

}  // namespace hamflow
