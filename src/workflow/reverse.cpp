#include "hamflow/workflow/reverse.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/run/walls.hpp"
#include "json_text.hpp"
#include "number_text.hpp"
#include "reversal_checkpoints.hpp"
#include "reversal_measures.hpp"
#include "reverse_file.hpp"
#include "run_description.hpp"
#include "summary.hpp"
#include "summary_fields.hpp"
#include "wall_checks.hpp"
#include "warnings.hpp"

namespace hamflow {

namespace {

bool rejects_steps(const Scenario& scenario) {
  const auto& walls = scenario.request.walls;
  return walls && walls->rule == WallRule::reject;
}

/// Returns whether a reversal is bit-exact. On the lattice, methods consist of kicks and drifts, which are bijections
/// there. In a palindromic method each of them is undone by its mirror image.
bool palindromic_on_lattice(const Scenario& scenario) {
  if (rejects_steps(scenario)) return false;
  return scenario.request.arithmetic == "lattice" && describe(scenario.request.method).symmetric;
}

/// Returns the settings with which a palindromic splitting would be reversed bit for bit. Empty if there are none: with
/// constraints, for an H that no splitting can integrate, and with rejected steps. Located bounces are impossible on
/// the lattice, but the wall rule "mirror" may be possible.
std::string exact_return(const Scenario& scenario) {
  if (rejects_steps(scenario)) return {};
  Request request = scenario.request;
  const std::string lattice = "run.arithmetic = \"lattice\"";
  request.arithmetic = "lattice";
  auto walls = request.walls;
  const bool located = walls && walls->rule == WallRule::event;
  if (located) {
    walls->rule = WallRule::mirror;
    request.walls = *walls;
  }
  for (const MethodEntry& entry : methods()) {
    const MethodSpec method{.name = entry.name};
    if (!scenario.problem->accepts(method) || !refusal(method, request.arithmetic).empty()) continue;
    if (!describe(method).symmetric) continue;
    request.method = method;
    if (!refused_by_walls(request, *scenario.problem, scenario.start_q).empty()) continue;
    return lattice + (located ? " and problem.wall_rule = \"mirror\"" : "");
  }
  return {};
}

/// Returns the note for a method that is not reversible: whether the distance is larger than rounding explains.
std::string note_of_irreversible(const Scenario& scenario, const Reversal& r, const std::string& method) {
  const std::string begun = method + " is not reversible";
  if (r.bit_exact) return begun + ", but every bit returned: its reversibility defect is below rounding here";
  const ReversalEvidence evidence = reversal_evidence(scenario.request, *scenario.problem, r.steps, std::nullopt);
  if (evidence.proves == ReversalProof::not_reversible) {
    return begun + ": rounding alone does not explain the distance";
  }
  return begun + ", but this reversal does not show it: " + evidence.reason;
}

/// Returns the note that explains the distance.
/// @param tolerance tolerance as it was given, else empty   @param irreversible makes the note for a method that is not
/// reversible   @param exact_with see exact_return
std::string note_of(const MethodInfo& method, const std::string& tolerance, const std::string& arithmetic, bool timed,
                    const std::string& why_not_reversed, bool expected,
                    const std::function<std::string()>& irreversible, const std::string& exact_with) {
  if (timed) {
    return "H depends on t, and t keeps increasing: negating the momenta does not reverse the motion itself, so the "
           "distance says nothing about the method";
  }
  if (!why_not_reversed.empty()) return why_not_reversed + ", so the distance says nothing about the method";
  if (expected) return "a palindromic splitting on the lattice returns every bit";
  if (!method.reversible) return irreversible();
  if (!tolerance.empty()) {
    return method.name + " is reversible, but steps that are solved only to tolerance = " + tolerance +
           " and rounded are not";
  }
  if (arithmetic == "lattice") return {};
  return method.name + " is reversible, but rounding is not" +
         (exact_with.empty() ? "" : "; with " + exact_with + " a palindromic splitting returns every bit");
}

const char* const uncounted_pairs =
    "pairs are not counted, because with a cut-off the number of pairs changes from one force evaluation to the next";

constexpr const char* other_than_forces =
    "pairs are not counted, because {} evaluates more than forces (second derivatives, series or differences of H)";

const char* const nothing_returned = "the reversal did not finish, so there is no result";

const char* const below_the_digits =
    "every digit of q and p returned, but digits carried below the last one did not, or a zero has the other sign";

/// Shortens double-double texts to the 33 digits that the arithmetic has. Texts that read back exactly have up to 98
/// digits if the two halves of a number are far apart; reverse.h5 contains these.
std::vector<std::string> shown(std::vector<std::string> texts, const std::string& arithmetic) {
  if (arithmetic != "double-double") return texts;
  for (std::string& text : texts) text = rounded_decimal(text, 33);
  return texts;
}

/// @param dataset dataset of reverse.h5 that contains the state; empty: no file does
StateSummary state(const Frame& frame, const std::string& arithmetic, const char* dataset) {
  StateSummary all;
  all.is_large = frame.q.size() > most_named_coordinates;
  if (all.is_large) {
    all.dataset = dataset;
    return all;
  }
  all.q = frame.q;
  all.p = frame.p;
  all.digits.q = shown(frame.digits.q, arithmetic);
  all.digits.p = shown(frame.digits.p, arithmetic);
  return all;
}

/// Observes only the first half. At the beginning of the second half every coordinate turns, because the momenta are
/// negated.
class ForwardObserver final : public Observer {
 public:
  ForwardObserver(TurningPointObserver& turns, std::int64_t steps) : turns_(turns), steps_(steps) {}
  std::int64_t next_due(std::int64_t step) const override {
    const std::int64_t due = turns_.next_due(step);
    return due > steps_ ? never : due;
  }
  Verdict observe(const Frame& frame) override { return turns_.observe(frame); }

 private:
  TurningPointObserver& turns_;
  std::int64_t steps_;
};

/// Returns warnings about the motion that was reversed. Both halves are judged if the second half is the same motion.
std::vector<Warning> warnings_about(const Scenario& scenario, const Simulation& simulation, const Reversal& r,
                                    bool same_motion, const Excursion& there, const TurningPointObserver& turns) {
  std::optional<OrbitSummary> orbit;
  if (scenario.problem->describe_orbit) orbit = orbit_of(scenario);
  return warnings_of(scenario, {.energy = same_motion ? simulation.energy() : there,
                                .end = r.turn,
                                .orbit = orbit ? &*orbit : nullptr,
                                .turns = &turns,
                                .walls = simulation.wall_counts(),
                                .steps = 2 * r.steps});
}

std::string hex(std::uint64_t x) { return fmt::format("{:016x}", x); }

BodyReversalSummary bodies_returned(const Scenario& scenario, const Simulation& simulation, const Reversal& r,
                                    std::size_t bodies) {
  const bool done = r.outcome == Outcome::done;
  BodyReversalSummary all;
  if (done) all.error = return_error(r, bodies);
  const Effort effort = simulation.effort();
  // A reversal whose first step failed has no evaluations.
  const bool by_forces_alone = (effort.force > 0 || !done) && effort.gradient == 0 && effort.hessian == 0;
  if (r.steps > 0 && !by_forces_alone) {
    if (effort.force > 0) all.force_evaluations = effort.force;
    all.note = fmt::format(other_than_forces, describe(scenario.request.method).name);
  } else if (scenario.problem->has_cutoff) {
    all.force_evaluations = effort.force;
    all.note = uncounted_pairs;
  } else {
    all.pair_evaluations = effort.force * static_cast<std::int64_t>(bodies * (bodies - 1) / 2);
  }
  return all;
}

/// @param kept whether reverse.h5 contains the states
ReversalSummary summary_of(const Scenario& scenario, const Simulation& simulation, const Reversal& r, bool kept) {
  const Request& request = scenario.request;
  const MethodInfo method = describe(request.method);
  ReversalSummary s;
  s.status = status_of(r.outcome);
  s.problem = request.problem;
  s.method = method.name;
  s.arithmetic = request.arithmetic;
  s.dt = scenario.dt;
  s.steps = r.steps;
  s.start = state(r.start, request.arithmetic, kept ? "/start" : "");
  s.start_hash = hex(r.start_hash);
  s.method_reversible = method.reversible;
  if (r.outcome == Outcome::done) {
    s.returned = state(r.end, request.arithmetic, kept ? "/end" : "");
    s.distance = r.distance;
    s.relative_distance = r.relative_distance;
    s.distances = r.distances;
    s.bit_exact = r.bit_exact;
    s.turn_hash = hex(r.turn_hash);
    s.end_hash = hex(r.end_hash);
    s.digits_lost = digits_lost(r, request.arithmetic);
  }
  if (const std::size_t bodies = bodies_in(scenario); bodies > 0) {
    s.bodies = bodies_returned(scenario, simulation, r, bodies);
  }
  if (s.status == "failed") s.error = error_of(scenario, simulation, {.outcome = r.outcome, .failure = r.failure});
  return s;
}

}  // namespace

template <class Ar>
void fields(Ar& ar, GroupDistance& x) {
  ar("of", x.name, "distance", x.distance, "size", x.size, "relative", x.relative);
}

template <class Ar>
void fields(Ar& ar, BodyReversalError& x) {
  ar("position", x.position, "momentum", x.momentum, "position_rms", x.position_rms, "momentum_rms", x.momentum_rms);
}

/// Hashes of the stored bits of the three states.
struct StateHashes {
  std::string &start, &turn, &end;
};
template <class Ar>
void fields(Ar& ar, StateHashes& x) {
  ar("start", x.start);
  ar.text_or_null("turn", x.turn);
  ar.text_or_null("end", x.end);
}

template <class Ar>
void fields(Ar& ar, ReversalSummary& x) {
  StateHashes hashes{x.start_hash, x.turn_hash, x.end_hash};
  ar("status", x.status, "problem", x.problem, "method", x.method, "arithmetic", x.arithmetic, "dt", x.dt, "steps",
     x.steps, "start", x.start, "returned", x.returned, "distance", x.distance, "relative_distance",
     x.relative_distance, "distances", x.distances, "bit_exact", x.bit_exact, "hash", hashes, "method_reversible",
     x.method_reversible, "expected_bit_exact", x.expected_bit_exact, "note", x.note, "digits_lost", x.digits_lost);
  if constexpr (Ar::reading) {
    if (ar.has("return_error")) x.bodies.emplace();
  }
  if (x.bodies) {
    ar("return_error", x.bodies->error, "pair_evaluations", x.bodies->pair_evaluations);
    if (!x.bodies->pair_evaluations) ar("force_evaluations", x.bodies->force_evaluations);
    ar.if_any("pair_evaluations_note", x.bodies->note);
  }
  ar("warnings", x.warnings);
  ar.if_any("error", x.error);
}

std::string reversal_json(const ReversalSummary& summary) { return json_text(JsonWriter::written(summary)); }

std::string reversal_text(const ReversalSummary& s) {
  std::string text;
  const auto row = [&](const std::string& label, const std::string& line) {
    text += fmt::format("{:<20}{}\n", label, line);
  };
  const auto list = [](const std::vector<double>& numbers, const std::vector<std::string>& digits) {
    constexpr std::size_t most_shown = 60;
    if (numbers.size() > most_shown) return fmt::format("{} numbers (--json prints them)", numbers.size());
    return list_text(numbers, digits, "nan");
  };
  const auto state_rows = [&](const std::string& label, const StateSummary& at) {
    if (at.is_large) {
      return row(label,
                 at.dataset.empty() ? "not saved; --out DIR saves it in reverse.h5" : at.dataset + " in reverse.h5");
    }
    row(label + " q", list(at.q, at.digits.q));
    row(label + " p", list(at.p, at.digits.p));
  };
  row("status", s.status);
  row("problem", s.problem);
  row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s.method, s.dt, s.arithmetic));
  row("steps", fmt::format("{} forward, {} back", s.steps, s.steps));
  state_rows("start", s.start);
  if (s.returned) {
    state_rows("returned", *s.returned);
    constexpr std::size_t most_groups = 4;
    std::vector<GroupDistance> groups = *s.distances;
    if (groups.size() > most_groups) {  // lists only the group with the largest relative distance
      const auto furthest = std::ranges::find_if(groups, [&](const GroupDistance& each) {
        return each.relative.value == s.relative_distance->value && each.relative.text == s.relative_distance->text;
      });
      groups = {furthest == groups.end() ? groups.front() : *furthest};
    }
    row("distance", joined(groups, [](const GroupDistance& each) {
          return fmt::format("{} {} ({} of its size along the motion)", each.name, number_text(each.distance, "{:.3g}"),
                             number_text(each.relative, "{:.3g}"));
        }));
    row("digits lost", fmt::format("{:.2f}", *s.digits_lost));
    if (s.bodies) {
      const auto counted = [](const std::optional<std::int64_t>& count, const char* what) {
        return count ? fmt::format("; {} {}", *count, what) : "";
      };
      row("return error", fmt::format("positions {}, momenta {} (sqrt(sum |difference|^2)/N){}{}",
                                      number_text(s.bodies->error->position, "{:.3g}"),
                                      number_text(s.bodies->error->momentum, "{:.3g}"),
                                      counted(s.bodies->pair_evaluations, "pairs computed"),
                                      counted(s.bodies->force_evaluations, "force evaluations")));
    }
    row("every bit", *s.bit_exact ? "yes" : "no");
    row("hash of the bits", fmt::format("{} -> {} -> {}", s.start_hash, s.turn_hash, s.end_hash));
  }
  if (!s.note.empty()) row("note", s.note);
  return text;
}

namespace {

void describe(ReversalReport& report) {
  report.status = report.summary.status;
  report.warnings = warning_lines(report.summary.warnings);
  report.text = reversal_text(report.summary);
}

ReversalReport report_of(const Scenario& scenario, const Simulation& simulation, Reversal reversal,
                         const Excursion& there, const TurningPointObserver& turns, bool kept) {
  ReversalReport report;
  report.reversal = std::move(reversal);
  const Frame* const states[] = {&report.reversal.start, &report.reversal.turn};
  const MomentumParity parity =
      parity_in_momenta(*scenario.problem, scenario.request.parameters, report.reversal.sizes, states);
  const bool same_motion = parity.is_even && parity.is_defined && !depends_on_time(*scenario.problem);
  report.expected_bit_exact = same_motion && parity.to_the_last_bit && palindromic_on_lattice(scenario);
  const Reversal& r = report.reversal;
  const MethodSpec& method = scenario.request.method;
  const auto tolerance = method.options.find(tolerance_option);
  const MethodInfo info = describe(method);
  if (r.outcome != Outcome::done) {
    report.note = nothing_returned;
    if (!parity.is_defined) report.note += "; " + why_not_reversed(parity);
  } else {
    report.note = note_of(
        info, tolerance == method.options.end() ? "" : tolerance->second, scenario.request.arithmetic,
        depends_on_time(*scenario.problem), why_not_reversed(parity), report.expected_bit_exact,
        [&] { return note_of_irreversible(scenario, r, info.name); }, exact_return(scenario));
  }
  if (r.outcome == Outcome::done && rejects_steps(scenario)) {
    report.note +=
        (report.note.empty() ? "" : "; ") +
        std::string("steps that leave the walls are rejected, which cannot be undone, so no exact return is expected");
  }
  if (r.outcome == Outcome::done && !r.bit_exact && r.distance.value == 0 && r.distance.text.empty()) {
    report.note += (report.note.empty() ? "" : "; ") + std::string(below_the_digits);
  }
  report.summary = summary_of(scenario, simulation, r, kept);
  report.summary.expected_bit_exact = report.expected_bit_exact;
  report.summary.note = report.note;
  report.summary.warnings = warnings_about(scenario, simulation, r, same_motion, there, turns);
  report.json = reversal_json(report.summary);
  describe(report);
  if (report.summary.error) {
    report.message = report.summary.error->message;
    report.hint = report.summary.error->hint;
    if (!parity.is_defined) {
      report.message = why_not_reversed(parity);
      report.hint = "to integrate back along this motion, start at its end with the other sign of dt";
    }
  }
  return report;
}

}  // namespace

ReversalReport reverse_scenario(const Scenario& scenario, const std::function<bool(std::int64_t)>& pulse) {
  const auto simulation = make_simulation(scenario.request);
  TurningPointObserver turns(scenario.dt, takes_equal_steps(simulation->method()));
  ForwardObserver forward_observer(turns, scenario.steps);
  Observer* const observers[] = {&forward_observer};
  ReversalProgress progress;
  const std::function<bool()> goes_on = [&] { return !pulse || pulse(simulation->step() - progress.first); };
  const StopQuestion question(goes_on);
  Reversal reversal = reverse(*simulation, scenario.steps, pulse, observers, progress,
                              unit_groups(*scenario.problem, scenario.start_q.size()));
  return report_of(scenario, *simulation, std::move(reversal), progress.forward_energy, turns, false);
}

ReversalReport reverse_scenario(const Scenario& scenario, const ReversalSettings& settings) {
  if (settings.folder.empty()) return reverse_scenario(scenario, settings.pulse);
  const auto note = [&](const std::string& text) {
    if (settings.note) settings.note(text);
  };
  std::optional<Checkpoint> from;
  WorkFolder folder(settings.folder, reversal_folder(), settings.existing);
  if (!folder.note().empty()) note(folder.note());
  if (folder.resumes()) from = kept_reversal(scenario, settings.folder);
  folder.prepare(scenario);
  if (from) {
    if (const auto kept = complete_reversal(*from, settings.folder)) {
      note("the reversal is complete already; there is nothing to do");
      ReversalReport report;
      report.json = *kept;
      JsonReader::read(read_json(*kept), report.summary);
      report.expected_bit_exact = report.summary.expected_bit_exact;
      report.note = report.summary.note;
      describe(report);
      return report;
    }
  }
  const auto simulation = make_simulation(scenario.request);
  ReversalCheckpoints checkpoints(scenario, *simulation, settings.folder, from ? &*from : nullptr);
  ForwardObserver forward_observer(checkpoints.turns(), scenario.steps);
  Observer* const observers[] = {&forward_observer, &checkpoints};
  const auto asked_at = [&](std::int64_t step) { return !settings.pulse || settings.pulse(step); };
  const std::function<bool()> goes_on = [&] { return asked_at(simulation->step() - checkpoints.progress().first); };
  const StopQuestion question(goes_on);
  Reversal reversal;
  try {
    reversal = reverse(
        *simulation, scenario.steps,
        [&](std::int64_t step) {
          checkpoints.write_if_due();
          return asked_at(step);
        },
        observers, checkpoints.progress(), unit_groups(*scenario.problem, scenario.start_q.size()));
  } catch (const ClientError& error) {
    checkpoints.write();
    throw ClientError(std::string(error.what()) + "; start it again, and continue with " + option_name("resume"));
  }
  if (reversal.outcome == Outcome::stopped) checkpoints.write();
  ReversalReport report = report_of(scenario, *simulation, std::move(reversal), checkpoints.progress().forward_energy,
                                    checkpoints.turns(), true);
  const Reversal& r = report.reversal;
  write_reverse_file(settings.folder / "reverse.h5", scenario.text, r.start, r.turn,
                     r.outcome == Outcome::done ? &r.end : nullptr);
  if (r.outcome == Outcome::done) checkpoints.complete(report.json);
  folder.write("reverse.json", report.json);
  return report;
}

}  // namespace hamflow
