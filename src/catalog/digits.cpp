#include "hamflow/detail/run/digits.hpp"

#include <algorithm>

#include "catalog_lists.hpp"  // generated from the folder of problems
#include "hamflow/formula/problem_texts.hpp"
#include "problems/constrained_problems.hpp"
#include "problems/typed_problem.hpp"

namespace hamflow {

std::size_t longest_digits(const std::string& arithmetic) {
  check_arithmetic(arithmetic);
  const auto with = [](std::size_t digits, std::size_t exponent) { return 1 + digits + 1 + exponent; };  // sign, point
  if (arithmetic == "double-double") return with(98, 5);                                                 // e-308
  if (arithmetic == "quad") return with(36, 6);                                                          // e-4932
  const int d = mp_digits(arithmetic);
  if (d == 0) return 0;
  const MpDigits scope(d);
  return with(decimal_places(MpDigits::bits()), 21);  // exponents of MPFR have up to 62 bits
}

namespace {
/// The maps between an entry's chart and the reference chart; empty for the reference chart.
DigitCharts charts_of(const ProblemEntry& problem, const Texts& parameters) {
  static const std::vector<ErasedEntry> all = generated_erased();
  const auto number = static_cast<std::size_t>(&problem - problems().data());
  if (number >= all.size()) {
    if (problem.info.name != CentralKeys::problem) return constrained_digit_charts(problem, parameters);
    return problem.to_reference ? polar_digit_charts() : DigitCharts();
  }
  return {all[number].to_reference, all[number].from_reference};
}
}  // namespace

DigitState in_chart_of(const ProblemEntry& to, const ProblemEntry& from, const Texts& parameters,
                       const std::string& arithmetic, const DigitState& state) {
  if (&to == &from) return state;
  const DigitCharts before = charts_of(from, parameters);
  const DigitCharts behind = charts_of(to, parameters);
  DigitState now = before.to_reference ? before.to_reference(arithmetic, state) : state;
  return behind.from_reference ? behind.from_reference(arithmetic, now) : now;
}

std::string turned(const std::string& angle, std::int64_t turns, const std::string& arithmetic) {
  if (turns == 0) return angle;
  return sum_of(angle, std::to_string(turns) + "*2*pi", arithmetic);
}

std::string sum_of(const std::string& a, const std::string& b, const std::string& arithmetic) {
  const std::string sum = "(" + a + ") + (" + b + ")";
  return in_arithmetic(arithmetic, [&]<class R>() { return written_digits(evaluate_number<R>(sum)); });
}

std::vector<long double> differences_from_first(const std::vector<std::string>& texts) {
  std::size_t longest = 0;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  // All digits of the texts, and the digits of a long double for the differences.
  const MpDigits scope(static_cast<int>(std::clamp<std::size_t>(longest + 24, MpDigits::fewest, MpDigits::most)));
  std::vector<long double> differences;
  differences.reserve(texts.size());
  Mp first;
  for (const std::string& text : texts) {
    const Mp x = evaluate_number<Mp>(text);
    if (differences.empty()) first = x;
    differences.push_back(static_cast<long double>(x - first));
  }
  return differences;
}

}  // namespace hamflow
