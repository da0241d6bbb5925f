// Sum of powers V(r) = sum_i a_i r^(n_i + 1), the force -(n_i + 1) a_i r^n_i.   [Gross1999, Sect. 2.5]
// n real, not -1. As a function of u = r^2: W(u) = sum a u^e with e = (n + 1)/2; whole and half exponents are products
// and square roots, the others powers.
#pragma once

#include <optional>

#include "hamflow/detail/problems/central_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Power {
 public:
  Power(const std::vector<R>& a, const std::vector<R>& n) {
    for (std::size_t i = 0; i < a.size(); ++i) terms_.push_back(Term(a[i], n[i]));
  }
  explicit Power(const Parameters<R>& given) : Power(given.list("a"), given.list("n")) {}
  /// Converts the potential from another number type.
  template <class Q>
  explicit Power(const Power<Q>& other) {
    for (const auto& term : other.terms_) terms_.push_back(Term(R(term.a), R(term.twice) - R(1)));
  }

  static ProblemInfo info() {
    return {
        .name = "power",
        .formula = "V(r) = sum_i a_i r^(n_i + 1)",
        .reference = "Gross1999, Sect. 2.5",
        .parameters = {{.name = "a",
                        .meaning = "strengths a, a number or a list as long as n",
                        .type = OptionType::number_or_list,
                        .required = true},
                       {.name = "n",
                        .meaning = "exponents n of the force, real numbers other than -1",
                        .type = OptionType::number_or_list,
                        .required = true}},
        .starts = {start_by_energy({{"energy", "0.5"}, {"angular_momentum", "1"}})},
        .region = {
            .parameters = {{"a", "[0.5, -0.5]"}, {"n", "[2, -2.5]"}}, .centre = {1.2, 0.3, -0.2, 0.9}, .step = 0.04}};
  }
  /// The error of the parameters as key and message; both empty if they are accepted.
  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    if (given.list("a").size() != given.list("n").size()) {
      return {"n", "allowed as many numbers as in a, " + std::to_string(given.list("a").size())};
    }
    for (const R& n : given.list("n")) {
      if (n == R(-1)) return {"n", "allowed any real number except -1 (V would be a logarithm)"};
    }
    return {};
  }

  template <class S>
  S value(const S& u) const {
    S sum(0);
    for (const Term& term : terms_) sum += power(u, term) * term.a;
    return sum;
  }
  template <class S>
  S slope(const S& u) const {
    S sum(0);
    for (const Term& term : terms_) {
      const Term lower = term.derived();
      if (lower.a != R(0)) sum += power(u, lower) * (R(2) * lower.a);
    }
    return sum;
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    CentralDerivatives<S> d{slope(u), S(0)};
    for (const Term& term : terms_) {
      const Term second = term.derived().derived();
      if (second.a != R(0)) d.curvature += power(u, second) * (R(4) * second.a);
    }
    return d;
  }

  /// The state after time t, by quadrature.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return central_flow(*this, mass, q, p, t);
  }

 private:
  template <class>
  friend class Power;
  /// a u^(twice/2), `whole` where twice is a small whole number.
  struct Term {
    Term(R strength, R n) : a(strength), twice(n + R(1)) {
      const double e = static_cast<double>(twice);
      whole = e == static_cast<double>(static_cast<int>(e < 40 && e > -40 ? e : 0)) && e < 40 && e > -40;
      if (whole) half_steps = static_cast<int>(e);
    }
    /// d/du: a e u^(e - 1).
    Term derived() const {
      Term t = *this;
      t.a = a * (twice / R(2));
      t.twice = twice - R(2);
      t.half_steps -= 2;
      return t;
    }
    R a;
    R twice;  // 2 e
    bool whole = false;
    int half_steps = 0;
  };

  template <class S>
  static S power(const S& u, const Term& term) {
    if (!term.whole) return pow(u, term.twice / R(2));
    const int steps = term.half_steps < 0 ? -term.half_steps : term.half_steps;
    S result(1);
    S square = u;
    for (int k = steps / 2; k > 0; k /= 2) {
      if (k % 2 == 1) result = result * square;
      square = square * square;
    }
    if (steps % 2 == 1) result = result * sqrt(u);
    return term.half_steps < 0 ? S(R(1)) / result : result;
  }

  std::vector<Term, PoolAllocator<Term>> terms_;  // from a pool, because steps with a cyclic angle copy them
};

}  // namespace hamflow
