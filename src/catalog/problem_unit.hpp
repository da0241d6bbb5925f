// Everything the catalogue offers for one problem. The build makes one translation unit of it per file of problems/ and
// of problems/potentials/: a new problem is a new file and nothing else.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/problems/support/fast_kernel.hpp"
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
    e.dimension = n == dynamic ? 0 : n;
    e.refused_size = refused_size;
    e.refused_parameters = [](const Texts& parameters) -> std::pair<std::string, std::string> {
      if constexpr (requires(const Parameters<double>& p) { P::refused_parameters(p); }) {
        return P::refused_parameters(Parameters<double>(parameters));
      } else if constexpr (requires(const Parameters<double>& p) { P::problem_with(p); }) {
        return {"", P::problem_with(Parameters<double>(parameters))};
      } else {
        return {};
      }
    };
    e.refused_start = [](const Texts& parameters, const std::vector<double>& q) -> std::string {
      if constexpr (requires(const Parameters<double>& p, VectorOf<P> x) { P::refused_start(p, x); }) {
        return P::refused_start(Parameters<double>(parameters), vector_of(q));
      } else {
        return {};
      }
    };
    e.accepts = [](const MethodSpec& method) {
      return visit_method(method, [](const auto& recipe) { return is_accepted<P>(recipe); });
    };
    e.has_fast_kernel = has_fast_kernel;
    e.simulate = simulate;
    e.step_map = step_map;
    e.derived = [](const Texts& parameters, const StartSpec& spec) {
      Texts all = parameters;
      if constexpr (has_derived) {
        Parameters<double> given(parameters);
        P::derive(spec.kind, Parameters<double>(spec.orbit), given);
        for (auto& [name, text] : all) {
          if (!given.has(name) || given.list(name).size() != 1) continue;
          if (!(abs(given[name]) <= std::numeric_limits<double>::max())) continue;  // the start cannot be: it is told
          if (text.empty() || given[name] != evaluate_number<double>(list_parts(text)[0])) text = shortest(given[name]);
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
      return hamflow::energy(make<double>(Parameters<double>(parameters), q.size()), vector_of(q), vector_of(p));
    };
    e.regular = regular;
    e.invariant_sizes = [](const Texts& parameters, std::size_t size) {
      const P problem = make<double>(Parameters<double>(parameters), size);
      return detail::invariant_sizes(problem, P::info().invariants.size());
    };
    e.start = [](const Request& request) {
      const auto s = start<double>(request);
      Frame frame;
      frame.q.assign(s.q.begin(), s.q.end());
      frame.p.assign(s.p.begin(), s.p.end());
      return frame;
    };
    if constexpr (requires(const P& problem, VectorOf<P> x) { problem.exact_radius(x, x); }) {
      e.exact_radius = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).exact_radius(vector_of(q), vector_of(p));
      };
    }
    if constexpr (requires(const P& problem, VectorOf<P, long double> x) { problem.exact(x, x, 1.0L); }) {
      e.exact = exact;
    }
    if constexpr (requires(const P& problem, VectorOf<P> x) { problem.describe_orbit(x, x); }) {
      e.describe_orbit = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).describe_orbit(vector_of(q), vector_of(p));
      };
    }
    return e;
  }

 private:
  static constexpr bool has_derived = requires(Parameters<double> & p) { P::derive(std::string(), p, p); };
  static constexpr bool has_starts = requires(Conditions & c) {
    P::start(std::string(), Parameters<double>(), Parameters<double>(), c);
  };
  static constexpr bool has_fast_kernel = requires(const P& problem, VectorOf<P>& x) { problem.fast_force(x, x); };

  /// The problem; one of any size is told its number of coordinates.
  template <class R>
  static Family<R> make(const Parameters<R>& parameters, [[maybe_unused]] std::size_t size) {
    if constexpr (n == dynamic) {
      return Family<R>(parameters, size);
    } else {
      return Family<R>(parameters);
    }
  }

  static VectorOf<P> vector_of(const std::vector<double>& x) {
    VectorOf<P> v = zeros<double, n>(x.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = x[i];
    return v;
  }

  static std::string refused_size(const Texts& parameters, std::size_t size) {
    if constexpr (n == dynamic) {
      return P::refused_size(Parameters<double>(parameters), size);
    } else {
      return size == n ? std::string() : std::to_string(n) + (n == 1 ? " number" : " numbers");
    }
  }

  static bool regular(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    const P problem = make<double>(Parameters<double>(parameters), q.size());
    VectorOf<P> dq = vector_of(q);
    VectorOf<P> dp = vector_of(p);
    gradient(problem, vector_of(q), vector_of(p), dq, dp);
    double sum = abs(hamflow::energy(problem, vector_of(q), vector_of(p)));
    for (std::size_t i = 0; i < dq.size(); ++i) sum += abs(dq[i]) + abs(dp[i]);
    return sum <= std::numeric_limits<double>::max();
  }

  static std::optional<Frame> exact(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p,
                                    double t) {
    const auto end = make<double>(Parameters<double>(parameters), q.size())
                         .exact(cast<long double>(vector_of(q)), cast<long double>(vector_of(p)), t);
    if (!end) return std::nullopt;
    Frame frame;
    frame.time = t;
    for (const long double x : end->q) frame.q.push_back(static_cast<double>(x));
    for (const long double x : end->p) frame.p.push_back(static_cast<double>(x));
    return frame;
  }

  /// In the arithmetic of the run, with what follows from the start.
  template <class R>
  static Parameters<R> parameters_of(const Request& request) {
    Parameters<R> parameters(request.parameters);
    if constexpr (has_derived) {
      if (!request.start.geometric()) return parameters;
      Family<R>::derive(request.start.kind, Parameters<R>(request.start.orbit), parameters);
    }
    return parameters;
  }

  template <class R>
  static Start<R, n> start(const Request& request) {
    const StartSpec& spec = request.start;
    Start<R, n> s;
    if (spec.geometric()) {
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
    const auto fill = [&](const std::vector<std::string>& texts, Vector<R, n>& out) {
      const std::string why_not = refused_size(request.parameters, texts.size());
      if (!why_not.empty()) {
        throw Error("a state of this problem has " + why_not + " for each of q and p, not " +
                    std::to_string(texts.size()));
      }
      out = zeros<R, n>(texts.size());
      for (std::size_t i = 0; i < texts.size(); ++i) out[i] = evaluate_number<R>(texts[i]);
    };
    fill(spec.q, s.q);
    fill(spec.v.empty() ? spec.p : spec.v, s.p);
    if (!spec.v.empty()) s.p = momenta_of(make<R>(parameters_of<R>(request), s.q.size()), s.q, s.p);
    return s;
  }

  /// p = dL/dv for H at most quadratic in p: v = dH/dp(q, p) solved for p.
  template <class R>
  static Vector<R, n> momenta_of(const Family<R>& problem, const Vector<R, n>& q, const Vector<R, n>& v) {
    if constexpr (QuadraticKinetic<P>) {
      return apply(inverse(inverse_mass_matrix(problem)), v);
    } else {
      const Vector<R, n> zero = zeros_like(q);
      Vector<R, n> force_at_rest = zero;
      Vector<R, n> drift = zero;  // dH/dp at p = 0
      Matrix<R, n> qq = zero_matrix(q);
      Matrix<R, n> qp = qq;
      Matrix<R, n> pp = qq;
      gradient(problem, q, zero, force_at_rest, drift);
      hessian(problem, q, zero, qq, qp, pp);
      Vector<R, n> rest = v;
      for (std::size_t i = 0; i < v.size(); ++i) rest[i] -= drift[i];
      const Vector<R, n> p = solve(pp, rest);
      Vector<R, n> check = zero;
      gradient(problem, q, p, force_at_rest, check);
      R defect(0);
      R size(0);
      for (std::size_t i = 0; i < v.size(); ++i) {
        defect += abs(check[i] - v[i]);
        size += abs(check[i]) + abs(v[i]) + abs(drift[i]);
      }
      if (!(size <= std::numeric_limits<R>::max()) || !(defect <= R(1e6) * std::numeric_limits<R>::epsilon() * size)) {
        throw Error(
            "velocities do not determine the momenta of this H: it is not quadratic in p, or its mass matrix "
            "is singular there; give p");
      }
      return p;
    }
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

  template <class A, template <class> class Problems = Family, class Recipe>
  static std::unique_ptr<Simulation> build(const Request& request, const Recipe& recipe) {
    using R = typename A::Real;
    const auto s = start<R>(request);
    const Problems<R> problem{make<R>(parameters_of<R>(request), s.q.size())};
    const R h = evaluate_number<R>(request.dt);
    auto method = recipe.template bind<Problems<R>, A>(problem);
    using M = decltype(method);
    // Without a probe: what is worth it, being bound by the step alone.
    if constexpr (std::is_same_v<A, Plain<double>> && !std::is_same_v<Recipe, TableRecipe<Shape::any>> &&
                  n != dynamic) {
      if (!request.watch) {
        return std::make_unique<SimulationOf<Problems<R>, M, A, NoProbe>>(problem, method, s.q, s.p, h,
                                                                          arithmetic_of<A>(request));
      }
    }
    return std::make_unique<SimulationOf<Problems<R>, M, A>>(problem, method, s.q, s.p, h, arithmetic_of<A>(request));
  }

  template <class R>
  using Fast = FastKernel<Family<R>>;

  static std::unique_ptr<Simulation> simulate(const Request& request) {
    return visit_method(request.method, [&]<class Recipe>(const Recipe& recipe) -> std::unique_ptr<Simulation> {
      if constexpr (!Recipe::template accepts<P>) {
        return nullptr;  // make_simulation has said why
      } else if constexpr (always_compensated<Recipe>()) {
        return build<Compensated<double>>(request, recipe);
      } else {
        if constexpr (has_fast_kernel) {
          if (request.kernel == "fast") {
            if (request.arithmetic == "compensated") {
              return build<Compensated<double>, Fast>(request, with_shape_at_run_time(recipe));
            }
            return build<Plain<double>, Fast>(request, recipe);
          }
        }
        if (request.arithmetic == "compensated") {
          return build<Compensated<double>>(request, with_shape_at_run_time(recipe));
        }
        if constexpr (Recipe::bijective) {
          if (request.arithmetic == "lattice") return build<Lattice>(request, with_shape_at_run_time(recipe));
        }
        return build<Plain<double>>(request, recipe);
      }
    });
  }

  static std::unique_ptr<StepMap> step_map(const Texts& parameters, const MethodSpec& method, std::size_t size) {
    const auto make_it = [&]<class R>() { return make<R>(Parameters<R>(parameters), size); };
    return visit_method(method, [&]<class Recipe>(const Recipe& recipe) -> std::unique_ptr<StepMap> {
      if constexpr (Recipe::template accepts<P>) {
        if (!is_accepted<P>(recipe)) return nullptr;
        auto shared = with_shape_at_run_time(recipe);
        return std::make_unique<StepMapOf<Family, decltype(shared)>>(make_it, shared);
      } else {
        return nullptr;
      }
    });
  }
};

}  // namespace hamflow
