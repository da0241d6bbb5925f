#include "gas_entry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bulk_gas.hpp"
#include "engine/made_entries.hpp"
#include "engine/mp_simulation.hpp"
#include "gas_functions.hpp"
#include "gas_lattice.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/walls.hpp"
#include "methods/recipes.hpp"
#include "methods/step_control.hpp"
#include "outside_simulation.hpp"
#include "problems/start_of_energy.hpp"

namespace hamflow {

namespace {

using Keys = GasKeys;
using Words = std::map<std::string, std::string>;
template <class R>
using GasState = Start<R, dynamic>;

constexpr const char* usual_pair = "lennard-jones";

std::string choice(const Words& choices, const char* key, const char* usual) {
  const auto found = choices.find(key);
  return found == choices.end() ? usual : found->second;
}

ParameterInfo number(const char* name, const char* usual, const char* meaning, Range range,
                     const char* condition = "") {
  return {.name = name, .default_value = usual, .meaning = meaning, .range = range, .condition = condition};
}

/// The choices of an entry and the data that all of its functions derive from them.
struct Kind {
  GasShape shape;
  Words choices;
  Texts typed_parameters;  // of phi, names to "?"
};

Kind kind_of(const Words& given) {
  Kind kind;
  kind.shape.pair = choice(given, Keys::pair, usual_pair);
  const std::string container = choice(given, Keys::container, ContainerNames::circle);
  const std::string cutoff = choice(given, Keys::cutoff_kind, CutoffNames::none);
  kind.shape.container = ContainerNames::kind(container);
  kind.shape.cutoff = CutoffNames::kind(cutoff);
  kind.choices = {{Keys::pair, kind.shape.pair}, {Keys::container, container}, {Keys::cutoff_kind, cutoff}};
  if (kind.shape.pair != Keys::typed) return kind;
  // phi is read as a central potential whose radius is the distance of a pair.
  Choices field{{FormulaKeys::coordinates, "cartesian"}};
  field[FormulaKeys::central_potential] = kind.choices[Keys::phi] = choice(given, Keys::phi, "");
  field[FormulaKeys::parameters] = kind.choices[Keys::parameters] = choice(given, Keys::parameters, "");
  const FormulaTexts texts = radial_formula_texts(field);
  kind.shape.typed = std::make_shared<const formula::Model>(texts);
  kind.typed_parameters = texts.parameters;
  kind.typed_parameters.erase(CentralKeys::mass);
  return kind;
}

std::string formula_of(const Kind& kind) {
  std::string phi = "phi(r) = " + choice(kind.choices, Keys::phi, "");
  for (const ProblemInfo& law : pair_laws()) {
    if (law.name == kind.shape.pair) phi = law.formula;
  }
  std::string h = "H = sum |p_i|^2/(2 m_i) + (1/S^2) sum_{i<j} phi(S r_ij)";
  if (kind.shape.container == ContainerKind::circle) h += " + 1/(2 S^(2+2e)) sum 1/(radius^2 - |q_i|^2)^e";
  return h + ", " + phi;
}

std::vector<ParameterInfo> parameters_of(const Kind& kind) {
  std::vector<ParameterInfo> all{
      {.name = Keys::masses,
       .default_value = "1",
       .meaning = "mass of all particles, or a mass for each. Masses do not enter phi, which is the same for every "
                  "pair (for gravity between unequal masses use n-body)",
       .range = Range::positive,
       .type = OptionType::number_or_list},
      number(Keys::dimension, "2", "dimension of space", Range::whole_from(2, 3)),
      number(Keys::scale, "1", "S: how many length units of the potential make one unit of the coordinates",
             Range::positive)};
  for (const ProblemInfo& law : pair_laws()) {
    if (law.name == kind.shape.pair) all.insert(all.end(), law.parameters.begin(), law.parameters.end());
  }
  for (const auto& [name, text] : kind.typed_parameters) {
    const bool list = text.starts_with("[");
    all.push_back({.name = name,
                   .meaning = list ? "a list" : "a number",
                   .type = list ? OptionType::list : OptionType::number,
                   .length = list ? list_parts(text).size() : 0,
                   .required = true});
  }
  if (kind.shape.container == ContainerKind::circle) {
    all.push_back(number(Keys::radius, "1.5", "radius of the circle or sphere", Range::positive));
    all.push_back(number(Keys::exponent, "1", "exponent e of the soft wall", {.least = 1}));
  }
  if (kind.shape.container == ContainerKind::periodic || kind.shape.container == ContainerKind::box) {
    all.push_back({.name = Keys::size,
                   .meaning = "edges of the box, which is centred at the origin",
                   .range = Range::positive,
                   .type = OptionType::list,
                   .required = true});
  }
  if (kind.shape.cutoff != CutoffKind::none) {
    all.push_back({.name = Keys::cutoff,
                   .meaning = "R, in length units of the potential",
                   .range = Range::positive,
                   .required = true});
    if (kind.shape.cutoff == CutoffKind::smooth) {
      all.push_back({.name = Keys::inner,
                     .meaning = "distance from which phi is reduced smoothly to 0",
                     .range = Range::positive,
                     .required = true});
    }
    all.push_back(number(Keys::skin, "0.3", "skin of the neighbour lists; does not change results", Range::positive));
  }
  return all;
}

std::vector<InvariantInfo> invariants_of(ContainerKind container) {
  std::vector<InvariantInfo> all;
  if (container == ContainerKind::none || container == ContainerKind::circle) {
    all.push_back({"angular_momentum", "sum x_i x p_i", Components::rotations, Terms::moments});
  }
  if (container == ContainerKind::none || container == ContainerKind::periodic) {
    all.push_back({"linear_momentum", "P = sum p_i", Components::space, Terms::momenta});
    all.push_back({"centre_of_mass", "sum m_i x_i/M - P t/M", Components::space, Terms::centre_of_mass});
  }
  return all;
}

std::string refused_size(const Texts& texts, std::size_t size) {
  const Parameters<double> given(texts);
  const auto space = static_cast<std::size_t>(given[Keys::dimension]);
  const std::size_t masses = given.list(Keys::masses).size();
  if (size == 0 || size % space != 0) return std::to_string(space) + " numbers for each particle";
  if (masses == 1 || masses * space == size) return {};
  return std::to_string(masses * space) + " numbers for the " + std::to_string(masses) + " particles of masses";
}

std::pair<std::string, std::string> refused_parameters(const Kind& kind, const Texts& texts) {
  const Parameters<double> given(texts);
  const auto space = static_cast<std::size_t>(given[Keys::dimension]);
  const auto& [pair, typed, container, cutoff] = kind.shape;
  const bool has_box = container == ContainerKind::periodic || container == ContainerKind::box;
  if (has_box && given.list(Keys::size).size() != space) {
    const std::size_t edges = given.list(Keys::size).size();
    return {std::string(Keys::container) + "." + Keys::size,
            "found " + std::to_string(edges) + (edges == 1 ? " edge" : " edges") + "; allowed " +
                std::to_string(space) + " edges, one for each of problem." + Keys::dimension};
  }
  if (cutoff == CutoffKind::smooth && !(given[Keys::inner] < given[Keys::cutoff])) {
    return {std::string(Keys::cutoff) + "." + Keys::inner, "found " + shortest(given[Keys::inner]) +
                                                               " with radius = " + shortest(given[Keys::cutoff]) +
                                                               "; allowed inner below radius"};
  }
  if (container != ContainerKind::periodic) return {};
  const std::vector<double>& edges = given.list(Keys::size);
  const double most = *std::min_element(edges.begin(), edges.end()) / 2 * given[Keys::scale];
  if (cutoff == CutoffKind::none) {
    return {Keys::container,
            "allowed with a cutoff of at most " + shortest(most) +
                ", half the shortest edge, because a particle interacts with the nearest image of each other particle"};
  }
  if (given[Keys::cutoff] <= most) return {};
  return {Keys::cutoff,
          "allowed at most " + shortest(most) + ", half the shortest edge of the periodic box (times scale)"};
}

/// Two particles (counted from 0) of a periodic box whose nearest images coincide.
std::optional<std::pair<std::size_t, std::size_t>> coinciding_images(const std::vector<double>& q,
                                                                     const std::vector<double>& edges) {
  const std::size_t space = edges.size();
  const auto in_box = [&](std::size_t i) {
    std::vector<double> place(space);
    for (std::size_t k = 0; k < space; ++k) {
      const double x = q[i * space + k];
      place[k] = x - edges[k] * std::floor(x / edges[k] + 0.5);
    }
    return place;
  };
  std::vector<std::pair<std::vector<double>, std::size_t>> places;
  for (std::size_t i = 0; i < q.size() / space; ++i) places.emplace_back(in_box(i), i);
  std::sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto [a, b] = std::minmax(places[i - 1].second, places[i].second);
    bool same = places[i - 1].first == places[i].first;
    for (std::size_t k = 0; same && k < space; ++k) {  // computed like the pair itself
      const double d = q[a * space + k] - q[b * space + k];
      same = d - edges[k] * std::nearbyint(d / edges[k]) == 0;
    }
    if (same) return std::pair<std::size_t, std::size_t>(a, b);
  }
  return std::nullopt;
}

/// Refuses particles outside the container, and two particles at one point, where phi is undefined.
StartRefusal refused_start(const Kind& kind, const Texts& texts, const std::vector<double>& q) {
  const Parameters<double> given(texts);
  const auto space = static_cast<std::size_t>(given[Keys::dimension]);
  const std::size_t particles = q.size() / space;
  for (std::size_t i = 0; i < particles; ++i) {
    double square = 0;
    for (std::size_t k = 0; k < space; ++k) square += q[i * space + k] * q[i * space + k];
    const bool outside =
        kind.shape.container == ContainerKind::circle && !(square < given[Keys::radius] * given[Keys::radius]);
    if (!outside) continue;
    return {"particle " + std::to_string(i + 1) + " at " + shortest(std::sqrt(square)) +
                " from the origin, on or beyond the soft wall; allowed below radius = " + shortest(given[Keys::radius]),
            Keys::radius,
            {i + 1}};
  }
  if (given.has("softening") && given["softening"] > 0) return {};
  std::vector<std::size_t> order(particles);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t i) { return q.begin() + static_cast<std::ptrdiff_t>(i * space); };
  const auto end = [&](std::size_t i) { return place(i) + static_cast<std::ptrdiff_t>(space); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(place(a), end(a), place(b), end(b));
  });
  for (std::size_t k = 1; k < particles; ++k) {
    const auto [a, b] = std::minmax(order[k - 1], order[k]);
    if (!std::equal(place(a), end(a), place(b))) continue;
    return {.message = "particles " + std::to_string(a + 1) + " and " + std::to_string(b + 1) +
                       " at one point; allowed different positions",
            .particles = {a + 1, b + 1}};
  }
  if (kind.shape.container != ContainerKind::periodic) return {};
  if (const auto same = coinciding_images(q, given.list(Keys::size))) {
    return {"particles " + std::to_string(same->first + 1) + " and " + std::to_string(same->second + 1) +
                " at images of the same point in the periodic box; allowed different positions in a box of size = [" +
                joined(given.list(Keys::size), shortest) + "]",
            Keys::size,
            {same->first + 1, same->second + 1}};
  }
  return {};
}

Vector<double, dynamic> vector_of(const std::vector<double>& x) {
  Vector<double, dynamic> v(x.size());
  std::copy(x.begin(), x.end(), v.begin());
  return v;
}

template <class R>
GasState<R> start_of(const Gas<R>& gas, const Request& request) {
  const StartSpec& spec = request.start;
  const auto with = [&](const R& free) {
    const auto read = [&](const std::vector<std::string>& texts) {
      Vector<R, dynamic> out(gas.size());
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = is_left_to_energy(texts.at(i)) ? free : evaluate_number<R>(texts.at(i));
      }
      return out;
    };
    GasState<R> s{read(spec.q), read(spec.v.empty() ? spec.p : spec.v)};
    for (std::size_t i = 0; !spec.v.empty() && i < s.p.size(); ++i) s.p[i] *= gas.model().masses[i / gas.space()];
    return s;
  };
  return spec.energy.empty() ? with(R(0)) : with(component_for_energy(energy_line(gas, with), request));
}

/// The request without the texts of its start, which are not kept once they are read: the texts of a million particles
/// take as much memory as their neighbour lists. (It names every member, so that a new member does not compile.)
Request without_start(const Request& request) {
  const auto& [problem, variant, walls, parameters, start, method, dt, arithmetic, functions, position_unit,
               momentum_unit, threads, watch, record] = request;
  return {problem,    variant,   walls,         parameters,    {},      method, dt,
          arithmetic, functions, position_unit, momentum_unit, threads, watch,  record};
}

/// Uses bulk forces if these know the pair law. Steps are then not recorded, since recorded sums have another order.
ErasedFunctions<double> with_bulk_forces_if_possible(ErasedFunctions<double> functions, const Gas<double>& gas,
                                                     const Parameters<double>& given, Request& request) {
  const double skin = given.has(Keys::skin) ? given[Keys::skin] : usual_skin;
  if (gas.particles() <= most_recorded_particles || !bulk_pair_system(gas, skin)) return functions;
  request.record = false;
  return with_bulk_forces(std::move(functions), gas, skin, static_cast<std::size_t>(request.threads));
}

StepInDouble step_in_double(const GasShape& shape, Request request);

template <class R>
std::unique_ptr<Simulation> simulate_in(const GasShape& shape, const Request& request) {
  const Parameters<R> given(request.parameters);
  const std::size_t size = request.start.q.size();
  if (const std::string why_not = refused_size(request.parameters, size); !why_not.empty()) {
    throw Error("a state of this gas has " + why_not + " for each of q and p, not " + std::to_string(size));
  }
  const Gas<R> gas = make_gas<R>(shape, given, size);
  GasState<R> s = start_of<R>(gas, request);
  const R h = evaluate_number<R>(request.dt);
  std::unique_ptr<Simulation> simulation;
  if constexpr (std::is_same_v<R, double>) {
    // Walls and steps of varying size need virtual calls.
    const bool needs_virtual_calls = request.walls || step_control_of(request.method).reversible;
    if (request.arithmetic == "lattice" && !needs_virtual_calls) {
      simulation = simulate_gas_on_lattice(gas, s.q, s.p, h, request);
    }
  }
  if (!simulation) {
    ErasedFunctions<R> functions = gas_functions<R>(shape, given, size);
    Request asked = without_start(request);
    if constexpr (std::is_same_v<R, double>)
      functions = with_bulk_forces_if_possible(std::move(functions), gas, given, asked);
    simulation = simulate_erased<R>({std::move(functions), std::move(s.q), std::move(s.p), h}, asked);
  }
  if (shape.container != ContainerKind::circle) return simulation;
  StepInDouble in_double;
  if constexpr (std::is_same_v<R, double>) {
    if (request.arithmetic == "lattice") in_double = step_in_double(shape, without_start(request));
  }
  return telling_who_is_outside(std::move(simulation), std::move(in_double));
}

/// A lattice refuses the kick of a particle very close to the soft wall. The same step in double shows where that kick
/// leads; sometimes the particle leaves the container only a few steps later.
StepInDouble step_in_double(const GasShape& shape, Request request) {
  constexpr int followed = 16;  // steps; after such a large kick a particle crosses the circle in fewer steps
  request.arithmetic = "double";
  request.threads = 1;
  request.watch = false;
  request.record = false;
  return [=](const Frame& from, bool backwards) -> std::string {
    Request asked = request;
    for (const double x : from.q) asked.start.q.push_back(shortest(x));
    for (const double x : from.p) asked.start.p.push_back(shortest(x));
    const auto simulation = simulate_in<double>(shape, asked);
    if (backwards) simulation->reverse_time();
    for (int further = 0; further < followed; ++further) {
      const Outcome outcome = simulation->advance(1);
      if (outcome == Outcome::done) continue;
      if (outcome != Outcome::outside) break;
      if (further == 0) return simulation->failure();
      return simulation->failure() + ", in double " + std::to_string(further) + (further == 1 ? " step" : " steps") +
             " later: on the lattice the kick that leads there is out of range";
    }
    return {};
  };
}

bool accepts(const GasShape& shape, const MethodSpec& method) {
  constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;
  const bool branches = shape.cutoff != CutoffKind::none || shape.container == ContainerKind::periodic;
  if (branches && method.name == "taylor") return false;  // a series cannot represent the end of phi
  return visit_method(method, [&](const auto& recipe) {
    if (shape.container == ContainerKind::none)
      return is_accepted<Erased<double, natural | Capability::radial>>(recipe);
    return is_accepted<Erased<double, natural>>(recipe);
  });
}

/// The distance within which two particles repel each other, in units of the coordinates: the distance of the minimum
/// of a Lennard-Jones pair's energy, or the cut-off if that is smaller; 0 for other laws.
double repulsion_of(const Kind& kind, const Parameters<double>& given) {
  if (kind.shape.pair != usual_pair) return 0;
  const bool usual_form = given.has("sigma") || given.has("epsilon");
  double least = usual_form ? pow(2.0, 1.0 / 6) * (given.has("sigma") ? given["sigma"] : 1) : 1;
  if (given.has(Keys::cutoff)) least = std::min(least, given[Keys::cutoff]);
  return least / given[Keys::scale];
}

ParticleFacts particles_of(const Kind& kind, const Texts& parameters) {
  const Parameters<double> given(parameters);
  ParticleFacts all{.space = static_cast<std::size_t>(given[Keys::dimension]), .masses = given.list(Keys::masses)};
  if (given.has(Keys::size)) all.edges = given.list(Keys::size);
  if (given.has(Keys::radius)) all.radius = given[Keys::radius];
  all.repulsion = repulsion_of(kind, given);
  return all;
}

void add_functions(ProblemEntry& e, const Kind& kind) {
  const GasShape& shape = kind.shape;
  const auto gas = [shape](const Texts& parameters, std::size_t size) {
    return make_gas<double>(shape, Parameters<double>(parameters), size);
  };
  e.refused_size = refused_size;
  e.refused_parameters = [kind](const Texts& parameters) { return refused_parameters(kind, parameters); };
  e.refused_start = [kind](const Texts& parameters, const std::vector<double>& q) {
    return refused_start(kind, parameters, q);
  };
  e.accepts = [shape](const MethodSpec& method) { return accepts(shape, method); };
  e.simulate = [](const Request&) { return std::unique_ptr<Simulation>(); };
  e.simulate_erased = [shape](const Request& request) -> std::unique_ptr<Simulation> {
    return simulated_in(request.arithmetic, [&]<class R>() { return simulate_in<R>(shape, request); });
  };
  e.simulate_member = [shape](const Request& request, const Parameters<double>& parameters,
                              const std::vector<double>& q, const std::vector<double>& p, double h) {
    Request asked = request;
    ErasedFunctions<double> functions =
        with_bulk_forces_if_possible(gas_functions<double>(shape, parameters, q.size()),
                                     make_gas<double>(shape, parameters, q.size()), parameters, asked);
    return simulate_erased<double>({std::move(functions), vector_of(q), vector_of(p), h}, asked);
  };
  e.step_map = [shape](const Request& request, std::size_t size) -> std::unique_ptr<StepMap> {
    if (!accepts(shape, request.method)) return nullptr;
    return step_map_of([&]<class R>() { return gas_functions<R>(shape, Parameters<R>(request.parameters), size); },
                       request);
  };
  e.derived = [](const Texts& parameters, const StartSpec&) { return parameters; };
  e.conditions = [](const Texts&, const StartSpec&) { return std::vector<Condition>(); };
  // With bulk forces if possible: a loop over all pairs of a million particles takes too long.
  const auto functions = [shape, gas](const Texts& parameters, std::size_t size) {
    const Parameters<double> given(parameters);
    Request any;
    return with_bulk_forces_if_possible(gas_functions<double>(shape, given, size), gas(parameters, size), given, any)
        .plain;
  };
  e.energy = [functions](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    return functions(parameters, q.size())->energy(vector_of(q), vector_of(p));
  };
  e.gradient = [gas, functions](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    Vector<double, dynamic> f(q.size());
    Vector<double, dynamic> v(q.size());
    functions(parameters, q.size())->force(vector_of(q), f);
    gas(parameters, q.size()).velocity(vector_of(p), v);
    EnergyGradient found{{f.begin(), f.end()}, {v.begin(), v.end()}};
    for (double& x : found.by_q) x = 0.0 - x;
    return found;
  };
  e.regular = [functions](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    const auto problem = functions(parameters, q.size());
    Vector<double, dynamic> f(q.size());
    problem->force(vector_of(q), f);
    double sum = std::abs(problem->energy(vector_of(q), vector_of(p)));
    for (const double x : f) sum += std::abs(x);
    return sum <= std::numeric_limits<double>::max();
  };
  e.has_pairwise_forces = true;
  e.has_cutoff = shape.cutoff != CutoffKind::none;
  e.container = kind.choices.at(Keys::container);
  e.particles = [kind](const Texts& parameters) { return particles_of(kind, parameters); };
  e.invariant_sizes = [gas](const Texts& parameters, std::size_t size) {
    const auto sizes = gas(parameters, size).invariant_sizes();
    return std::vector<std::size_t>(sizes.begin(), sizes.end());
  };
  e.start = [gas](const Request& request) {
    const GasState<double> s = start_of<double>(gas(request.parameters, request.start.q.size()), request);
    Frame frame;
    frame.q.assign(s.q.begin(), s.q.end());
    frame.p.assign(s.p.begin(), s.p.end());
    return frame;
  };
  e.total_mass = [gas](const Texts& parameters, std::size_t size) { return gas(parameters, size).total_mass(); };
}

ProblemEntry entry_of(const Words& choices) {
  const Kind kind = kind_of(choices);
  ProblemEntry e;
  ProblemInfo& info = e.info;
  info.name = Keys::problem;
  // The entry of the list has no variant, because its keys are more than these words.
  for (const char* key : {Keys::pair, Keys::container, Keys::cutoff_kind, Keys::phi, Keys::parameters}) {
    const auto found = kind.choices.find(key);
    if (!choices.empty() && found != kind.choices.end()) info.variant.push_back(*found);
  }
  info.formula = formula_of(kind);
  info.reference = "Sonnleitner2010, ch. 1.7, 3a";
  info.coordinates = {"x1", "y1", "(z1)", "x2", "..."};
  info.parameters = parameters_of(kind);
  info.keys = all_gas_options();
  const GasOptions& o = gas_options();
  info.file_key = o.file.name;
  info.invariants = invariants_of(kind.shape.container);
  // Three particles near their equilibrium distance, far from the wall.
  info.region = {.parameters = {{Keys::radius, "3"}},
                 .centre = {0, 0, 1.1, 0.1, 0.4, 1.05, 0.1, 0.15, -0.1, 0.2, 0.1, -0.2},
                 .spread = 0.03,
                 .step = 0.011,
                 .time = 1.3};
  info.example.steps = 1000;
  info.example.keys = {{o.particles_per_side.name, "5"},
                       {o.start.name, ""},
                       {o.seed.name, ""},  // a second is enough
                       {o.pair.name, ""},
                       {o.scale.name, ""},
                       {o.container.name, ""}};
  add_functions(e, kind);
  return e;
}

}  // namespace

std::string gas_that_accepts(const MethodSpec& method, const std::map<std::string, std::string>& choices) {
  const Kind kind = kind_of(choices);
  if (accepts(kind.shape, method)) return {};
  GasShape open = kind.shape;
  open.container = ContainerKind::none;
  GasShape whole = kind.shape;
  whole.cutoff = CutoffKind::none;
  GasShape both = open;
  both.cutoff = CutoffKind::none;
  const std::string found = kind.choices.at(Keys::container);
  const std::string no_container = std::string("with container = { kind = \"") + ContainerNames::none +
                                   "\" } (found kind = \"" + found + "\"" +
                                   (found == ContainerNames::circle ? ", the default)" : ")");
  const std::string no_cutoff = "without cutoff, at which phi ends";
  if (accepts(open, method)) return "only " + no_container;
  if (accepts(whole, method)) return "only " + no_cutoff;
  return accepts(both, method) ? "only " + no_container + " and " + no_cutoff : "";
}

const std::vector<ProblemInfo>& pair_laws() {
  static const std::vector<ProblemInfo> laws = built_in_pairs();
  return laws;
}

std::shared_ptr<const ProblemEntry> gas_problem(const std::map<std::string, std::string>& choices) {
  static MadeEntries<Words> made;
  return made.find(choices, [&] { return entry_of(choices); });
}

}  // namespace hamflow
