// What the catalogue offers of a typed Hamiltonian: as ProblemUnit and ErasedUnit do of a problem that is a type.
#include "erased.hpp"
#include "hamflow/run/formula_functions.hpp"
#include "mp_simulation.hpp"
#include "problem_start.hpp"
#include "recipes.hpp"
#include "timed_simulation.hpp"
#include "typed_problem.hpp"

namespace hamflow {

namespace {

template <class R>
using FormulaFace = Erased<R, Capability::smooth>;

using ModelPointer = std::shared_ptr<const formula::Model>;

template <class R>
ErasedFunctions<R> functions_of(const ModelPointer& model, const Parameters<R>& parameters) {
  const auto bound = std::make_shared<const formula::BoundModel<R>>(model, parameters);
  ErasedFunctions<R> all{capabilities_of(model->structure()), model->degrees(),
                         std::make_shared<FormulaFunctions<R, R>>(bound),
                         std::make_shared<FormulaFunctions<R, Trace<R>>>(bound), nullptr};
  if constexpr (std::is_same_v<R, double>) all.dual = std::make_shared<FormulaFunctions<R, Dual<double, 1>>>(bound);
  return all;
}

template <class R>
ErasedFunctions<R> functions_of(const ModelPointer& model, const Texts& parameters) {
  return functions_of<R>(model, Parameters<R>(parameters));
}

std::string refused_size(const ModelPointer& model, std::size_t size) {
  const std::size_t n = model->size();
  return size == n ? std::string() : std::to_string(n) + (n == 1 ? " number" : " numbers");
}

template <class R>
using StateOf = Start<R, dynamic>;

/// As ProblemStart does it; geometric starts there are none.
template <class R>
StateOf<R> start_of(const ModelPointer& model, const FormulaFace<R>& problem, const Request& request) {
  const StartSpec& spec = request.start;
  const auto with = [&](const R& free) {
    const auto read = [&](const std::vector<std::string>& texts) {
      if (const std::string why_not = refused_size(model, texts.size()); !why_not.empty()) {
        throw Error("a state of this problem has " + why_not + " for each of q and p, not " +
                    std::to_string(texts.size()));
      }
      Vector<R, dynamic> out(model->degrees());  // the time and its momentum begin at 0
      for (std::size_t i = 0; i < texts.size(); ++i) {
        out[i] = is_left_to_energy(texts[i]) ? free : evaluate_number<R>(texts[i]);
      }
      return out;
    };
    StateOf<R> s{read(spec.q), read(spec.v.empty() ? spec.p : spec.v)};
    if (!spec.v.empty()) s.p = ProblemStart<FormulaFace>::template momenta_of<R>(problem, s.q, s.p);
    return s;
  };
  return spec.energy.empty() ? with(R(0)) : with(left_to_energy(energy_line(problem, with), spec));
}

std::unique_ptr<Simulation> without_time(const ModelPointer& model, std::unique_ptr<Simulation> simulation) {
  if (!model->structure().time || !simulation) return simulation;
  return std::make_unique<TimedSimulation>(std::move(simulation));
}

template <class R>
std::unique_ptr<Simulation> simulate_in(const ModelPointer& model, const Request& request) {
  const ErasedFunctions<R> functions = functions_of<R>(model, request.parameters);
  const StateOf<R> s = start_of<R>(model, functions.template as<Capability::smooth>(), request);
  return without_time(model, simulate_erased<R>({functions, s.q, s.p, evaluate_number<R>(request.dt)}, request));
}

bool accepts(Capability offered, const MethodSpec& method) {
  constexpr Capability separable = Capability::separable;
  constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;
  return visit_method(method, [&](const auto& recipe) {
    if (includes(offered, natural)) return is_accepted<Erased<double, natural>>(recipe);
    if (includes(offered, separable)) return is_accepted<Erased<double, separable>>(recipe);
    return is_accepted<Erased<double, Capability::smooth>>(recipe);
  });
}

/// @param size degrees of freedom: the time begins at 0
Vector<double, dynamic> vector_of(const std::vector<double>& x, std::size_t size) {
  Vector<double, dynamic> v(size);
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = x[i];
  return v;
}

/// @param size coordinates that have names
Frame frame_of(const StateOf<double>& s, std::size_t size) {
  Frame frame;
  frame.q.assign(s.q.begin(), s.q.begin() + size);
  frame.p.assign(s.p.begin(), s.p.begin() + size);
  return frame;
}

}  // namespace

ProblemEntry entry_of_model(std::shared_ptr<const formula::Model> model) {
  const auto face = [model](const Texts& parameters) {
    return functions_of<double>(model, parameters).as<Capability::smooth>();
  };
  const Capability offered = capabilities_of(model->structure());
  ProblemEntry e;
  e.momenta = model->momenta();
  e.structure = model->structure();
  e.dimension = model->size();
  e.refused_size = [model](const Texts&, std::size_t size) { return refused_size(model, size); };
  e.refused_parameters = [](const Texts&) { return std::pair<std::string, std::string>(); };
  e.refused_start = [](const Texts&, const std::vector<double>&) { return std::string(); };
  e.accepts = [offered](const MethodSpec& method) { return accepts(offered, method); };
  e.simulate = [](const Request&) { return std::unique_ptr<Simulation>(); };
  e.simulate_erased = [model](const Request& request) -> std::unique_ptr<Simulation> {
    if (request.arithmetic == "double-double") return simulate_in<DoubleDouble>(model, request);
    if (request.arithmetic == "quad") return simulate_in<Quad>(model, request);
    if (const int digits = mp_digits(request.arithmetic); digits > 0) {
      const MpDigits scope(digits);
      return with_digits(digits, simulate_in<Mp>(model, request));
    }
    return simulate_in<double>(model, request);
  };
  e.simulate_member = [model](const Request& request, const Parameters<double>& parameters,
                              const std::vector<double>& q, const std::vector<double>& p, double h) {
    const std::size_t degrees = model->degrees();
    return without_time(model, simulate_erased<double>({functions_of<double>(model, parameters), vector_of(q, degrees),
                                                        vector_of(p, degrees), h},
                                                       request));
  };
  e.step_map = [model, offered](const Texts& parameters, const MethodSpec& method,
                                std::size_t) -> std::unique_ptr<StepMap> {
    if (!accepts(offered, method)) return nullptr;
    if (model->structure().time) {
      throw Error("found an H that depends on t; allowed H without t where single steps are measured");
    }
    return erased_step_map({functions_of<double>(model, parameters), functions_of<long double>(model, parameters),
                            functions_of<Quad>(model, parameters)},
                           method);
  };
  e.derived = [](const Texts& parameters, const StartSpec&) { return parameters; };
  e.conditions = [](const Texts&, const StartSpec&) { return std::vector<Condition>(); };
  const std::size_t degrees = model->degrees();
  e.energy = [face, degrees](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    return face(parameters).energy(vector_of(q, degrees), vector_of(p, degrees));
  };
  e.rates = [face, degrees](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    Vector<double, dynamic> dq(degrees);
    Vector<double, dynamic> dp(degrees);
    face(parameters).gradient(vector_of(q, degrees), vector_of(p, degrees), dq, dp);
    return std::vector<double>(dp.begin(), dp.begin() + q.size());
  };
  e.regular = [face, degrees](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    Vector<double, dynamic> dq(degrees);
    Vector<double, dynamic> dp(degrees);
    const auto problem = face(parameters);
    problem.gradient(vector_of(q, degrees), vector_of(p, degrees), dq, dp);
    double sum = abs(problem.energy(vector_of(q, degrees), vector_of(p, degrees)));
    for (std::size_t i = 0; i < dq.size(); ++i) sum += abs(dq[i]) + abs(dp[i]);
    return sum <= std::numeric_limits<double>::max();
  };
  e.invariant_sizes = [model](const Texts&, std::size_t) {
    return std::vector<std::size_t>(model->invariants().size(), 1);
  };
  e.start = [model, face](const Request& request) {
    return frame_of(start_of<double>(model, face(request.parameters), request), model->size());
  };
  return e;
}

}  // namespace hamflow
