// The functions of a catalogue entry in double, except its steps. They are called a few times per run, and compiled
// with light optimisation in the unit of the problem behind virtual calls.
#pragma once

#include "hamflow/detail/arithmetic/more_digits.hpp"
#include "hamflow/detail/run/probe.hpp"
#include "known_exact.hpp"
#include "problem_start.hpp"

namespace hamflow {

template <template <class> class Family>
class ProblemFacts : ProblemStart<Family> {
  using In = ProblemStart<Family>;
  using typename In::P;
  static constexpr std::size_t n = P::dimension;
  using In::refused_size;
  using In::vector_of;

 public:
  /// The entry without its simulations. The + turns lambdas into pointers, so that std::function has one wrapper for
  /// each signature, in place of one for each lambda of each problem.
  static ProblemEntry entry() {
    ProblemEntry e;
    e.info = P::info();
    e.dimension = n == dynamic ? 0 : n;
    e.has_distance = HasDistanceRate<P>;
    e.refused_size = refused_size;
    e.refused_parameters = +[](const Texts& parameters) -> std::pair<std::string, std::string> {
      if constexpr (HasRefusedParameters<P>) {
        return P::refused_parameters(Parameters<double>(parameters));
      } else {
        return {};
      }
    };
    e.refused_start = +[](const Texts& parameters, const std::vector<double>& q) -> StartRefusal {
      if constexpr (HasRefusedStart<P>) {
        return {P::refused_start(Parameters<double>(parameters), vector_of(q))};
      } else {
        return {};
      }
    };
    e.derived = +[](const Texts& parameters, const StartSpec& spec) {
      Texts all = parameters;
      if constexpr (HasDerive<P>) {
        Parameters<double> given(parameters);
        P::derive(spec.kind, Parameters<double>(spec.orbit), given);
        for (auto& [name, text] : all) {
          if (!given.has(name) || given.list(name).size() != 1) continue;
          if (!(abs(given[name]) <= std::numeric_limits<double>::max()))
            continue;  // the start is impossible; this is reported elsewhere
          if (text.empty() || given[name] != evaluate_number<double>(list_parts(text)[0])) text = shortest(given[name]);
        }
      }
      return all;
    };
    e.conditions = +[](const Texts& parameters, const StartSpec& spec) {
      Conditions conditions;
      if constexpr (HasStart<P>)
        (void)P::start(spec.kind, Parameters<double>(parameters), Parameters<double>(spec.orbit), conditions);
      return conditions.all();
    };
    e.energy = +[](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      return hamflow::energy(In::template make<double>(Parameters<double>(parameters), q.size()), vector_of(q),
                             vector_of(p));
    };
    e.gradient = gradient_of;
    e.regular = regular;
    e.invariant_sizes = +[](const Texts& parameters, std::size_t size) {
      return detail::invariant_sizes(In::template make<double>(Parameters<double>(parameters), size));
    };
    e.start = +[](const Request& request) { return frame_of(In::template start<double>(request)); };
    if constexpr (HasTotalMass<P>) {
      e.total_mass = +[](const Texts& parameters, std::size_t size) {
        return In::template make<double>(Parameters<double>(parameters), size).total_mass();
      };
    }
    if constexpr (HasChart<P>) {
      e.to_reference = +[](const Texts&, const std::vector<double>& q, const std::vector<double>& p) {
        return frame_of(P::to_reference({vector_of(q), vector_of(p)}));
      };
      e.from_reference = +[](const Texts&, const std::vector<double>& q, const std::vector<double>& p) {
        return frame_of(P::from_reference({vector_of(q), vector_of(p)}));
      };
    }
    if constexpr (HasExactRadius<P>) {
      e.exact_radius = +[](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).exact_radius(vector_of(q), vector_of(p));
      };
    }
    if constexpr (has_more_digits && HasExact<P>) {
      e.exact = exact;  // in long double
    }
    if constexpr (HasOrbitFacts<P>) {
      e.describe_orbit = +[](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
        return P(Parameters<double>(parameters)).describe_orbit(vector_of(q), vector_of(p));
      };
    }
    return e;
  }

 private:
  static Frame frame_of(const Start<double, n>& s) {
    Frame frame;
    frame.q.assign(s.q.begin(), s.q.end());
    frame.p.assign(s.p.begin(), s.p.end());
    return frame;
  }

  static EnergyGradient gradient_of(const Texts& parameters, const std::vector<double>& q,
                                    const std::vector<double>& p) {
    VectorOf<P> dq = vector_of(q);
    VectorOf<P> dp = vector_of(p);
    gradient(In::template make<double>(Parameters<double>(parameters), q.size()), vector_of(q), vector_of(p), dq, dp);
    return {{dq.begin(), dq.end()}, {dp.begin(), dp.end()}};
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
    const P problem = In::template make<double>(Parameters<double>(parameters), q.size());
    const LongMotion motion = [&](const LongState& z, long double time) -> std::optional<LongState> {
      auto at = cast<long double>(vector_of(q));
      auto momenta = at;
      for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = z[i];
        momenta[i] = z[at.size() + i];
      }
      const auto end = problem.exact(at, momenta, time);
      if (!end) return std::nullopt;
      LongState all(end->q.begin(), end->q.end());
      all.insert(all.end(), end->p.begin(), end->p.end());
      return all;
    };
    LongState start(q.begin(), q.end());
    start.insert(start.end(), p.begin(), p.end());
    std::vector<bool> is_angle;
    for (const std::string& coordinate : P::info().coordinates) is_angle.push_back(coordinate == "phi");
    const auto end = exact_state_if_accurate(motion, start, t, is_angle);
    if (!end) return std::nullopt;
    Frame frame;
    frame.time = t;
    frame.q.assign(end->begin(), end->begin() + static_cast<std::ptrdiff_t>(q.size()));
    frame.p.assign(end->begin() + static_cast<std::ptrdiff_t>(q.size()), end->end());
    return frame;
  }
};

}  // namespace hamflow
