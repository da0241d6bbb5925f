// run.lyapunov: exponents of the method's own steps, along the run; in a sweep a column each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/run/splitting_named.hpp"
#include "hamflow/verify/lyapunov_of.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

class LyapunovMeasure final : public Measure {
 public:
  explicit LyapunovMeasure(const Scenario& scenario)
      : watch_(step_map_of(scenario), scenario.dt, scenario.steps, scenario.lyapunov) {}
  Observer& observer() override { return watch_; }
  Json summary() const override {
    const LyapunovSpectrum found = watch_.spectrum();
    Json all{{"exponents", found.exponents},
             {"standard_errors", found.standard_errors},
             {"pair_sums", found.pair_sums},
             {"time", found.time},
             {"renormalisations", found.renormalisations}};
    if (!watch_.followed()) all["stopped_at_step"] = watch_.step();
    return all;
  }

 private:
  LyapunovWatch watch_;
};

/// The largest of some numbers, without sign.
double largest_of(const Json& xs) {
  double largest = 0;
  for (const Json& x : xs) largest = x.is_null() ? largest : std::max(largest, std::abs(x.get<double>()));
  return largest;
}

std::string lyapunov_text(const Json& found) {
  constexpr std::size_t most_shown = 6;
  std::string line;
  for (std::size_t i = 0; i < std::min(found["exponents"].size(), most_shown); ++i) {
    line += (i > 0 ? ", " : "") + number_text(found["exponents"][i], "{:.6g}") + " +- " +
            number_text(found["standard_errors"][i], "{:.2g}");
  }
  if (found["exponents"].size() > most_shown) line += ", ...";
  if (!found["pair_sums"].empty()) line += fmt::format("; pairs sum to at most {:.2g}", largest_of(found["pair_sums"]));
  return line;
}

/// The problem whose chaos is mapped most, by a kernel of its own: a quarter of the time that a StepMap takes.
std::optional<double> exponent_of_henon_heiles(const Scenario& scenario) {
  if (scenario.request.problem != "henon-heiles") return std::nullopt;
  const std::optional<AnySplitting> method = splitting_named(scenario.request.method.name);
  if (!method) return std::nullopt;
  const HenonHeiles<double> problem{Parameters<double>(scenario.request.parameters)};
  const std::vector<double>& q = scenario.start_q;
  const std::vector<double>& p = scenario.start_p;
  return largest_lyapunov(problem, TableRecipe<Shape::any>{*method}, {q[0], q[1]}, {p[0], p[1]}, scenario.dt,
                          scenario.steps);
}

/// Without a run of its own; NaN when a step fails.
std::vector<double> exponents_of(const Scenario& scenario) {
  if (scenario.lyapunov == 1) {
    if (const auto typed = exponent_of_henon_heiles(scenario)) return {*typed};
  }
  const auto map = step_map_of(scenario);
  State<double> z = scenario.start_q;
  z.insert(z.end(), scenario.start_p.begin(), scenario.start_p.end());
  if (scenario.lyapunov == 1) return {largest_lyapunov(*map, z, scenario.dt, scenario.steps)};
  try {
    return lyapunov_spectrum(*map, z, scenario.dt, scenario.steps, scenario.lyapunov).exponents;
  } catch (const Error&) {  // the member's status shows it
    return std::vector<double>(scenario.lyapunov, std::numeric_limits<double>::quiet_NaN());
  }
}

MemberObservables columns(const Scenario& first) {
  MemberObservables all;
  for (std::size_t i = 1; i <= first.lyapunov; ++i) all.names.push_back("lyapunov" + std::to_string(i));
  all.observe = exponents_of;
  return all;
}

}  // namespace

MeasureKind measure_lyapunov() {
  return {.key = run_keys().lyapunov.name,
          .label = "Lyapunov exponents",
          .requested = [](const Scenario& scenario) { return scenario.lyapunov > 0; },
          .make = [](const Scenario& scenario, const Simulation&, Recorder*) -> std::unique_ptr<Measure> {
            return std::make_unique<LyapunovMeasure>(scenario);
          },
          .text = lyapunov_text,
          .columns = columns};
}

}  // namespace hamflow
