// Certifies **one step of a foreign integrator**: measures its order, symplecticity, time symmetry and invariants in
// double, from the numbers that the step returns. `hamflow verify` measures methods of the catalogue more precisely,
// because it can evaluate their steps in long double and differentiate them exactly.
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
  Texts parameters{};       // all parameters of the problem
  std::vector<double> q{};  // a state of the motion; empty: the start that the catalogue declares
  std::vector<double> p{};
};

/// Claims about a step. A property without a claim is measured but not compared.
struct StepClaims {
  std::optional<int> order{};
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::string> preserves{};  // "energy", and the invariants of the problem
};

/// Results of the measurements. A property without a value is undecided.
struct StepCertificate {
  std::optional<double> order{};  // infinite if every step is exact to rounding
  std::optional<bool> symplectic{};
  std::optional<bool> symmetric{};
  std::vector<std::pair<std::string, std::optional<bool>>> preserves{};
  std::optional<bool> agrees = true;  // false: a claim is refuted; nullopt: none is refuted, but one is undecided
  std::string reason{};               // why a claim is refuted or a property is undecided
};

/// Measures a step on a problem.
///
/// - Order: the errors of single steps from four states are measured against Taylor series in long double. Step sizes
///   go from a third of a period down until the error is no longer a smooth function of h. Then log E = a + (r + 1) log
///   h + b h + c h^2 is fitted to the smallest step sizes.   [HLW2006, Sect. II.1]
/// - Symplecticity: the Jacobian is computed by central differences of order 6 with three difference lengths; their
///   disagreement bounds its error.   [HLW2006, Def. VI.2.1]
/// - Time symmetry: distance from the start after a step of h and one of -h.   [HLW2006, Def. II.3.1]
/// - Invariants: their change over a step.
///
/// Each defect is compared with the error of the step. `true`: the defect is at rounding level for two step sizes at
/// which the error of the method is 1000 times above rounding. `false`: the defect is more than a thousandth of this
/// error. In between the property is undecided, for example if the step solves its equations to a coarse tolerance.
///
/// The result holds for the step on this problem only. For example, the trapezoidal rule is symplectic on linear
/// problems. Therefore on a linear problem neither a higher order than claimed nor a property that the claims deny
/// refutes a claim, and with one degree of freedom such a claim is undecided. A measured order agrees with the claim
/// within 0.5, and within 1 from order 7 on.
/// @throws Error for a step that fails, has hidden state or changes nothing, for names of invariants that the problem
/// does not have, and for problems with walls, with constraints or an H that depends on t
StepCertificate certify_step(const ForeignStep& step, const StepProblem& problem, const StepClaims& claims = {});

}  // namespace hamflow
