// Makes a problem and its start from the texts of a request, in any number type.
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/numerics/dense.hpp"
#include "hamflow/run/catalog.hpp"
#include "start_of_energy.hpp"

namespace hamflow {

template <template <class> class Family>
struct ProblemStart {
  using P = Family<double>;
  static constexpr std::size_t n = P::dimension;

  /// The problem; a problem of any size receives its number of coordinates.
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

  /// The parameters in the arithmetic of the run, including those that follow from the start.
  template <class R>
  static Parameters<R> parameters_of(const Request& request) {
    Parameters<R> parameters(request.parameters);
    if constexpr (HasDerive<P>) {
      if (!request.start.geometric()) return parameters;
      Family<R>::derive(request.start.kind, Parameters<R>(request.start.orbit), parameters);
    }
    return parameters;
  }

  template <class R>
  static Start<R, n> start(const Request& request) {
    const StartSpec& spec = request.start;
    if (!spec.energy.empty()) {
      const Family<R> problem = make<R>(parameters_of<R>(request), spec.q.size());
      const auto at = [&](const R& free) { return start_with<R>(request, free); };
      return at(component_for_energy(energy_line(problem, at), request));
    }
    return start_with<R>(request, R(0));
  }

  /// @param free the component that the energy determines, if any
  template <class R>
  static Start<R, n> start_with(const Request& request, const R& free) {
    const StartSpec& spec = request.start;
    Start<R, n> s;
    if (spec.geometric()) {
      if constexpr (HasStart<P>) {
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
      for (std::size_t i = 0; i < texts.size(); ++i) {
        out[i] = is_left_to_energy(texts[i]) ? free : evaluate_number<R>(texts[i]);
      }
    };
    fill(spec.q, s.q);
    fill(spec.v.empty() ? spec.p : spec.v, s.p);
    if (!spec.v.empty()) s.p = momenta_of(make<R>(parameters_of<R>(request), s.q.size()), s.q, s.p);
    if constexpr (HasBarycentre<P>) {
      if (spec.barycentric) make<R>(parameters_of<R>(request), s.q.size()).to_barycentre(s.q, s.p);
    }
    return s;
  }

  /// p = dL/dv for H at most quadratic in p: v = dH/dp(q, p) solved for p.
  /// @param moved number of coordinates with given velocities; the coordinates after them hold the time, with p = 0
  template <class R>
  static Vector<R, n> momenta_of(const Family<R>& problem, const Vector<R, n>& q, Vector<R, n> v,
                                 std::size_t moved = dynamic) {
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
      for (std::size_t i = moved; i < v.size(); ++i) {
        v[i] = drift[i];
        pp[i][i] = R(1);
      }
      Vector<R, n> rest = v;
      for (std::size_t i = 0; i < v.size(); ++i) rest[i] -= drift[i];
      const Vector<R, n> p = solve(pp, rest);
      Vector<R, n> check = zero;
      gradient(problem, q, p, force_at_rest, check);
      // Masses may differ by many powers of ten, so the terms of the velocities are summed in units of sqrt(mass) v. If
      // that sum is 1/epsilon times the velocities, these do not determine the momenta.
      const R epsilon = std::numeric_limits<R>::epsilon();
      R given(0);
      R terms(0);
      bool is_linear = true;
      for (std::size_t i = 0; i < v.size(); ++i) {
        const R size = abs(v[i]) + abs(drift[i]);
        R sum = size;
        for (std::size_t j = 0; j < v.size(); ++j) sum += abs(pp[i][j] * p[j]);
        const R root = sqrt(R(abs(pp[i][i])));
        given += root > R(0) ? size / root : size;
        terms += root > R(0) ? sum / root : sum;
        is_linear = is_linear && abs(check[i] - v[i]) <= R(1e6) * epsilon * sum;
      }
      if (!(terms <= std::numeric_limits<R>::max()) || !(R(16) * epsilon * terms <= given)) {
        throw Error("velocities do not determine the momenta: the mass matrix is singular at this start; give p");
      }
      if (!is_linear) throw Error("velocities determine momenta only if H is quadratic in p; give p");
      return p;
    }
  }
};

}  // namespace hamflow
