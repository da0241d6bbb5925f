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
#include "hamflow/formula/structure.hpp"
#include "hamflow/run/method_family.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/run/step_map.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// No start has the energy that was asked for.
class NoStart : public Error {
 public:
  using Error::Error;
};

/// What stands for the component of p, or of v, that is left to the energy: the largest root of H = energy, or the
/// smallest.
inline constexpr const char* largest_root = "+";
inline constexpr const char* smallest_root = "-";
inline bool is_left_to_energy(const std::string& text) { return text == largest_root || text == smallest_root; }

/// Where a run begins: a geometric start or a state; v, if not empty, stands for p = dL/dv.
struct StartSpec {
  std::string kind;  // of a geometric start; empty, with an orbit: by energy and angular momentum
  Texts orbit;
  int direction = 1;
  std::vector<std::string> q;
  std::vector<std::string> p;
  std::vector<std::string> v;
  std::string energy;        // of a state of which one component is left to it; empty: all are given
  bool barycentric = false;  // the centre of mass is moved to the origin, to rest
  bool geometric() const { return !kind.empty() || !orbit.empty(); }
};

struct Request {
  std::string problem;
  std::map<std::string, std::string> variant;  // e.g. potential = kepler
  std::optional<Walls> walls{};
  Texts parameters;  // missing ones take their defaults
  StartSpec start;
  MethodSpec method;
  std::string dt = "0.1";
  std::string arithmetic = "double";
  double position_unit = 0x1p-52;  // lattice spacings, powers of two
  double momentum_unit = 0x1p-52;
  int threads = 1;     // for the forces of one step
  bool watch = true;   // energy and invariants at every step
  bool record = true;  // steps are recorded and compiled where they can be; the bits are the same
};

inline bool has_hard_walls(const Request& request) { return request.walls && request.walls->hard(); }

/// The derivatives of H in a state; dH/dp are the rates of change of the coordinates.
struct EnergyGradient {
  std::vector<double> by_q;
  std::vector<double> by_p;
};

/// The particles of which a problem consists.
struct ParticleFacts {
  std::size_t space = 0;         // numbers of a position
  std::vector<double> masses{};  // of all, or one for each
  std::vector<double> edges{};   // of the box that holds them
  double radius = 0;             // of the circle
  double repulsion = 0;          // within this distance two repel each other; 0: not known
};

/// One problem of the catalogue (a problem with a choice of potential has one entry for each). Parameters are complete.
struct ProblemEntry {
  ProblemInfo info;
  std::vector<std::string> momenta{};           // names; empty: momentum_name of the coordinates (run/state_names.hpp)
  std::optional<Walls> walls{};                 // behind which the problem is
  std::optional<FormulaStructure> structure{};  // of a typed Hamiltonian: what was found from its expression
  std::size_t dimension = 0;                    // degrees of freedom; 0: as many as the start has coordinates
  /// What q and p have to be where they cannot have `size` numbers; empty where they can.
  std::function<std::string(const Texts& parameters, std::size_t size)> refused_size;
  /// The key at fault, and what is wrong with parameters that contradict each other.
  std::function<std::pair<std::string, std::string>(const Texts& parameters)> refused_parameters;
  /// What is wrong with a start; empty if nothing is.
  std::function<std::string(const Texts& parameters, const std::vector<double>& q)> refused_start;
  /// Whether the problem has what the method needs.
  std::function<bool(const MethodSpec&)> accepts;
  bool has_pairwise_forces = false;  // on the lattice several threads may compute them
  /// What holds the particles of which the problem consists, a name of problems/support/container.hpp; empty: it does
  /// not consist of particles, and `particles` is empty.
  std::string container{};
  std::function<ParticleFacts(const Texts& parameters)> particles{};
  bool has_cutoff = false;    // forces of pairs end at a distance
  bool has_distance = false;  // from a centre or between bodies, which steps can follow
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate;
  /// The same problem behind virtual calls: in arithmetic beyond double, and for methods that have no typed kernel.
  std::function<std::unique_ptr<Simulation>(const Request&)> simulate_erased;
  /// The same in double from numbers, for the lanes of ensembles: of the request the method counts.
  std::function<std::unique_ptr<Simulation>(const Request&, const Parameters<double>&, const std::vector<double>& q,
                                            const std::vector<double>& p, double h)>
      simulate_member;
  /// Of the request the parameters, which are complete, the method and the walls count. Null where the method is not
  /// accepted.
  std::function<std::unique_ptr<StepMap>(const Request&, std::size_t size)> step_map;
  /// The parameters with those that follow from a geometric start set.
  std::function<Texts(const Texts& parameters, const StartSpec&)> derived;
  /// The conditions that a geometric start has to meet.
  std::function<std::vector<Condition>(const Texts& parameters, const StartSpec&)> conditions;
  /// H(q, p).
  std::function<double(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> energy;
  /// dH/dq and dH/dp.
  std::function<EnergyGradient(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      gradient;
  /// Whether H and its derivatives are finite there.
  std::function<bool(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)> regular;
  /// How many numbers each invariant has.
  std::function<std::vector<std::size_t>(const Texts& parameters, std::size_t size)> invariant_sizes;
  /// The canonical start of a request in double.
  std::function<Frame(const Request&)> start;
  /// The total mass, for the centre of mass of `size` coordinates; empty where the problem has none.
  std::function<double(const Texts& parameters, std::size_t size)> total_mass;
  /// The canonical change of coordinates to the reference chart of the problem and back; empty in that chart itself.
  /// They throw an Error where a chart does not reach.
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      to_reference;
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      from_reference;
  /// How the motion is kept on constraints g(q) = 0, FormulaKeys::manifold or multiplier
  /// (formula/problem_texts.hpp); empty: there are none.
  std::string constraint_form{};
  /// |g| and |g' M^-1 p| of a state; empty without constraints.
  std::function<ConstraintResiduals(const Texts& parameters, const std::vector<double>& q,
                                    const std::vector<double>& p)>
      residuals{};
  /// The state moved onto the constraints and along them, to rounding; empty without constraints.
  std::function<Frame(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p)>
      onto_constraints{};
  /// r(phi) of the exact orbit through (q, p); empty where there is no closed form.
  std::function<std::function<double(double)>(const Texts&, const std::vector<double>& q, const std::vector<double>& p)>
      exact_radius;
  /// The exact state at time t from (q, p) at 0; empty, or without value, where it is not known.
  std::function<std::optional<Frame>(const Texts&, const std::vector<double>& q, const std::vector<double>& p,
                                     double t)>
      exact;
  /// What follows from the effective potential for the orbit through (q, p); empty where there is none.
  std::function<OrbitFacts(const Texts&, const std::vector<double>& q, const std::vector<double>& p)> describe_orbit;
};

/// |g| and |g' M^-1 p| that a start may have.
inline constexpr double most_residual_at_start = 1e-12;

std::span<const ProblemEntry> problems();
std::span<const MethodEntry> methods();
/// "mp(d)" stands for any number of digits, e.g. mp(50).
const std::vector<std::string>& arithmetics();
/// d of "mp(d)"; 0 for any other name. @throws Error when d is not a number of digits
int mp_digits(const std::string& arithmetic);
/// Decimal digits of an arithmetic beyond double: 31, 33, d; else 0.
int digits_beyond_double(const std::string& arithmetic);
/// @throws Error naming what is allowed when there is no such arithmetic
void check_arithmetic(const std::string& arithmetic);

/// The problem `formula` as it stands in lists: an example. That of given texts is found by formula_choices
/// (formula/problem_texts.hpp).
ProblemEntry formula_example();
/// The problems of which one choice is typed (ProblemInfo::typed_choice), in each chart: examples, whose info has the
/// keys of a scenario.
std::span<const ProblemEntry> typed_examples();
/// Whether the whole Hamiltonian is typed, and not one choice alone.
inline bool has_typed_hamiltonian(const ProblemEntry& problem) {
  return problem.structure && problem.info.typed_choice.empty();
}
/// @throws Error with the nearest name when there is no such name
const MethodEntry& find_method(const std::string& name);
/// The entry of a typed problem, or of one behind walls, is made here: it lives as long as somebody holds it.
/// @throws Error with the nearest name when there is no such name
std::shared_ptr<const ProblemEntry> find_problem(const std::string& name,
                                                 const std::map<std::string, std::string>& variant,
                                                 const std::optional<Walls>& walls = std::nullopt);
inline std::shared_ptr<const ProblemEntry> find_problem(const Request& request) {
  return find_problem(request.problem, request.variant, request.walls);
}
/// The entry with these choices; what they leave open is chosen as a scenario would by default, or, where a scenario
/// has to choose, as `new` does (ProblemInfo::default_choices, example_choices). @throws Error as find_problem does
std::shared_ptr<const ProblemEntry> usual_problem(const std::string& name,
                                                  const std::map<std::string, std::string>& variant = {});
/// The parameters of a problem with defaults for those not given.
Texts complete(const ProblemInfo& info, const Texts& given);
MethodInfo describe(const MethodSpec& spec);
/// For what a method is, when to take it and when not.
MethodAdvice advice(const MethodSpec& spec);
/// The few methods with which to begin, those whose advice has a purpose, in the order of methods().
std::vector<std::string> first_methods();
/// "stv4", "cg(2,6)", "cg(degree=2,quadrature=6)".
/// @throws Error naming the option, what was found and what is allowed
MethodSpec parse_method(const std::string& text);
/// The option to blame, and what is wrong with a text for it or with options that do not go together:
/// "found ...; allowed ...". Empty if nothing is.
struct RefusedOption {
  std::string name;
  std::string message;
};
std::optional<RefusedOption> refused_option(const MethodSpec& spec);
/// The number of its family in method_families().
std::size_t family_number(const MethodEntry& method);
std::span<const MethodFamily> method_families();
/// Why a method cannot run in an arithmetic; empty if it can.
std::string refusal(const MethodSpec& spec, const std::string& arithmetic);
/// Why a method cannot run on a problem, and which can; empty if it can.
std::string refusal(const MethodSpec& spec, const ProblemEntry& problem);
/// Why a request cannot have several threads; empty if it can.
std::string refused_threads(const Request& request, const ProblemEntry& problem);
inline constexpr int most_threads = 256;

/// @throws Error when the request is wrong
std::unique_ptr<Simulation> make_simulation(const Request& request);

}  // namespace hamflow
