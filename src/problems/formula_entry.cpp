// The catalogue entry of a typed Hamiltonian. ProblemUnit and ErasedUnit do the same for a problem that is a C++ type.
#include "core/constrained_motion.hpp"
#include "engine/double_constants.hpp"
#include "engine/erased.hpp"
#include "engine/iteration_choice.hpp"
#include "engine/large_steps.hpp"
#include "engine/mp_simulation.hpp"
#include "engine/recorded_cg.hpp"
#include "engine/timed_simulation.hpp"
#include "hamflow/detail/run/formula_functions.hpp"
#include "hamflow/problems/support/central_force.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/walls.hpp"
#include "methods/recipes.hpp"
#include "problem_start.hpp"
#include "typed_potential.hpp"
#include "typed_problem.hpp"

namespace hamflow {

namespace {

template <class R>
using AnyFormula = Erased<R, Capability::smooth>;

template <class R>
ErasedFunctions<R> functions_of(const EntryModel& model, const Parameters<R>& parameters,
                                TypedCentre centre = TypedCentre::none, const Parameters<double>* rounded = nullptr) {
  const auto bound = std::make_shared<const formula::BoundModel<R>>(model.made(), parameters, rounded);
  ErasedFunctions<R> all{capabilities_of(model.structure()), model.degrees(),
                         std::make_shared<FormulaFunctions<R, R>>(bound, centre),
                         std::make_shared<FormulaFunctions<R, Trace<R>>>(bound), nullptr};
  if constexpr (std::is_same_v<R, double>) all.dual = std::make_shared<FormulaFunctions<R, Dual<double, 1>>>(bound);
  return all;
}

template <class R>
ErasedFunctions<R> functions_of(const EntryModel& model, const Texts& parameters,
                                TypedCentre centre = TypedCentre::none) {
  return functions_of<R>(model, Parameters<R>(parameters), centre);
}

std::string refused_size(const EntryModel& model, std::size_t size) {
  const std::size_t n = model.size();
  return size == n ? std::string() : std::to_string(n) + (n == 1 ? " number" : " numbers");
}

template <class R>
using StateOf = Start<R, dynamic>;

/// The data of an entry: its model, and the field if it is a central force.
struct Typed {
  EntryModel model;
  std::optional<TypedField> field;
  TypedCentre centre() const {
    if (!field) return TypedCentre::none;
    return field->polar ? TypedCentre::of_radius : TypedCentre::origin;
  }
};

/// A start by energy and angular momentum, as in CentralForce.
template <class R>
StateOf<R> orbit_of(const TypedField& field, const Texts& texts, const StartSpec& spec, Conditions& conditions) {
  using Rough = std::conditional_t<std::is_floating_point_v<R>, R, long double>;
  const Parameters<R> given(texts);
  const Parameters<R> orbit(spec.orbit);
  const R l = orbit["angular_momentum"];
  const TypedPotential<R> exact(field.radial, given);
  const TypedPotential<Rough> rough(field.radial, given.template as<Rough>());
  const auto at = turning_point<R>(exact, rough, given[CentralKeys::mass], R(orbit["energy"]), l, conditions);
  Start<R, 2> s = at.circle ? circular_start(at.radius, l) : pericentre_start(at.radius, l);
  if (field.polar) s = to_polar(s);
  return {{s.q[0], s.q[1]}, {s.p[0], s.p[1]}};
}

/// The start, as in ProblemStart.
template <class R>
StateOf<R> start_of(const Typed& typed, const AnyFormula<R>& problem, const Request& request) {
  const EntryModel& model = typed.model;
  const StartSpec& spec = request.start;
  if (spec.geometric() && typed.field) {
    Conditions conditions;
    StateOf<R> s = orbit_of<R>(*typed.field, request.parameters, spec, conditions);
    for (const Condition& c : conditions.all()) {
      if (!c.holds()) throw Error(c.key + ": the start needs " + c.statement);
    }
    for (R& x : s.p) x = R(spec.direction) * x;
    return s;
  }
  // The texts are read once: the search for a start of given energy asks for many.
  struct Numbers {
    Vector<R, dynamic> all;
    std::vector<std::size_t> open;  // left to the energy
    Vector<R, dynamic> with(const R& free) const {
      Vector<R, dynamic> out = all;
      for (const std::size_t i : open) out[i] = free;
      return out;
    }
  };
  const auto read = [&](const std::vector<std::string>& texts) {
    if (const std::string why_not = refused_size(model, texts.size()); !why_not.empty()) {
      throw Error("a state of this problem has " + why_not + " for each of q and p, not " +
                  std::to_string(texts.size()));
    }
    Numbers numbers{Vector<R, dynamic>(model.degrees()), {}};  // time and its momentum start at 0
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (is_left_to_energy(texts[i])) {
        numbers.open.push_back(i);
      } else {
        numbers.all[i] = evaluate_number<R>(texts[i]);
      }
    }
    return numbers;
  };
  const Numbers q = read(spec.q);
  const Numbers p = read(spec.v.empty() ? spec.p : spec.v);
  const auto with = [&](const R& free) {
    StateOf<R> s{q.with(free), p.with(free)};
    if (!spec.v.empty()) s.p = ProblemStart<AnyFormula>::template momenta_of<R>(problem, s.q, s.p, model.size());
    return s;
  };
  if (spec.energy.empty()) return with(R(0));
  EnergyLine<R> line = energy_line(problem, with);
  line.is_parabola = model.structure().quadratic_kinetic;  // of the text; it spares a thousand evaluations
  return with(component_for_energy(line, request));
}

std::unique_ptr<Simulation> without_time(const EntryModel& model, std::unique_ptr<Simulation> simulation) {
  if (!model.structure().time || !simulation) return simulation;
  return std::make_unique<TimedSimulation>(std::move(simulation));
}

/// Operations at one quadrature point. If there are too many for straight-line code with up to 64 points, loops over
/// points and coordinates are faster.
std::size_t operations_at_point(const formula::Model& model) {
  if (includes(capabilities_of(model.structure()), Capability::quadratic_kinetic)) {
    return model.force_and_hessian().code->steps.size();
  }
  return model.gradient->steps.size() + model.hessian().code->steps.size();
}

std::unique_ptr<Simulation> simulate_in_double(const formula::Model& model, const ErasedRun<double>& run,
                                               const Request& request) {
  constexpr std::size_t most_operations = 2000;
  if (request.walls) return simulate_erased<double>(run, request);  // the programs below have no walls
  auto element = visit_method(request.method, [&]<class M>(const M& recipe) -> std::unique_ptr<Simulation> {
    if constexpr (std::is_same_v<M, Cg>) {
      if (operations_at_point(model) <= most_operations) return simulate_recorded_element(run, request, recipe.options);
    }
    return nullptr;
  });
  return element ? std::move(element) : simulate_erased<double>(run, request);
}

/// The method of a request. The choice is made in double, so that every arithmetic makes the same one.
MethodSpec method_of(const Typed& typed, const Request& request) {
  if (unknowns_of_step(request.method, typed.model.degrees()) == 0) return request.method;
  const ErasedFunctions<double> functions = functions_of<double>(typed.model, request.parameters);
  const StateOf<double> s = start_of<double>(typed, functions.as<Capability::smooth>(), request);
  return with_cheaper_iteration(request.method, functions, s.q, s.p, evaluate_number<double>(request.dt));
}

template <class R>
std::unique_ptr<Simulation> simulate_in(const Typed& typed, const Request& asked) {
  const EntryModel& model = typed.model;
  Request request = asked;
  request.method = method_of(typed, asked);
  const bool rounds = DoubleConstants::are_in_use();
  const Parameters<double> rounded(rounds ? request.parameters : Texts());
  const ErasedFunctions<R> functions =
      functions_of<R>(model, Parameters<R>(request.parameters), typed.centre(), rounds ? &rounded : nullptr);
  const StateOf<R> s = start_of<R>(typed, functions.template as<Capability::smooth>(), request);
  const ErasedRun<R> run{functions, s.q, s.p, evaluate_number<R>(request.dt)};
  if constexpr (std::is_same_v<R, double>) return without_time(model, simulate_in_double(*model.made(), run, request));
  return without_time(model, simulate_erased<R>(run, request));
}

/// Whether a method accepts any vector field, not only J grad H.
bool takes_any_field(const MethodSpec& method) {
  return method.name == "rk4" || method.name == "dop853" || method.name == "taylor";
}

/// Order conditions for T quadratic in p also hold with explicit t: they follow from the degrees in p of commutators,
/// which T + E and V(q, t) do not exceed. E is the momentum of a coordinate whose mass goes to infinity, and a linear
/// term of such a T is a shift of p.
bool accepts(const FormulaStructure& structure, const MethodSpec& method) {
  constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;
  if (structure.multiplier) return takes_any_field(method);
  // Its correction along all coordinates would change the rate of the coordinates that hold the time.
  if (structure.time && method.name == "discrete-gradient") return false;
  return visit_method(method, [&]<class M>(const M& recipe) {
    if (structure.constraints > 0) return std::is_same_v<M, Rattle>;
    if (structure.quadratic_kinetic) return is_accepted<Erased<double, natural>>(recipe);
    if (structure.separable) return is_accepted<Erased<double, Capability::separable>>(recipe);
    return is_accepted<Erased<double, Capability::smooth>>(recipe);
  });
}

/// @param size degrees of freedom; the time starts at 0
Vector<double, dynamic> vector_of(const std::vector<double>& x, std::size_t size) {
  Vector<double, dynamic> v(size);
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = x[i];
  return v;
}

/// @param size number of coordinates with names
Frame frame_of(const StateOf<double>& s, std::size_t size) {
  Frame frame;
  frame.q.assign(s.q.begin(), s.q.begin() + size);
  frame.p.assign(s.p.begin(), s.p.begin() + size);
  return frame;
}

/// Whether gradients are linearly dependent or vanish, to the rounding of their entries. The multipliers of such
/// constraints are undefined.
bool are_linearly_dependent(const Gradients<double, dynamic>& rows) {
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  Gradients<double, dynamic> units;
  for (Vector<double, dynamic> row : rows) {
    const double whole = std::sqrt(dot(row, row));
    if (!std::isfinite(whole)) return false;  // the caller reports that the point is not regular
    for (const auto& unit : units) {
      const double along = dot(row, unit);
      for (std::size_t i = 0; i < row.size(); ++i) row[i] -= along * unit[i];
    }
    const double left = std::sqrt(dot(row, row));
    if (left <= rounding * whole) return true;
    for (double& x : row) x /= left;
    units.push_back(row);
  }
  return false;
}

}  // namespace

DigitCharts polar_digit_charts() {
  const auto changed = [](const auto& change) {
    return [change](const std::string& arithmetic, const DigitState& state) {
      return in_arithmetic(arithmetic, [&]<class R>() {
        const auto read = [](const std::vector<std::string>& x) {
          return Vector<R, 2>{evaluate_number<R>(x.at(0)), evaluate_number<R>(x.at(1))};
        };
        const auto written = [](const Vector<R, 2>& x) {
          return std::vector<std::string>{written_digits(x[0]), written_digits(x[1])};
        };
        const Start<R, 2> s = change(Start<R, 2>{read(state.q), read(state.p)});
        return DigitState{written(s.q), written(s.p)};
      });
    };
  };
  return {
      changed([]<class R>(const Start<R, 2>& s) { return PolarCentralForce<R, TypedPotential>::to_reference(s); }),
      changed([]<class R>(const Start<R, 2>& s) { return PolarCentralForce<R, TypedPotential>::from_reference(s); })};
}

MethodSpec method_taken(const Request& request) {
  const Choices& choices = request.variant;
  const std::size_t coordinates = find_problem(request.problem, choices)->dimension;
  if (request.problem != FormulaKeys::problem || choices.empty() ||
      unknowns_of_step(request.method, coordinates + clock_coordinates) < fewest_unknowns_by_fixed_points) {
    return request.method;
  }
  const auto model = std::make_shared<const formula::Model>(formula_texts(choices));
  return method_of({EntryModel(model), std::nullopt}, request);
}

ProblemEntry entry_of_model(const EntryModel& model, const std::optional<TypedField>& field) {
  const Typed typed{model, field};
  const auto problem_with = [model](const Texts& parameters) {
    return functions_of<double>(model, parameters).as<Capability::smooth>();
  };
  ProblemEntry e;
  e.momenta = model.momenta();
  e.structure = model.structure();
  e.dimension = model.size();
  e.has_distance = field.has_value();
  e.refused_size = [model](const Texts&, std::size_t size) { return refused_size(model, size); };
  e.refused_parameters = [](const Texts&) { return std::pair<std::string, std::string>(); };
  e.refused_start = [](const Texts&, const std::vector<double>&) { return StartRefusal(); };
  e.accepts = [model](const MethodSpec& method) { return accepts(model.structure(), method); };
  e.simulate = [](const Request&) { return std::unique_ptr<Simulation>(); };
  e.simulate_erased = [typed](const Request& request) -> std::unique_ptr<Simulation> {
    return simulated_in(request.arithmetic, [&]<class R>() { return simulate_in<R>(typed, request); });
  };
  e.simulate_member = [model](const Request& request, const Parameters<double>& parameters,
                              const std::vector<double>& q, const std::vector<double>& p, double h) {
    const std::size_t degrees = model.degrees();
    const ErasedRun<double> run{functions_of<double>(model, parameters), vector_of(q, degrees), vector_of(p, degrees),
                                h};
    Request as_taken = request;
    as_taken.method = with_cheaper_iteration(request.method, run.functions, run.q, run.p, h);
    return without_time(model, simulate_erased<double>(run, as_taken));
  };
  e.step_map = [model](const Request& request, std::size_t) -> std::unique_ptr<StepMap> {
    if (!accepts(model.structure(), request.method)) return nullptr;
    if (model.structure().time) {
      throw Error("found an H that depends on t; single steps can be measured only for an H without t");
    }
    return step_map_of([&]<class R>() { return functions_of<R>(model, request.parameters); }, request);
  };
  e.derived = [](const Texts& parameters, const StartSpec&) { return parameters; };
  e.conditions = [field](const Texts& parameters, const StartSpec& spec) {
    Conditions conditions;
    if (field) (void)orbit_of<double>(*field, parameters, spec, conditions);
    return conditions.all();
  };
  const std::size_t degrees = model.degrees();
  e.energy = [problem_with, degrees](const Texts& parameters, const std::vector<double>& q,
                                     const std::vector<double>& p) {
    return problem_with(parameters).energy(vector_of(q, degrees), vector_of(p, degrees));
  };
  e.gradient = [problem_with, degrees](const Texts& parameters, const std::vector<double>& q,
                                       const std::vector<double>& p) {
    Vector<double, dynamic> dq(degrees);
    Vector<double, dynamic> dp(degrees);
    problem_with(parameters).gradient(vector_of(q, degrees), vector_of(p, degrees), dq, dp);
    return EnergyGradient{{dq.begin(), dq.begin() + q.size()}, {dp.begin(), dp.begin() + q.size()}};
  };
  e.regular = [problem_with, degrees](const Texts& parameters, const std::vector<double>& q,
                                      const std::vector<double>& p) {
    Vector<double, dynamic> dq(degrees);
    Vector<double, dynamic> dp(degrees);
    const auto problem = problem_with(parameters);
    problem.gradient(vector_of(q, degrees), vector_of(p, degrees), dq, dp);
    double sum = abs(problem.energy(vector_of(q, degrees), vector_of(p, degrees)));
    for (std::size_t i = 0; i < dq.size(); ++i) sum += abs(dq[i]) + abs(dp[i]);
    return sum <= std::numeric_limits<double>::max();
  };
  e.invariant_sizes = [model](const Texts&, std::size_t) {
    return std::vector<std::size_t>(model.made()->invariants().size(), 1);
  };
  e.start = [typed, problem_with](const Request& request) {
    return frame_of(start_of<double>(typed, problem_with(request.parameters), request), typed.model.size());
  };
  if (model.structure().constraints > 0) {
    const auto bound = [model](const Texts& parameters) {
      return functions_of<double>(model, parameters)
          .as<Capability::constrained | Capability::separable | Capability::quadratic_kinetic>();
    };
    e.constraint_form = model.structure().multiplier ? FormulaKeys::multiplier : FormulaKeys::manifold;
    e.refused_start = [bound, degrees](const Texts& parameters, const std::vector<double>& q) -> StartRefusal {
      const auto rows = constraint_gradients(bound(parameters), vector_of(q, degrees));
      if (!are_linearly_dependent(rows)) return {};
      return {rows.size() == 1 ? "a constraint whose gradient vanishes at the start; allowed a constraint with a "
                                 "gradient other than 0 there"
                               : "constraints whose gradients are linearly dependent at the start; allowed "
                                 "independent constraints, fewer than coordinates"};
    };
    e.residuals = [bound, degrees](const Texts& parameters, const std::vector<double>& q,
                                   const std::vector<double>& p) {
      const auto problem = bound(parameters);
      const auto length = [](const Vector<double, dynamic>& x) { return std::sqrt(dot(x, x)); };
      const auto x = vector_of(q, degrees);
      return ConstraintResiduals{
          length(constraints(problem, x)),
          length(products(constraint_gradients(problem, x), inverse_mass_times(problem, vector_of(p, degrees))))};
    };
    e.onto_constraints = [bound, model, degrees](const Texts& parameters, const std::vector<double>& q,
                                                 const std::vector<double>& p) {
      StateOf<double> s{vector_of(q, degrees), vector_of(p, degrees)};
      move_onto_constraints(bound(parameters), s.q, s.p);
      return frame_of(s, model.size());
    };
  }
  if (field) {
    e.describe_orbit = [field](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      Start<double, 2> s{{q.at(0), q.at(1)}, {p.at(0), p.at(1)}};
      if (field->polar) s = to_cartesian(s);
      const TypedPotential<double> potential(field->radial, Parameters<double>(parameters));
      return facts_of(describe_central_orbit(potential, Parameters<double>(parameters)[CentralKeys::mass], s.q, s.p));
    };
  }
  return e;
}

}  // namespace hamflow
