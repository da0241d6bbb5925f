// **Catalog**: names to types. `make_simulation(request)` turns names and texts into a typed simulation behind the
// type-erased interface; the lists serve the command, the documentation and the tests.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/methods/adaptive_options.hpp"
#include "hamflow/methods/cg_options.hpp"
#include "hamflow/methods/tables.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/run/step_map.hpp"

namespace hamflow {

/// A method by name, with its options where it has any.
struct MethodSpec {
  std::string name = "stv4";
  CgOptions cg{};
  AdaptiveOptions adaptive{};  // of dop853 and taylor
};

enum class MethodKind { composition, splitting, force_gradient, runge_kutta, cg, boris, dop853, taylor };

/// One name of the closed list of methods.
struct MethodEntry {
  std::string name;
  MethodKind kind;
  StartsWith starts_with = StartsWith::kick;  // of a composition
  const CompositionTable* composition = nullptr;
  const SplittingTable* splitting = nullptr;
  const ForceGradientTable* force_gradient = nullptr;
};

/// Numbers are texts, read in the arithmetic of the run.
using Texts = std::map<std::string, std::string>;

/// Where a run begins: a geometric start or a state; v, if not empty, stands for p = dL/dv.
struct StartSpec {
  std::string kind;  // of a geometric start; empty, with an orbit: by energy and angular momentum
  Texts orbit;
  int direction = 1;
  std::vector<std::string> q;
  std::vector<std::string> p;
  std::vector<std::string> v;
  bool geometric() const { return !kind.empty() || !orbit.empty(); }
};

struct Request {
  std::string problem;
  std::map<std::string, std::string> variant;  // e.g. potential = kepler
  Texts parameters;                            // missing ones take their defaults
  StartSpec start;
  MethodSpec method;
  std::string dt = "0.1";
  std::string arithmetic = "double";
  std::string kernel = "exact";
  double position_unit = 0x1p-52;  // lattice spacings, powers of two
  double momentum_unit = 0x1p-52;
  int threads = 1;    // for the forces of one step
  bool watch = true;  // energy and invariants at every step
};

/// One problem of the catalogue (a problem with a choice of potential has one entry for each). Parameters are complete.
struct ProblemEntry {
  ProblemInfo info;
  std::size_t dimension = 0;  // degrees of freedom; 0: as many as the start has coordinates
  /// What q and p have to be where `size` numbers cannot be one of them; empty where they can.
  std::function<std::string(const Texts& parameters, std::size_t size)> refused_size;
  /// The key to blame and what is wrong with parameters that do not go together.
  std::function<std::pair<std::string, std::string>(const Texts& parameters)> refused_parameters;
  /// What is wrong with a start; empty if nothing is.
  std::function<std::string(const Texts& parameters, const std::vector<double>& q)> refused_start;
  /// Whether the problem has what the method needs.
  std::function<bool(const MethodSpec&)> accepts;
  bool has_fast_kernel = false;
  bool has_pairwise_forces = false;  // on the lattice several threads may compute them
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate;
  /// The same behind virtual calls: in arithmetic beyond double, and for methods that have no typed kernel.
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate_erased;
  /// Null where the method is not accepted.
  std::function<std::unique_ptr<StepMap>(const Texts& parameters, const MethodSpec&, std::size_t size)> step_map;
  /// The parameters with those that follow from a geometric start set.
  std::function<Texts(const Texts& parameters, const StartSpec&)> derived;
  /// The conditions that a geometric start has to meet.
  std::function<std::vector<Condition>(const Texts& parameters, const StartSpec&)> conditions;
  /// H(q, p).
  std::function<double(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> energy;
  /// Whether H and its derivatives are finite there.
  std::function<bool(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> regular;
  /// How many numbers each invariant has.
  std::function<std::vector<std::size_t>(const Texts& parameters, std::size_t size)> invariant_sizes;
  /// The canonical start of a request in double.
  std::function<Frame(const Request&)> start;
  /// r(phi) of the exact orbit through (q, p); empty where there is no closed form.
  std::function<std::function<double(double)>(const Texts&, const std::vector<double>& q, const std::vector<double>& p)>
      exact_radius;
  /// The exact state at time t from (q, p) at 0; empty, or without value, where it is not known.
  std::function<std::optional<Frame>(const Texts&, const std::vector<double>& q, const std::vector<double>& p,
                                     double t)>
      exact;
  /// What the effective potential says of the orbit through (q, p); empty where there is none.
  std::function<OrbitFacts(const Texts&, const std::vector<double>& q, const std::vector<double>& p)> describe_orbit;
};

std::span<const ProblemEntry> problems();
std::span<const MethodEntry> methods();
/// "mp(d)" stands for any number of digits, e.g. mp(50).
inline const std::vector<std::string>& arithmetics() {
  static const std::vector<std::string> names{"double", "compensated", "double-double", "quad", "mp(d)", "lattice"};
  return names;
}
/// d of "mp(d)"; 0 where the name is another. @throws Error when d is no number of digits
int mp_digits(const std::string& arithmetic);
/// Decimal digits of an arithmetic beyond double: 31, 33, d; else 0.
int digits_beyond_double(const std::string& arithmetic);
/// @throws Error naming what is allowed when there is no such arithmetic
void check_arithmetic(const std::string& arithmetic);

/// @throws Error naming the nearest name when there is none such
const MethodEntry& find_method(const std::string& name);
const ProblemEntry& find_problem(const std::string& name, const std::map<std::string, std::string>& variant);
/// The parameters of a problem with defaults for those not given.
Texts complete(const ProblemInfo& info, const Texts& given);
MethodInfo describe(const MethodSpec& spec);
/// "stv4", "cg(2,6)", "cg(degree=2,quadrature=6)". @throws Error
MethodSpec parse_method(const std::string& text);
/// The order of taylor with these options.
int taylor_order(const AdaptiveOptions& options);
inline constexpr int least_taylor_order = 2;
inline constexpr int most_taylor_order = 200;
/// Why a method cannot run in an arithmetic; empty if it can.
std::string refusal(const MethodSpec& spec, const std::string& arithmetic);
/// Why a method cannot run on a problem, and which can; empty if it can.
std::string refusal(const MethodSpec& spec, const ProblemEntry& problem);
/// Why a request cannot have kernel = "fast"; empty if it can.
std::string refused_fast_kernel(const Request& request, const ProblemEntry& problem);
/// Why a request cannot have several threads; empty if it can.
std::string refused_threads(const Request& request, const ProblemEntry& problem);
inline constexpr int most_threads = 256;

/// @throws Error when the request is wrong
std::unique_ptr<Simulation> make_simulation(const Request& request);

}  // namespace hamflow
