// **Catalog**: maps names to types. `make_simulation(request)` makes a typed simulation from names and texts, behind
// the type-erased interface. The command, the documentation and the tests use the lists.
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

#include "hamflow/core/function_set.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/formula/structure.hpp"
#include "hamflow/detail/run/method_family.hpp"
#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// No start has the requested energy.
class NoStart : public Error {
 public:
  using Error::Error;
};

/// Written instead of the component of p or v that the energy determines: the largest root of H = energy, or the
/// smallest.
inline constexpr const char* largest_root = "+";
inline constexpr const char* smallest_root = "-";
inline bool is_left_to_energy(const std::string& text) { return text == largest_root || text == smallest_root; }

/// The start of a run: a geometric start or a state; v, if not empty, determines p = dL/dv.
struct StartSpec {
  std::string kind;  // of a geometric start; if empty and an orbit is given: by energy and angular momentum
  Texts orbit;
  int direction = 1;
  std::vector<std::string> q;
  std::vector<std::string> p;
  std::vector<std::string> v;
  std::string energy;        // of a state with one open component; empty: all components are given
  bool barycentric = false;  // the centre of mass is moved to the origin, at rest
  bool geometric() const { return !kind.empty() || !orbit.empty(); }
};

struct Request {
  std::string problem;
  std::map<std::string, std::string> variant;  // e.g. potential = kepler
  std::optional<Walls> walls{};
  Texts parameters;  // missing parameters take their defaults
  StartSpec start;
  MethodSpec method;
  std::string dt = "0.1";
  std::string arithmetic = "double";
  std::optional<FunctionSet> functions{};  // unset: those in use
  double position_unit = 0x1p-52;          // lattice spacings, powers of two
  double momentum_unit = 0x1p-52;
  int threads = 1;     // for the forces of one step
  bool watch = true;   // monitors energy and invariants at every step
  bool record = true;  // records and compiles steps if possible; the bits are the same
};

inline bool has_hard_walls(const Request& request) { return request.walls && request.walls->hard(); }

/// The derivatives of H in a state; dH/dp are the rates of change of the coordinates.
struct EnergyGradient {
  std::vector<double> by_q;
  std::vector<double> by_p;
};

/// The particles of a problem.
struct ParticleFacts {
  std::size_t space = 0;         // dimension of a position
  std::vector<double> masses{};  // one for all, or one for each
  std::vector<double> edges{};   // of the box
  double radius = 0;             // of the circle
  double repulsion = 0;          // two particles repel each other within this distance; 0: unknown
};

/// Why a start is refused.
struct StartRefusal {
  std::string message{};                 // follows the word "found"; empty: the start is accepted
  std::string key{};                     // the key of the wall or container at fault; empty: another reason
  std::vector<std::size_t> particles{};  // the particles at fault, numbered from 1
};

/// A problem of the catalogue; a problem with a choice of potentials has an entry for each. Functions take complete
/// parameters.
struct ProblemEntry {
  ProblemInfo info;
  std::vector<std::string> momenta{};           // names; empty: momentum_name of the coordinates (run/state_names.hpp)
  std::optional<Walls> walls{};                 // the walls of the problem
  std::optional<FormulaStructure> structure{};  // of a typed Hamiltonian, found from its expression
  std::size_t dimension = 0;                    // degrees of freedom; 0: as many as the start has coordinates
  /// The required size of q and p, in words, if `size` is not allowed; empty if it is.
  std::function<std::string(const Texts& parameters, std::size_t size)> refused_size;
  /// The key at fault and the error of parameters that contradict each other.
  std::function<std::pair<std::string, std::string>(const Texts& parameters)> refused_parameters;
  /// Whether a start is refused, and why.
  std::function<StartRefusal(const Texts& parameters, const std::vector<double>& q)> refused_start;
  /// Whether the problem has the capabilities that the method needs.
  std::function<bool(const MethodSpec&)> accepts;
  bool has_pairwise_forces = false;  // several threads may compute them on the lattice
  /// The kind of container of the particles, a name of src/gas/container.hpp; empty: the problem has no particles, and
  /// `particles` is empty.
  std::string container{};
  std::function<ParticleFacts(const Texts& parameters)> particles{};
  bool has_cutoff = false;    // forces of pairs end at a distance
  bool has_distance = false;  // a distance from a centre or between bodies can control the step size
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate;
  /// The simulation behind virtual calls, for arithmetics beyond double and methods without a typed kernel.
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate_erased;
  /// The simulation in double, from numbers, for the lanes of ensembles. It uses only the method of the request.
  std::function<std::unique_ptr<Simulation>(const Request&, const Parameters<double>&, const std::vector<double>& q,
                                            const std::vector<double>& p, double h)>
      simulate_member;
  /// Uses only the (complete) parameters, the method and the walls of the request. Null if the method is not accepted.
  std::function<std::unique_ptr<StepMap>(const Request&, std::size_t size)> step_map;
  /// The parameters, including those that follow from a geometric start.
  std::function<Texts(const Texts& parameters, const StartSpec&)> derived;
  /// The conditions that a geometric start must meet.
  std::function<std::vector<Condition>(const Texts& parameters, const StartSpec&)> conditions;
  /// H(q, p).
  std::function<double(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> energy;
  /// dH/dq and dH/dp.
  std::function<EnergyGradient(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      gradient;
  /// Whether H and its derivatives are finite in the state.
  std::function<bool(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> regular;
  /// The number of components of each invariant.
  std::function<std::vector<std::size_t>(const Texts& parameters, std::size_t size)> invariant_sizes;
  /// The canonical start of a request in double.
  std::function<Frame(const Request&)> start;
  /// The total mass, for the centre of mass of `size` coordinates; empty if the problem has none.
  std::function<double(const Texts& parameters, std::size_t size)> total_mass;
  /// The canonical change of coordinates to the reference chart of the problem and back; empty for the reference chart.
  /// They throw an Error outside the range of a chart.
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      to_reference;
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      from_reference;
  /// The form of constraints g(q) = 0, FormulaKeys::manifold or multiplier (formula/problem_texts.hpp); empty: there
  /// are no constraints.
  std::string constraint_form{};
  /// |g| and |g' M^-1 p| of a state; empty without constraints.
  std::function<ConstraintResiduals(const Texts& parameters, const std::vector<double>& q,
                                    const std::vector<double>& p)>
      residuals{};
  /// The state projected onto the constraints, with momenta along them, to rounding; empty without constraints.
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      onto_constraints{};
  /// r(phi) of the exact orbit through (q, p); empty if there is no closed form.
  std::function<std::function<double(double)>(const Texts&, const std::vector<double>& q, const std::vector<double>& p)>
      exact_radius;
  /// The exact state at time t from (q, p) at time 0; empty, or nullopt, if unknown.
  std::function<std::optional<Frame>(const Texts&, const std::vector<double>& q, const std::vector<double>& p,
                                     double t)>
      exact;
  /// Facts from the effective potential about the orbit through (q, p); empty if there is no such potential.
  std::function<OrbitFacts(const Texts&, const std::vector<double>& q, const std::vector<double>& p)> describe_orbit;
};

/// The largest |g| and |g' M^-1 p| that a start may have.
inline constexpr double most_residual_at_start = 1e-12;

std::span<const ProblemEntry> problems();
std::span<const MethodEntry> methods();
/// "mp(d)" stands for any number of digits, e.g. mp(50).
const std::vector<std::string>& arithmetics();
/// d of "mp(d)"; 0 for any other name. @throws Error if d is not a valid number of digits
int mp_digits(const std::string& arithmetic);
/// Decimal digits of an arithmetic with more digits than double: 31, 33, d; else 0.
int digits_beyond_double(const std::string& arithmetic);
/// @throws Error with the allowed names if there is no such arithmetic
void check_arithmetic(const std::string& arithmetic);

/// An example of the problem `formula`, as it appears in lists. The entry of given texts is found with formula_choices
/// (formula/problem_texts.hpp).
ProblemEntry formula_example();
/// Examples, in each chart, of the problems with one typed choice (ProblemInfo::typed_choice). Their info has the keys
/// of a scenario.
std::span<const ProblemEntry> typed_examples();
/// Whether the whole Hamiltonian is typed, not only one choice.
inline bool has_typed_hamiltonian(const ProblemEntry& problem) {
  return problem.structure && problem.info.typed_choice.empty();
}
/// @throws Error with the nearest name when there is no such name
const MethodEntry& find_method(const std::string& name);
/// Makes the entry of a typed problem or of a problem with walls, which exists as long as a pointer to it.
/// @throws Error with the nearest name when there is no such name
std::shared_ptr<const ProblemEntry> find_problem(const std::string& name,
                                                 const std::map<std::string, std::string>& variant,
                                                 const std::optional<Walls>& walls = std::nullopt);
inline std::shared_ptr<const ProblemEntry> find_problem(const Request& request) {
  return find_problem(request.problem, request.variant, request.walls);
}
/// The entry with these choices. Missing choices take the defaults of a scenario, or those of `new` if a scenario must
/// choose (ProblemInfo::default_choices, example_choices). @throws Error as find_problem does
std::shared_ptr<const ProblemEntry> usual_problem(const std::string& name,
                                                  const std::map<std::string, std::string>& variant = {});
/// The parameters of a problem with defaults for those not given.
Texts complete(const ProblemInfo& info, const Texts& given);
MethodInfo describe(const MethodSpec& spec);
/// The purpose of a method, when to use it and when not.
MethodAdvice advice(const MethodSpec& spec);
/// The few methods recommended first: those whose advice has a purpose, in the order of methods().
std::vector<std::string> first_methods();
/// "stv4", "cg(2,6)", "cg(degree=2,quadrature=6)".
/// @throws Error with the option, what was found and what is allowed
MethodSpec parse_method(const std::string& text);
/// The error of an option, or of options that cannot be combined: the option at fault and "found ...; allowed ...".
struct RefusedOption {
  std::string name;
  std::string message;
};
std::optional<RefusedOption> refused_option(const MethodSpec& spec);
/// The index of the method's family in method_families().
std::size_t family_number(const MethodEntry& method);
std::span<const MethodFamily> method_families();
/// Why a method cannot run in an arithmetic; empty if it can.
std::string refusal(const MethodSpec& spec, const std::string& arithmetic);
/// Why a method cannot run on a problem, and which methods can; empty if it can.
std::string refusal(const MethodSpec& spec, const ProblemEntry& problem);
/// Why a request cannot use several threads; empty if it can.
std::string refused_threads(const Request& request, const ProblemEntry& problem);
inline constexpr int most_threads = 256;

/// @throws Error if the request is wrong
std::unique_ptr<Simulation> make_simulation(const Request& request);

}  // namespace hamflow
