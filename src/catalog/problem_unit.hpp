// Everything the catalogue offers for one problem. The build makes one translation unit of it per file of problems/ and
// of problems/potentials/: a new problem is a new file and nothing else.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/problems/support/fast_kernel.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "problem_start.hpp"
#include "recipes.hpp"

namespace hamflow {

template <template <class> class Family>
class ProblemUnit : ProblemStart<Family> {
  using In = ProblemStart<Family>;
  using typename In::P;
  static constexpr std::size_t n = P::dimension;
  using In::refused_size;
  using In::vector_of;

 public:
  static ProblemEntry entry() {
    ProblemEntry e;
    e.info = P::info();
    e.dimension = n == dynamic ? 0 : n;
    e.refused_size = refused_size;
    e.refused_parameters = [](const Texts& parameters) -> std::pair<std::string, std::string> {
      if constexpr (HasRefusedParameters<P>) {
        return P::refused_parameters(Parameters<double>(parameters));
      } else {
        return {};
      }
    };
    e.refused_start = [](const Texts& parameters, const std::vector<double>& q) -> std::string {
      if constexpr (HasRefusedStart<P>) {
        return P::refused_start(Parameters<double>(parameters), vector_of(q));
      } else {
        return {};
      }
    };
    e.accepts = [](const MethodSpec& method) {
      return visit_method(method, [](const auto& recipe) { return is_accepted<P>(recipe); });
    };
    e.has_fast_kernel = has_fast_kernel;
    e.has_pairwise_forces = PairwiseForces<P>;
    e.simulate = simulate;
    e.derived = [](const Texts& parameters, const StartSpec& spec) {
      Texts all = parameters;
      if constexpr (HasDerive<P>) {
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
      if constexpr (HasStart<P>)
        (void)P::start(spec.kind, Parameters<double>(parameters), Parameters<double>(spec.orbit), conditions);
      return conditions.all();
    };
    e.energy = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      return hamflow::energy(In::template make<double>(Parameters<double>(parameters), q.size()), vector_of(q),
                             vector_of(p));
    };
    e.rates = rates;
    e.regular = regular;
    e.invariant_sizes = [](const Texts& parameters, std::size_t size) {
      return detail::invariant_sizes(In::template make<double>(Parameters<double>(parameters), size));
    };
    e.start = [](const Request& request) { return frame_of(In::template start<double>(request)); };
    if constexpr (HasTotalMass<P>) {
      e.total_mass = [](const Texts& parameters, std::size_t size) {
        return In::template make<double>(Parameters<double>(parameters), size).total_mass();
      };
    }
    if constexpr (HasChart<P>) {
      e.to_reference = [](const std::vector<double>& q, const std::vector<double>& p) {
        return frame_of(P::to_reference({vector_of(q), vector_of(p)}));
      };
      e.from_reference = [](const std::vector<double>& q, const std::vector<double>& p) {
        return frame_of(P::from_reference({vector_of(q), vector_of(p)}));
      };
    }
    if constexpr (HasExactRadius<P>) {
      e.exact_radius = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).exact_radius(vector_of(q), vector_of(p));
      };
    }
    if constexpr (HasExact<P>) {
      e.exact = exact;
    }
    if constexpr (HasOrbitFacts<P>) {
      e.describe_orbit = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).describe_orbit(vector_of(q), vector_of(p));
      };
    }
    return e;
  }

 private:
  static constexpr bool has_fast_kernel = HasFastForce<P>;

  static Frame frame_of(const Start<double, n>& s) {
    Frame frame;
    frame.q.assign(s.q.begin(), s.q.end());
    frame.p.assign(s.p.begin(), s.p.end());
    return frame;
  }

  static std::vector<double> rates(const Texts& parameters, const std::vector<double>& q,
                                   const std::vector<double>& p) {
    VectorOf<P> dq = vector_of(q);
    VectorOf<P> dp = vector_of(p);
    gradient(In::template make<double>(Parameters<double>(parameters), q.size()), vector_of(q), vector_of(p), dq, dp);
    return {dp.begin(), dp.end()};
  }
  static bool regular(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    const P problem = In::template make<double>(Parameters<double>(parameters), q.size());
    VectorOf<P> dq = vector_of(q);
    VectorOf<P> dp = vector_of(p);
    gradient(problem, vector_of(q), vector_of(p), dq, dp);
    double sum = abs(hamflow::energy(problem, vector_of(q), vector_of(p)));
    for (std::size_t i = 0; i < dq.size(); ++i) sum += abs(dq[i]) + abs(dp[i]);
    return sum <= std::numeric_limits<double>::max();
  }

  static std::optional<Frame> exact(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p,
                                    double t) {
    const auto end = In::template make<double>(Parameters<double>(parameters), q.size())
                         .exact(cast<long double>(vector_of(q)), cast<long double>(vector_of(p)), t);
    if (!end) return std::nullopt;
    Frame frame;
    frame.time = t;
    for (const long double x : end->q) frame.q.push_back(static_cast<double>(x));
    for (const long double x : end->p) frame.p.push_back(static_cast<double>(x));
    return frame;
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

  template <class A, template <class> class Problems = Family, class M>
  static std::unique_ptr<Simulation> build(const Request& request, const M& recipe) {
    using R = typename A::Real;
    const auto s = In::template start<R>(request);
    const Problems<R> problem{In::template make<R>(In::template parameters_of<R>(request), s.q.size())};
    const R h = evaluate_number<R>(request.dt);
    auto method = recipe.template bind<Problems<R>, A>(problem);
    using Stepper = decltype(method);
    if constexpr (requires { method.use_threads(1); }) method.use_threads(static_cast<std::size_t>(request.threads));
    // Without a probe where the benchmark looks at the step alone, and where the step runs on several threads and the
    // probe would run on one; elsewhere it is not worth the compiler's time.
    if constexpr ((std::is_same_v<A, Plain<double>> && !std::is_same_v<M, TableRecipe<Shape::any>> &&
                   has_fast_kernel) ||
                  (A::exact_undo && n == dynamic)) {
      if (!request.watch) {
        return std::make_unique<SimulationOf<Problems<R>, Stepper, A, NoProbe>>(problem, method, s.q, s.p, h,
                                                                                arithmetic_of<A>(request));
      }
    }
    return std::make_unique<SimulationOf<Problems<R>, Stepper, A>>(problem, method, s.q, s.p, h,
                                                                   arithmetic_of<A>(request));
  }

  template <class R>
  using Fast = FastKernel<Family<R>>;

  /// Null where the request has no typed kernel: it then runs behind virtual calls, and what can be recorded is.
  static std::unique_ptr<Simulation> simulate(const Request& request) {
    return visit_method(request.method, [&]<class M>(const M& recipe) -> std::unique_ptr<Simulation> {
      if constexpr (!M::template accepts<P> || !has_typed_kernel<M>()) {
        return nullptr;
      } else if constexpr (always_compensated<M>()) {
        if (n == dynamic && request.start.q.size() > most_dense_unknowns) return nullptr;  // cg(1) without a matrix
        return build<Compensated<double>>(request, recipe);
      } else {
        if constexpr (has_fast_kernel) {
          if (request.kernel == "fast") {
            if (request.arithmetic == "compensated") {
              return build<Compensated<double>, Fast>(request, with_few_shapes(recipe));
            }
            return build<Plain<double>, Fast>(request, recipe);
          }
        }
        if constexpr (M::bijective) {
          if (request.arithmetic == "lattice") return build<Lattice>(request, with_shape_at_run_time(recipe));
        }
        if constexpr (!is_recorded<M>()) {
          return request.arithmetic == "double" ? build<Plain<double>>(request, recipe) : nullptr;
        } else if constexpr (n == dynamic && M::bijective) {  // of more bodies than fit into straight code
          if (request.arithmetic == "double") return build<Plain<double>>(request, with_shape_at_run_time(recipe));
          if (request.arithmetic == "compensated") {
            return build<Compensated<double>>(request, with_shape_at_run_time(recipe));
          }
        }
        return nullptr;
      }
    });
  }
};

}  // namespace hamflow
