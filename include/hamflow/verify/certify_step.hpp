// Certifies **one step of a foreign integrator**: its order, symplecticity, time symmetry and invariants, measured in
// double from the numbers that it returns. `hamflow verify` measures the methods of the catalogue more precisely,
// because it has their steps in long double and their exact Jacobians.
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

/// Advances (q, p) in place by the time h, which may be negative. @throws Error if it cannot
using ForeignStep = std::function<void(std::vector<double>& q, std::vector<double>& p, double h)>;

/// The problem that a step integrates.
struct StepProblem {
  std::shared_ptr<const ProblemEntry> entry{};
  std::map<std::string, std::string> variant{};
  Texts parameters{};       // complete
  std::vector<double> q{};  // a state of the motion; empty: the one declared by the catalogue
  std::vector<double> p{};
};

/// Claims about a step. A property without a claim is measured, but not compared.
struct StepClaims {
  std::optional<int> order{};
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::string> preserves{};  // "energy", and the invariants of the problem
};

/// The results. A property without a value is undecided.
struct StepCertificate {
  std::optional<double> order{};  // infinite if every step is exact to rounding
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::pair<std::string, std::optional<bool>>> preserves{};
  std::optional<bool> agrees = true;  // false: a claim is refuted; none: one is undecided and none is refuted
  std::string reason{};               // why a claim is refuted or a property is undecided
};

/// Measures a step on a problem.
///
/// - Order: errors of single steps from four states, compared with Taylor series in long double, with steps from a
/// third
///   of a period down until the error is no longer a smooth function of h; log E = a + (r + 1) log h + b h + c h^2 is
///   fitted to the finest steps.   [HLW2006, Sect. II.1]
/// - Symplecticity: the Jacobian by central differences of order 6, with three difference lengths whose disagreement is
///   the error bound. [HLW2006, Def. VI.2.1]   Time symmetry: the distance after a step of h and one of -h. [HLW2006,
///   Def. II.3.1]   Invariants: their change over a step.
///   Each defect is compared with the error of the step. `true`: the defect is rounding at two step sizes at which the
///   error of the method is 1000 times above rounding. `false`: the defect is more than a thousandth of this error. In
///   between, e.g. if equations are solved to a coarse tolerance, the property is undecided.
///
/// The result is valid for the step on this problem: on a linear problem, for example, the trapezoidal rule is
/// symplectic. So on a linear problem a higher order than claimed, or a property that is denied, refutes nothing, and
/// with one degree of freedom such a claim is undecided. An order agrees within 0.5, from order 7 on within 1.
/// @throws Error for a step that fails, has hidden state or changes nothing, for names of invariants that the problem
/// does not have, and for problems with walls, with constraints or an H that depends on t
StepCertificate certify_step(const ForeignStep& step, const StepProblem& problem, const StepClaims& claims = {});

}  // namespace hamflow
