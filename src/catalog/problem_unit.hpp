// Everything the catalogue offers for one problem. The build makes one translation unit of it per file of problems/ and
// of problems/potentials/: a new problem is a new file and nothing else.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/verify/step_map_of.hpp"
#include "recipes.hpp"

namespace hamflow {

template <template <class> class Family>
class ProblemUnit {
  using P = Family<double>;
  static constexpr std::size_t n = P::dimension;

 public:
  static ProblemEntry entry() {
    ProblemEntry e;
    e.info = P::info();
    e.dimension = n;
    e.simulate = simulate;
    e.step_map = step_map;
    e.derived = [](const Texts& parameters, const StartSpec& spec) {
      Texts all = parameters;
      if constexpr (has_derived) {
        Parameters<double> given(parameters);
        P::derive(spec.kind, Parameters<double>(spec.orbit), given);
        for (auto& [name, text] : all) {
          if (given[name] != evaluate_number<double>(text)) text = shortest(given[name]);
        }
      }
      return all;
    };
    e.conditions = [](const Texts& parameters, const StartSpec& spec) {
      Conditions conditions;
      if constexpr (has_starts)
        (void)P::start(spec.kind, Parameters<double>(parameters), Parameters<double>(spec.orbit), conditions);
      return conditions.all();
    };
    e.energy = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      return hamflow::energy(P(Parameters<double>(parameters)), vector_of(q), vector_of(p));
    };
    e.regular = regular;
    e.start = [](const Request& request) {
      const auto s = start<double>(P(parameters_of<double>(request)), request);
      Frame frame;
      frame.q.assign(s.q.begin(), s.q.end());
      frame.p.assign(s.p.begin(), s.p.end());
      return frame;
    };
    if constexpr (requires(const P& problem, Vector<double, n> x) { problem.exact_radius(x, x); }) {
      e.exact_radius = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).exact_radius(vector_of(q), vector_of(p));
      };
    }
    return e;
  }

 private:
  static constexpr bool has_derived = requires(Parameters<double> & p) { P::derive(std::string(), p, p); };
  static constexpr bool has_starts = requires(Conditions & c) {
    P::start(std::string(), Parameters<double>(), Parameters<double>(), c);
  };

  static Vector<double, n> vector_of(const std::vector<double>& x) {
    Vector<double, n> v{};
    for (std::size_t i = 0; i < n; ++i) v[i] = x[i];
    return v;
  }

  static bool regular(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    const P problem{Parameters<double>(parameters)};
    Vector<double, n> dq{};
    Vector<double, n> dp{};
    gradient(problem, vector_of(q), vector_of(p), dq, dp);
    double sum = abs(hamflow::energy(problem, vector_of(q), vector_of(p)));
    for (std::size_t i = 0; i < n; ++i) sum += abs(dq[i]) + abs(dp[i]);
    return sum <= std::numeric_limits<double>::max();
  }

  /// In the arithmetic of the run, with what follows from the start.
  template <class R>
  static Parameters<R> parameters_of(const Request& request) {
    Parameters<R> parameters(request.parameters);
    if constexpr (has_derived) {
      if (!request.start.kind.empty()) {
        Family<R>::derive(request.start.kind, Parameters<R>(request.start.orbit), parameters);
      }
    }
    return parameters;
  }

  template <class R>
  static Start<R, n> start(const Family<R>& problem, const Request& request) {
    const StartSpec& spec = request.start;
    Start<R, n> s;
    if (!spec.kind.empty()) {
      if constexpr (has_starts) {
        Conditions conditions;
        s = Family<R>::start(spec.kind, parameters_of<R>(request), Parameters<R>(spec.orbit), conditions);
        for (const Condition& c : conditions.all()) {
          if (!c.holds()) throw Error(c.key + ": the start needs " + c.statement);
        }
        for (R& x : s.p) x = R(spec.direction) * x;
      }
      return s;
    }
    const auto fill = [](const std::vector<std::string>& texts, Vector<R, n>& out) {
      if (texts.size() != n) {
        throw Error("a state of this problem has " + std::to_string(n) + " coordinates, not " +
                    std::to_string(texts.size()));
      }
      for (std::size_t i = 0; i < n; ++i) out[i] = evaluate_number<R>(texts[i]);
    };
    fill(spec.q, s.q);
    fill(spec.v.empty() ? spec.p : spec.v, s.p);
    if (!spec.v.empty()) s.p = apply(inverse(inverse_mass_matrix(problem)), s.p);
    return s;
  }

  template <class A>
  static A arithmetic_of(const Request& request) {
    A arithmetic;
    if constexpr (A::exact_undo) {
      arithmetic.position.set_unit(request.position_unit);
      arithmetic.momentum.set_unit(request.momentum_unit);
    }
    return arithmetic;
  }

  template <class A, class Recipe>
  static std::unique_ptr<Simulation> build(const Request& request, const Recipe& recipe) {
    using R = typename A::Real;
    const Family<R> problem{parameters_of<R>(request)};
    const auto s = start<R>(problem, request);
    const R h = evaluate_number<R>(request.dt);
    auto method = recipe.template bind<Family<R>, A>(problem);
    using M = decltype(method);
    if constexpr (std::is_same_v<A, Plain<double>> || Recipe::implicit) {
      if (!request.watch) {
        return std::make_unique<SimulationOf<Family<R>, M, A, NoProbe>>(problem, method, s.q, s.p, h,
                                                                        arithmetic_of<A>(request));
      }
    }
    return std::make_unique<SimulationOf<Family<R>, M, A>>(problem, method, s.q, s.p, h, arithmetic_of<A>(request));
  }

  static std::unique_ptr<Simulation> simulate(const Request& request) {
    return visit_method(request.method, [&]<class Recipe>(const Recipe& recipe) -> std::unique_ptr<Simulation> {
      // What an implicit element adds to the state is always compensated.
      if constexpr (Recipe::implicit) {
        return build<Compensated<double>>(request, recipe);
      } else {
        if (request.arithmetic == "compensated") return build<Compensated<double>>(request, recipe);
        if constexpr (Recipe::bijective) {
          if (request.arithmetic == "lattice") return build<Lattice>(request, recipe);
        }
        return build<Plain<double>>(request, recipe);
      }
    });
  }

  static std::unique_ptr<StepMap> step_map(const Texts& parameters, const MethodSpec& method) {
    const auto make = [&]<class R>() { return Family<R>(Parameters<R>(parameters)); };
    return visit_method(method, [&]<class Recipe>(const Recipe& recipe) -> std::unique_ptr<StepMap> {
      return std::make_unique<StepMapOf<Family, Recipe>>(make, recipe);
    });
  }
};

}  // namespace hamflow
