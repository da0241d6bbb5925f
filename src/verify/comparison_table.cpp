// Writes a comparison as a plain table and as CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aligned.hpp"
#include "hamflow/verify/comparison.hpp"

namespace hamflow {

namespace {
std::string time_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

/// Quotes a text for a field of a CSV file if necessary.   [RFC4180]
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.17g}", x) : ""; }
std::string number(const Magnitude& x) { return x.text.empty() ? number(x.value) : x.text; }

/// An error that is not above the uncertainty of the reference is written as a bound: the true error is at most twice
/// the uncertainty.
std::string error_text(const ComparisonPoint& p, const Magnitude& uncertainty) {
  if (p.error.value == 0 && p.error.text.empty() && !p.below_uncertainty) return "0";
  if (!p.below_uncertainty) return readable(p.error, 2);
  return "< " + readable(Magnitude(2 * uncertainty.value));
}
/// Returns whether the evaluations of the method are coefficients of a series instead of forces.
bool is_series(const ComparisonPoint& p) {
  return !find_method(p.method.substr(0, p.method.find('('))).family->counts_forces;
}
}  // namespace

std::string comparison_table(const Comparison& c) {
  Lines lines{{"method", "order", "dt", "steps", "evals/step", "evaluations", "error", "relative energy error",
               "at the end", "time"}};
  std::string last;
  int order = 0;
  for (const ComparisonPoint& p : c.points) {
    // the order of taylor depends on the tolerance, so it may differ within a method
    const bool is_repeated = p.method == last && p.order == order;
    std::vector<std::string> line{p.method == last ? "" : p.method, is_repeated ? "" : std::to_string(p.order),
                                  p.tolerance ? fmt::format("tol {:.0e}", *p.tolerance) : fmt::format("{:.6g}", p.dt),
                                  std::to_string(p.steps)};
    last = p.method;
    order = p.order;
    if (p.done()) {
      const double per_step = p.evaluations() / static_cast<double>(p.steps);
      for (const std::string& text : {fmt::format("{:.4g}", per_step), fmt::format("{:.0f}", p.evaluations()),
                                      error_text(p, c.reference.uncertainty), readable(p.max_energy_error),
                                      readable(p.end_energy_error), time_text(p.seconds)}) {
        line.push_back(text);
      }
    } else {
      line.push_back("failed: " + p.failure);
    }
    lines.push_back(line);
  }
  std::string text = fmt::format("{}, t = {}, {} arithmetic\nreference: {}", c.problem, shortest(c.t_end), c.arithmetic,
                                 c.reference.description);
  if (c.reference.kind == "none") return text + "\n";
  text += fmt::format("; uncertainty {}\nerrors: relative to the size of a coordinate or momentum along the motion\n\n",
                      readable(c.reference.uncertainty)) +
          aligned(lines);
  Lines best{{"error", "fewest evaluations", "", "", "least time", "", ""}};
  const std::vector<ComparisonWinner> all = winners(c);
  for (const ComparisonWinner& w : all) {
    if (w.by != "evaluations") continue;
    std::vector<std::string> line{readable(w.error, 0), w.method, fmt::format("{:.3g}", w.work),
                                  w.second.empty() ? "" : fmt::format("(then {}, {:.3g})", w.second, w.second_work)};
    for (const ComparisonWinner& t : all) {
      if (t.by != "seconds" || t.error.log10 != w.error.log10) continue;
      line.push_back(t.method);
      line.push_back(time_text(t.work));
      line.push_back(t.second.empty() ? "" : fmt::format("(then {}, {})", t.second, time_text(t.second_work)));
    }
    best.push_back(line);
  }
  if (best.size() > 1) text += "\n" + aligned(best);
  if (std::any_of(c.points.begin(), c.points.end(), [](const ComparisonPoint& p) { return is_series(p); })) {
    text +=
        "\nAn evaluation of taylor is one coefficient of its series, which costs more than a force evaluation; "
        "compare\n"
        "the times.\n";
  }
  return text;
}

std::string comparison_csv(const Comparison& c) {
  std::string text =
      "method,order,dt,tolerance,steps,status,force,gradient,hessian,linear_solves,error,max_energy_error,"
      "end_energy_error,seconds,reason,below_uncertainty\n";
  for (const ComparisonPoint& p : c.points) {
    const auto measured = [&](const auto& x) { return p.done() ? number(x) : std::string(); };
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", field(p.method), p.order, number(p.dt),
                        p.tolerance ? number(*p.tolerance) : "", p.steps, p.done() ? "done" : "failed", p.force,
                        p.gradient, p.hessian, p.linear_solves, measured(p.error), measured(p.max_energy_error),
                        measured(p.end_energy_error), measured(p.seconds), field(p.failure),
                        p.done() ? (p.below_uncertainty ? "true" : "false") : "");
  }
  return text;
}

}  // namespace hamflow
