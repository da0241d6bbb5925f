// One problem behind virtual calls, in every number type, with its catalogue entry. The build makes one translation
// unit of it per problem.
#pragma once

#include <algorithm>

#include "engine/double_constants.hpp"
#include "engine/erased.hpp"
#include "engine/mp_simulation.hpp"
#include "problem_facts.hpp"

namespace hamflow {

template <template <class> class Family>
class ErasedUnit : ProblemStart<Family> {
  using In = ProblemStart<Family>;
  static constexpr std::size_t n = In::n;

 public:
  static ErasedEntry entry() {
    ErasedEntry e{ProblemFacts<Family>::entry(), simulate, step_map};
    e.simulate_member = +[](const Request& request, const Parameters<double>& parameters, const std::vector<double>& q,
                            const std::vector<double>& p, double h) {
      const auto moved = [](const std::vector<double>& x) {
        auto y = zeros<double, dynamic>(x.size());
        std::copy(x.begin(), x.end(), y.begin());
        return y;
      };
      return simulate_erased<double>(
          {functions_of<double>(In::template make<double>(parameters, q.size())), moved(q), moved(p), h}, request);
    };
    if constexpr (has_more_digits && HasChart<Family<double>>) {
      e.to_reference = +[](const std::string& arithmetic, const DigitState& state) {
        return in_arithmetic(arithmetic, [&]<class R>() { return texts_of(Family<R>::to_reference(read<R>(state))); });
      };
      e.from_reference = +[](const std::string& arithmetic, const DigitState& state) {
        return in_arithmetic(arithmetic,
                             [&]<class R>() { return texts_of(Family<R>::from_reference(read<R>(state))); });
      };
    }
    return e;
  }

 private:
  static std::unique_ptr<Simulation> simulate(const Request& request) {
    return simulated_in(request.arithmetic, [&]<class R>() { return simulate_in<R>(request); });
  }

  template <class R>
  static std::unique_ptr<Simulation> simulate_in(const Request& request) {
    const auto s = In::template start<R>(request);
    const Family<R> problem = problem_of<R>(request, s.q.size());
    const auto moved = [](const auto& x) {
      auto y = zeros<R, dynamic>(x.size());
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = x[i];
      return y;
    };
    return simulate_erased<R>({functions_of<R>(problem), moved(s.q), moved(s.p), evaluate_number<R>(request.dt)},
                              request);
  }

  /// Constants derived from the parameters, such as m omega^2, computed in the arithmetic of the run or in double.
  template <class R>
  static Family<R> problem_of(const Request& request, std::size_t size) {
    if constexpr (!std::is_same_v<R, double> && std::is_constructible_v<Family<R>, const Family<double>&>) {
      if (DoubleConstants::are_in_use()) {
        return Family<R>(In::template make<double>(In::template parameters_of<double>(request), size));
      }
    }
    return In::template make<R>(In::template parameters_of<R>(request), size);
  }

  template <class R>
  static Start<R, n> read(const DigitState& state) {
    Start<R, n> s{zeros<R, n>(state.q.size()), zeros<R, n>(state.q.size())};
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      s.q[i] = evaluate_number<R>(state.q.at(i));
      s.p[i] = evaluate_number<R>(state.p.at(i));
    }
    return s;
  }
  template <class R>
  static DigitState texts_of(const Start<R, n>& s) {
    DigitState state;
    for (const R& x : s.q) state.q.push_back(written_digits(x));
    for (const R& x : s.p) state.p.push_back(written_digits(x));
    return state;
  }

  template <class R>
  static ErasedFunctions<R> functions_of(const Family<R>& problem) {
    ErasedFunctions<R> all{capabilities_of<Family<R>>(), degrees_of_freedom(problem), hamflow::functions_of<R>(problem),
                           hamflow::functions_of<Trace<R>>(problem), nullptr};
    if constexpr (std::is_same_v<R, double>) {
      all.dual = hamflow::functions_of<Dual<double, 1>>(problem);
    }
    return all;
  }

  static std::unique_ptr<StepMap> step_map(const Request& request, std::size_t size) {
    return step_map_of(
        [&]<class R>() { return functions_of<R>(In::template make<R>(Parameters<R>(request.parameters), size)); },
        request);
  }
};

}  // namespace hamflow
