#include "reversal_measures.hpp"

#include <cmath>
#include <limits>

#include "hamflow/detail/verify/magnitude.hpp"

namespace hamflow {

namespace {

/// Returns the norm of the difference of two lists of numbers, divided by `divisor`.
LongNumber difference_over(const std::vector<double>& a, const std::vector<double>& b,
                           const std::vector<std::string>& to, const std::vector<std::string>& from, double divisor) {
  std::vector<LongNumber> all;
  for (std::size_t i = 0; i < a.size(); ++i) {
    all.push_back(to.empty() ? LongNumber(std::abs(a[i] - b[i])) : largest_difference({to[i]}, {from[i]}));
  }
  LongNumber most;
  for (const LongNumber& x : all) {
    if (!at_most(x, most)) most = x;
  }
  if (most.value == 0 && most.text.empty()) return 0;
  double squares = 0;
  for (const LongNumber& x : all) {
    const double part = quotient(x, most);
    squares += part * part;
  }
  const double factor = std::sqrt(squares) / divisor;
  return most.text.empty() ? LongNumber(most.value * factor) : times(factor, most.text);
}

double log10_of(const LongNumber& x) { return x.text.empty() ? std::log10(x.value) : Magnitude(x.text).log10; }

/// Returns log10 of half of the epsilon of an arithmetic.
double log10_of_unit(const std::string& arithmetic) {
  const double half = std::log10(0.5);
  if (arithmetic == "double-double") return half - 104 * std::log10(2.0);
  if (arithmetic == "quad") return half - 112 * std::log10(2.0);
  const int digits = mp_digits(arithmetic);
  return digits > 0 ? half - digits : -53 * std::log10(2.0);
}

}  // namespace

std::size_t bodies_in(const Scenario& scenario) {
  const Texts& parameters = scenario.request.parameters;
  const std::size_t size = scenario.start_q.size();
  if (scenario.problem->particles) return size / scenario.problem->particles(parameters).space;
  const std::vector<InvariantInfo>& invariants = scenario.problem->info.invariants;
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    if (invariants[i].components == Components::space) {
      return size / scenario.problem->invariant_sizes(parameters, size).at(i);
    }
  }
  return 0;
}

double digits_lost(const Reversal& reversal, const std::string& arithmetic) {
  const LongNumber& lost = reversal.relative_distance;
  if (lost.value == 0 && lost.text.empty()) return 0;
  return log10_of(lost) - log10_of_unit(arithmetic);
}

BodyReversalError return_error(const Reversal& reversal, std::size_t bodies) {
  const auto n = static_cast<double>(bodies);
  const Frame& a = reversal.end;
  const Frame& b = reversal.start;
  const auto in_q = [&](double divisor) { return difference_over(a.q, b.q, a.digits.q, b.digits.q, divisor); };
  const auto in_p = [&](double divisor) { return difference_over(a.p, b.p, a.digits.p, b.digits.p, divisor); };
  return {in_q(n), in_p(n), in_q(std::sqrt(n)), in_p(std::sqrt(n))};
}

}  // namespace hamflow
