#include "hamflow/workflow/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "json_text.hpp"
#include "summary.hpp"
#include "summary_fields.hpp"
#include "terminal.hpp"
#include "warnings.hpp"
#include "work_precision.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Writes a number, as text if it is too small for a double.
Json json_of(const Magnitude& x) { return x.text.empty() ? Json(x.value) : Json(x.text); }

/// Returns the hint for a run that failed.
std::string hint_of(const ComparisonPoint& p, const ComparisonRequest& asked) {
  Request request = asked.request;
  const std::vector<std::string> names = comparison_names(asked.methods);
  const auto name = std::find(names.begin(), names.end(), p.method);
  if (name != names.end()) request.method = asked.methods[static_cast<std::size_t>(name - names.begin())];
  return hint_for(request, false, p.outcome, p.failure);
}

Json row_of(const ComparisonPoint& p, const ComparisonRequest& asked) {
  Json row{
      {"method", p.method},
      {"order", p.order},
      {"dt", p.dt},
      {"steps", p.steps},
      {"status", status_of(p.outcome)},
      {"evaluations",
       {{"force", p.force}, {"gradient", p.gradient}, {"hessian", p.hessian}, {"linear_solves", p.linear_solves}}}};
  if (p.tolerance) row["tolerance"] = *p.tolerance;
  const auto measured = [&](const Magnitude& x) { return p.done() ? json_of(x) : Json(nullptr); };
  row["error"] = measured(p.error);
  row["differences"] = p.done() ? Json::object() : Json(nullptr);
  for (const auto& [of, difference] : p.differences) row["differences"][of] = json_of(difference);
  row["max_energy_error"] = measured(p.max_energy_error);
  row["end_energy_error"] = measured(p.end_energy_error);
  row["seconds"] = measured(p.seconds);
  row["wall_seconds"] = measured(p.wall_seconds);
  if (p.below_uncertainty) row["below_uncertainty"] = true;
  if (!p.done()) {
    row["kind"] = std::string(name(p.outcome));
    row["reason"] = p.failure;
    row["hint"] = hint_of(p, asked);
  }
  return row;
}

/// Returns, for a gas, one warning that tells in how many runs particles may pass through each other within a step. Its
/// numbers are those of the largest such step, at the start and, if it is known, at the end of the exact motion.
std::vector<Warning> warnings_of(const Comparison& c, const ComparisonRequest& asked) {
  std::vector<Warning> all;
  const auto problem_entry = find_problem(asked.request);
  const ProblemEntry& problem = *problem_entry;
  if (!problem.particles) return all;
  const Frame start = problem.start(asked.request);
  Frame end = start;
  if (c.reference.kind != "none") {
    const auto middle = c.reference.end.begin() + static_cast<std::ptrdiff_t>(start.q.size());
    end.q.assign(c.reference.end.begin(), middle);
    end.p.assign(middle, c.reference.end.end());
  }
  const std::vector<std::string> names = comparison_names(asked.methods);
  const ComparisonPoint* longest = nullptr;
  std::size_t count = 0;
  std::string warning;
  for (const ComparisonPoint& p : c.points) {
    const auto name = std::find(names.begin(), names.end(), p.method);
    if (!p.done() || name == names.end()) continue;
    Request request = asked.request;
    request.method = asked.methods[static_cast<std::size_t>(name - names.begin())];
    std::string why = passing_in_a_step(request, problem, p.dt, start, end);
    if (why.empty()) continue;
    ++count;
    if (longest != nullptr && std::abs(p.dt) <= std::abs(longest->dt)) continue;
    longest = &p;
    warning = std::move(why);
  }
  if (count == 0) return all;
  all.push_back({"long_step", fmt::format("in {} of {} runs, with the largest step in {} with dt = {:g}, {}", count,
                                          c.points.size(), longest->method, longest->dt, warning)});
  return all;
}

Json json_of(const Comparison& c, const std::string& status, const ComparisonRequest& asked,
             const std::vector<Warning>& warnings) {
  // Programs read JSON numbers as double, so numbers with more digits are written as texts.
  const std::size_t n = c.reference.end.size() / 2;
  const auto part = [&](std::size_t first) {
    Json numbers = Json::array();
    for (std::size_t i = first; i < first + n; ++i) {
      numbers.push_back(digits_beyond_double(c.arithmetic) > 0 ? Json(c.reference.digits[i])
                                                               : Json(c.reference.end[i]));
    }
    return numbers;
  };
  Json all{{"status", status},
           {"problem", c.problem},
           {"arithmetic", c.arithmetic},
           {"t_end", c.t_end},
           {"reference",
            {{"kind", c.reference.kind},
             {"description", c.reference.description},
             {"q", part(0)},
             {"p", part(n)},
             {"uncertainty", c.reference.kind == "none" ? Json(nullptr) : json_of(c.reference.uncertainty)}}},
           {"rows", Json::array()},
           {"winners", Json::array()}};
  if (c.reference.kind == "integration" && digits_beyond_double(c.arithmetic) == 0) {
    // The uncertainty is valid for all digits; q and p, rounded to double, may have a larger error.
    const auto middle = c.reference.digits.begin() + static_cast<std::ptrdiff_t>(n);
    all["reference"]["digits"] = {{"q", std::vector<std::string>(c.reference.digits.begin(), middle)},
                                  {"p", std::vector<std::string>(middle, c.reference.digits.end())}};
  }
  for (const ComparisonPoint& p : c.points) all["rows"].push_back(row_of(p, asked));
  for (const ComparisonWinner& w : winners(c)) {
    all["winners"].push_back({{"error", json_of(w.error)}, {"by", w.by}, {"method", w.method}, {"work", w.work}});
    if (w.second.empty()) continue;
    all["winners"].back()["second"] = w.second;
    all["winners"].back()["second_work"] = w.second_work;
  }
  all["warnings"] = JsonWriter::written(warnings);
  return all;
}

}  // namespace

ComparisonReport compare_methods(const ComparisonRequest& request,
                                 const std::function<bool(const ComparisonProgress&)>& progress) {
  ComparisonReport report;
  report.comparison = compare(request, progress);
  const std::vector<ComparisonPoint>& points = report.comparison.points;
  const bool any_done = std::any_of(points.begin(), points.end(), [](const ComparisonPoint& p) { return p.done(); });
  report.status = report.comparison.stopped ? "interrupted" : any_done ? "done" : "failed";
  if (report.status == "failed") {
    report.message = "every run failed; the first one: " + points.at(0).failure;
    report.hint = hint_of(points.at(0), request);
  }
  const std::vector<Warning> warnings = warnings_of(report.comparison, request);
  report.json = json_text(json_of(report.comparison, report.status, request, warnings));
  report.warnings = warning_lines(warnings);
  report.csv = comparison_csv(report.comparison);
  report.text = comparison_table(report.comparison);
  return report;
}

namespace {

WorkPrecision work_precision_of(const Comparison& c) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  WorkPrecision data;
  data.title = fmt::format("{}, t = {}, {} arithmetic", c.problem, shortest(c.t_end), c.arithmetic);
  data.floor = c.reference.uncertainty.value;
  std::string last;
  for (const ComparisonPoint& p : c.points) {
    if (p.method != last) data.curves.push_back({p.method, p.order, p.explicit_step, {}, {}, {}, {}});
    last = p.method;
    WorkCurve& curve = data.curves.back();
    if (p.order != curve.order) curve.order = 0;  // the order of taylor depends on the tolerance
    curve.evaluations.push_back(p.evaluations());
    curve.seconds.push_back(p.done() ? p.seconds : nothing);
    curve.error.push_back(p.done() ? p.error.value : nothing);
    curve.energy_error.push_back(p.done() ? p.max_energy_error.value : nothing);
  }
  return data;
}

}  // namespace

figures::Page comparison_page(const Comparison& comparison) {
  return work_precision_page(work_precision_of(comparison));
}

void draw_comparison(const Comparison& comparison, const fs::path& file) {
  write_work_precision(work_precision_of(comparison), file);
}

std::string refused_comparison_figure(const fs::path& file) { return refused_figure_file(file); }

void write_comparison(const ComparisonReport& report, const WorkFolder& folder) {
  folder.write("compare.json", report.json);
  folder.write("compare.csv", report.csv);
  const std::vector<ComparisonPoint>& points = report.comparison.points;
  const bool any_error =
      std::any_of(points.begin(), points.end(), [](const ComparisonPoint& p) { return p.done() && p.error.value > 0; });
  if (report.status != "done" || !any_error) return;
  const fs::path figures = folder.figures();
  for (const char* format : {".svg", ".pdf", ".png"}) {
    draw_comparison(report.comparison, figures / (comparison_folder().figures.front() + format));
  }
}

}  // namespace hamflow
