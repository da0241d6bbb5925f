// Writes the summary of a run as text, a line for each entry.
#include <fmt/format.h>

#include <cmath>

#include "hamflow/core/text.hpp"
#include "measures/measure.hpp"
#include "number_text.hpp"
#include "summary.hpp"

namespace hamflow {

LongNumber with_digits(double x, const std::string& digits) {
  LongNumber number(x);
  number.text = digits;
  return number;
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string number_text(const LongNumber& x, const char* form, const char* none) {
  if (!x.text.empty()) return x.text;
  return std::isfinite(x.value) ? fmt::format(fmt::runtime(form), x.value) : none;
}

std::string list_text(const std::vector<double>& numbers, const std::vector<std::string>& digits, const char* none) {
  if (!digits.empty()) return joined(digits);
  return joined(numbers, [&](double x) { return number_text(x, "{:.17g}", none); });
}

namespace {

/// Writes a percentage with two digits: "0.25", "6.3", "100".
std::string percent_of(double share) {
  const double percent = 100 * share;
  return percent < 99.5 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent);
}

bool is_finite(const LongNumber& x) { return !x.text.empty() || std::isfinite(x.value); }

std::string orbit_text(const OrbitSummary& orbit) {
  const auto number = [](const LongNumber& x) { return number_text(x, "{:.6g}"); };
  return orbit.type + (orbit.conic.empty() ? "" : " (" + orbit.conic + ")") +
         fmt::format(", r = {} .. {}, apsidal angle {}", number(orbit.r_min),
                     is_finite(orbit.r_max) ? number(orbit.r_max) : "inf",
                     is_finite(orbit.apsidal_angle) ? number(orbit.apsidal_angle) : "infinite or unknown") +
         (orbit.falls_into_centre ? ", falls into the centre" : "");
}

/// One line for the energy, one for each invariant, one for the reversal.
std::string certificate_text(const RunCertificate& c) {
  const std::string next_line = fmt::format("\n{:<20}", "");
  std::string text =
      fmt::format("energy error {}: {}", c.drift.drift ? name(*c.drift.drift) : "undecided", c.drift.reason);
  for (const MomentumMap& map : c.momentum_maps) {
    if (!map.rounding) continue;
    const std::optional<bool> conserved = map.conserved();
    text += next_line + fmt::format("{} {}", map.name,
                                    !conserved
                                        ? "conservation undecided: the error may come from rounding or from the method"
                                    : *conserved ? "conserved to rounding"
                                                 : "not conserved");
  }
  if (const auto& back = c.reversal) {
    text += next_line + fmt::format("reversal tested over {} ({} % of the run): {}: {}",
                                    counted(static_cast<std::size_t>(back->steps), "step"), percent_of(back->share),
                                    back->proves == ReversalProof::nothing ? "inconclusive" : name(back->proves),
                                    back->reason);
  }
  return text;
}

/// Writes a quantity at the start and at the end, and its largest error over every step.
std::string watched_text(const std::string& initial, const std::string& final,
                         const std::optional<LongNumber>& max_error) {
  const std::string ends = initial + " -> " + final + ", ";
  if (!max_error || !is_finite(*max_error)) return ends + "error unknown";
  return ends + "largest error " + number_text(*max_error, "{:.3g}");
}

std::string invariant_text(const InvariantSummary& x) {
  const auto shown = [&](const std::vector<double>& numbers, const std::vector<std::string>& digits) {
    const std::string list = list_text(numbers, digits);
    return x.is_list ? "[" + list + "]" : list;
  };
  return watched_text(shown(x.seen.initial, x.seen.initial_digits), shown(x.seen.final, x.seen.final_digits),
                      x.max_error());
}

std::string exact_text(const ExactSummary& exact) {
  const std::string off = joined(exact.differences, [](const auto& difference) {
    return number_text(difference.second, "{:.3g}") + " (" + difference.first + ")";
  });
  if (exact.uncertainty && exact.max_difference <= *exact.uncertainty) {
    return fmt::format("distance {} from the closed form, which is only known to {:.2g}", off, *exact.uncertainty);
  }
  return fmt::format("distance {} from the exact state", off);
}

}  // namespace

std::string summary_text(const Summary& s) {
  std::string text;
  const auto row = [&](std::string_view label, const std::string& line) {
    text += fmt::format("{:<19} {}\n", label, line);
  };
  const auto number = [](const LongNumber& x) { return value_text(x, "{:.17g}"); };
  row("status", s.status);
  row("problem", s.problem);
  row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s.method, s.dt, s.arithmetic));
  row("steps", fmt::format("{}, t = {}", s.steps, number(time_of(s.final))));
  constexpr std::size_t most_shown = 60;
  const auto state_row = [&](const char* label, const std::vector<double>& numbers, const auto& digits) {
    row(label, numbers.size() <= most_shown ? list_text(numbers, digits)
                                            : fmt::format("{} numbers (--json prints them)", numbers.size()));
  };
  if (!s.final.is_large) {
    state_row("final q", s.final.q, s.final.digits.q);
    state_row("final p", s.final.p, s.final.digits.p);
  }
  const EnergySummary& energy = s.energy;
  const bool is_relative = energy.scale && *energy.scale > 0 && energy.max_relative_error;
  if (s.hamiltonian) {
    row("H(q, p, t)",
        number_text(s.hamiltonian->initial, "{:.17g}") + " -> " + number_text(s.hamiltonian->final, "{:.17g}"));
  }
  row(s.hamiltonian ? "H - int dH/dt" : "energy",
      watched_text(number(energy.initial), number(energy.final), energy.max_error) +
          (is_relative ? fmt::format(" ({} of the energy scale)", number_text(*energy.max_relative_error, "{:.3g}"))
                       : " (no relative error, because H is 0 at the start)") +
          (energy.of.empty() ? "" : "; errors are those of " + energy.of));
  for (const InvariantSummary& each : s.invariants) row(each.name, invariant_text(each));
  if (s.constraints) {
    row("constraints", "|g| at most " + number_text(s.constraints->position, "{:.3g}") + ", |g' M^-1 p| at most " +
                           number_text(s.constraints->velocity, "{:.3g}"));
  }
  if (s.exact) row("exact", exact_text(*s.exact));
  if (s.orbit) row("exact orbit", orbit_text(*s.orbit));
  for (const Body& body : s.bodies) {
    const auto list = [](const auto& x) { return list_text({x.begin(), x.end()}); };
    row("body",
        fmt::format("mass {}, at [{}], velocity [{}]", number(body.mass), list(body.position), list(body.velocity)));
  }
  if (s.diagnostics) {
    const auto range = [&](const char* label, const std::optional<DiagnosticRange>& x) {
      if (!x) return;
      row(label, fmt::format("{} (t = {:g}) .. {} (t = {:g})", number_text(x->min, "{:.6g}"), x->t_min,
                             number_text(x->max, "{:.6g}"), x->t_max));
    };
    range("condition_tangent", s.diagnostics->condition_tangent);
    range("determinant_tangent", s.diagnostics->determinant_tangent);
    range("condition_M^-1", s.diagnostics->condition_inverse_mass);
  }
  row("evaluations", fmt::format("force {}, gradient {}, Hessian {}, linear solves {}", s.effort.force,
                                 s.effort.gradient, s.effort.hessian, s.effort.linear_solves));
  if (const auto& newton = s.newton) {
    row("Newton per step", fmt::format("min {}, mean {:.4g}, max {}, stagnated {}", newton->min, newton->mean,
                                       newton->max, newton->stagnated) +
                               (newton->iteration.empty() ? "" : ", iteration " + newton->iteration));
  }
  for (const auto& [name, count] : s.events) row("event " + name, std::to_string(count));
  for (const std::string& note : s.event_notes) row("event note", note);
  for (const MeasureKind& kind : measure_kinds()) {
    if (const std::string line = kind.text(s); !line.empty()) row(kind.label, line);
  }
  if (s.certificate) {
    row("certificate", certificate_text(*s.certificate));
  } else if (energy.scale) {  // a map has no energy scale and no certificate
    row("certificate", "not requested");
  }
  row("wall time", fmt::format("{:.3g} s, {:.4g} steps/s", s.wall_seconds, s.steps_per_second));
  return text;
}

}  // namespace hamflow
