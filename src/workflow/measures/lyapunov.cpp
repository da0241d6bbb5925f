// run.lyapunov: Lyapunov exponents of the method's own steps along the run. A sweep has a column for each.
#include "hamflow/detail/verify/lyapunov.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "json_fields.hpp"
#include "measure.hpp"
#include "measure_list.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"

namespace hamflow {

template <class Ar>
void fields(Ar& ar, LyapunovSummary& x) {
  std::string verdict = x.steady ? "steady" : "undecided";
  ar("exponents", x.exponents, "standard_errors", x.standard_errors, "verdict", verdict);
  if constexpr (Ar::reading) x.steady = verdict == "steady";
  ar("pair_sums", x.pair_sums, "time", x.time, "renormalisations", x.renormalisations);
  ar.if_any("stopped_at_step", x.stopped_at_step);
}

namespace {

class LyapunovMeasure final : public Measure {
 public:
  explicit LyapunovMeasure(const Scenario& scenario)
      : watch_(step_map_of(scenario), scenario.dt, scenario.steps, scenario.lyapunov), by_steps_(scenario.map) {}
  Observer& observer() override { return watch_; }
  TangentObserver* tangents() override { return &watch_; }
  void add_to(Summary& summary) const override {
    LyapunovSpectrum found = spectrum();
    LyapunovSummary& all = summary.lyapunov.emplace();
    all.exponents = std::move(found.exponents);
    all.standard_errors = std::move(found.standard_errors);
    all.steady = found.steady;
    all.pair_sums = std::move(found.pair_sums);
    all.time = found.time;
    all.renormalisations = found.renormalisations;
    if (!watch_.followed()) all.stopped_at_step = watch_.step();
  }
  /// Returns the numbers for a sweep; NaN if a step could not be differentiated, because a column cannot say at which
  /// step.
  std::vector<double> row() const override {
    std::vector<double> exponents = spectrum().exponents;
    if (!watch_.followed()) std::fill(exponents.begin(), exponents.end(), std::numeric_limits<double>::quiet_NaN());
    return exponents;
  }

 private:
  LyapunovSpectrum spectrum() const { return by_steps_ ? watch_.spectrum_by_steps() : watch_.spectrum(); }

  LyapunovObserver watch_;
  bool by_steps_;
};

/// Returns the largest absolute value.
double largest_of(const std::vector<double>& xs) {
  double largest = 0;
  for (const double x : xs) largest = std::max(largest, std::abs(x));
  return largest;
}

std::string lyapunov_text(const LyapunovSummary& found) {
  constexpr std::size_t most_shown = 6;
  std::string line;
  for (std::size_t i = 0; i < std::min(found.exponents.size(), most_shown); ++i) {
    line += (i > 0 ? ", " : "") + number_text(found.exponents[i], "{:.6g}") + " +- " +
            number_text(found.standard_errors[i], "{:.2g}");
  }
  if (found.exponents.size() > most_shown) line += ", ...";
  if (!found.steady) {
    line += "; undecided: the growth is not steady, as for regular and sticky orbits; try a longer run";
  }
  if (!found.pair_sums.empty()) line += fmt::format("; pairs sum to at most {:.2g}", largest_of(found.pair_sums));
  if (found.stopped_at_step) {
    line += fmt::format("; averaged only up to t = {}, where a step could not be differentiated",
                        number_text(found.time, "{:.6g}"));
  }
  return line;
}

template <class Ar>
void lyapunov_entry(Ar& ar, Summary& summary) {
  ar.if_any(run_keys().lyapunov.name, summary.lyapunov);
}

std::vector<std::string> columns_of_exponents(const Scenario& first) {
  std::vector<std::string> all;
  for (std::size_t i = 1; i <= first.lyapunov; ++i) all.push_back("lyapunov" + std::to_string(i));
  return all;
}

}  // namespace

MeasureKind measure_lyapunov() {
  return {.key = run_keys().lyapunov.name,
          .label = "Lyapunov exponents",
          .requested = [](const Scenario& scenario) { return scenario.lyapunov > 0; },
          .make = [](const Scenario& scenario) -> std::unique_ptr<Measure> {
            return std::make_unique<LyapunovMeasure>(scenario);
          },
          .write = lyapunov_entry,
          .read = lyapunov_entry,
          .text = [](const Summary& s) { return s.lyapunov ? lyapunov_text(*s.lyapunov) : std::string(); },
          .columns = columns_of_exponents};
}

}  // namespace hamflow
