#include "hamflow/workflow/reverse.hpp"

#include <fmt/format.h>
#include <mpfr.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/walls.hpp"
#include "json_text.hpp"
#include "number_text.hpp"
#include "reversal_checkpoints.hpp"
#include "reversal_measures.hpp"
#include "reverse_file.hpp"
#include "run_description.hpp"
#include "summary.hpp"
#include "wall_checks.hpp"
#include "warnings.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

bool rejects_steps(const Scenario& scenario) {
  const auto walls = walls_among(scenario.request.variant);
  return walls && walls->rule == WallRule::reject;
}

/// What runs on the lattice is made of kicks and drifts, which are one-to-one there; in a palindrome each is undone by
/// its mirror image.
bool palindromic_on_lattice(const Scenario& scenario) {
  if (rejects_steps(scenario)) return false;
  return scenario.request.arithmetic == "lattice" && describe(scenario.request.method).symmetric;
}

/// With what a palindromic splitting returns every bit; empty where none can: on constraints, with an H that no
/// splitting takes, with steps that are rejected. Bounces that are located are not on the lattice, but mirrors may be.
std::string exact_return(const Scenario& scenario) {
  if (rejects_steps(scenario)) return {};
  Request request = scenario.request;
  const std::string lattice = "run.arithmetic = \"lattice\"";
  request.arithmetic = "lattice";
  auto walls = walls_among(request.variant);
  const bool located = walls && walls->rule == WallRule::event;
  if (located) {
    walls->rule = WallRule::mirror;
    put_among(*walls, request.variant);
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

/// What the distance says about a method that is not reversible: where rounding explains it, nothing.
std::string note_of_irreversible(const Scenario& scenario, const Reversal& r, const std::string& method) {
  const std::string begun = method + " is not reversible";
  if (r.bit_exact) return begun + ", but every bit came back: its defect is below rounding here";
  const ReversalEvidence evidence = reversal_evidence(scenario.request, *scenario.problem, r.steps, std::nullopt);
  if (evidence.proves == ReversalProof::not_reversible) {
    return begun + ": the distance is its own, not that of rounding alone";
  }
  return begun + ", but no distance of its own is shown: " + evidence.reason;
}

/// @param tolerance as it was given, else empty   @param irreversible what to say of a method that is not reversible
/// @param exact_with see exact_return
std::string note_of(const MethodInfo& method, const std::string& tolerance, const std::string& arithmetic, bool timed,
                    const std::string& why_not_reversed, bool expected,
                    const std::function<std::string()>& irreversible, const std::string& exact_with) {
  if (timed) {
    return "H depends on t, which goes on: the motion itself is not reversed by negating the momenta, so that a "
           "distance "
           "says nothing about the method";
  }
  if (!why_not_reversed.empty()) return why_not_reversed + ", so that a distance says nothing about the method";
  if (expected) return "a palindromic splitting on the lattice returns every bit";
  if (!method.reversible) return irreversible();
  if (!tolerance.empty()) {
    return method.name + " is reversible, but steps solved to tolerance = " + tolerance +
           " are not, and neither is rounding";
  }
  if (arithmetic == "lattice") return {};
  return method.name + " is reversible, but rounding is not" +
         (exact_with.empty() ? "" : ": with " + exact_with + " a palindromic splitting returns every bit");
}

const char* const uncounted_pairs =
    "with a cut-off only pairs within it are computed: how many they are changes from force to force, and no step "
    "counts them";

constexpr const char* other_than_forces =
    "{} asks for more of the pairs than forces (second derivatives, series or differences of H): how many pairs that "
    "takes, no step counts";

const char* const nothing_returned = "the reversal has not come to its end: nothing is said of what it returns";

const char* const below_the_digits =
    "every digit of q and p came back; what is carried on below their last digit did not, or a zero has the other sign";

/// Texts that read back exactly have up to 98 digits in double-double, where the two halves of a number lie far apart.
/// reverse.h5 has them; here stand the 33 that the arithmetic carries.
std::vector<std::string> shown(std::vector<std::string> texts, const std::string& arithmetic) {
  if (arithmetic != "double-double") return texts;
  mpfr_t x;
  mpfr_init2(x, 320);
  for (std::string& text : texts) {
    char rounded[64];
    mpfr_set_str(x, text.c_str(), 10, MPFR_RNDN);
    mpfr_snprintf(rounded, sizeof rounded, "%.33Rg", x);
    text = rounded;
  }
  mpfr_clear(x);
  return texts;
}

/// Above as many coordinates as run prints, where it stands: a group of reverse.h5; null where none is kept.
Json state(const Frame& frame, const std::string& arithmetic, const char* dataset, bool kept) {
  if (frame.q.size() > most_named_coordinates) return {{"dataset", kept ? Json(dataset) : Json(nullptr)}};
  if (!frame.digits.q.empty())
    return {{"q", shown(frame.digits.q, arithmetic)}, {"p", shown(frame.digits.p, arithmetic)}};
  return {{"q", frame.q}, {"p", frame.p}};
}

/// Watches the way there alone: on the way back every coordinate turns with the momenta.
class WayThere final : public Observer {
 public:
  WayThere(TurnWatch& turns, std::int64_t steps) : turns_(turns), steps_(steps) {}
  std::int64_t next_due(std::int64_t step) const override {
    const std::int64_t due = turns_.next_due(step);
    return due > steps_ ? never : due;
  }
  Verdict observe(const Frame& frame) override { return turns_.observe(frame); }

 private:
  TurnWatch& turns_;
  std::int64_t steps_;
};

/// What is nonsense about the motion that was reversed. Both ways count where the way back is the same motion.
Json warnings_about(const Scenario& scenario, const Simulation& simulation, const Reversal& r, bool same_motion,
                    const Excursion& there, const TurnWatch& turns) {
  Json known = Json::object();
  if (scenario.problem->describe_orbit) known["orbit"] = orbit_of(scenario);
  return warnings_of(scenario, known, same_motion ? simulation.energy() : there, r.turn, &turns,
                     simulation.wall_counts(), 2 * r.steps);
}

std::string hex(std::uint64_t x) { return fmt::format("{:016x}", x); }

/// Of each group of numbers that share a unit.
Json distances_json(const std::vector<GroupDistance>& distances) {
  Json all = Json::array();
  for (const GroupDistance& each : distances) {
    all.push_back({{"of", each.name},
                   {"distance", json_of(each.distance)},
                   {"size", each.size},
                   {"relative", json_of(each.relative)}});
  }
  return all;
}

/// @param kept whether reverse.h5 has the states
Json json_of(const Scenario& scenario, const Simulation& simulation, const ReversalReport& report, const Json& warnings,
             bool kept) {
  const Reversal& r = report.reversal;
  const MethodInfo method = describe(scenario.request.method);
  const bool done = r.outcome == Outcome::done;
  Json s{{"status", status_of(r.outcome)},
         {"problem", scenario.request.problem},
         {"method", method.name},
         {"arithmetic", scenario.request.arithmetic},
         {"dt", scenario.dt},
         {"steps", r.steps},
         {"start", state(r.start, scenario.request.arithmetic, "/start", kept)},
         {"returned", done ? state(r.end, scenario.request.arithmetic, "/end", kept) : Json(nullptr)},
         {"distance", done ? json_of(r.distance) : Json(nullptr)},
         {"relative_distance", done ? json_of(r.relative_distance) : Json(nullptr)},
         {"distances", done ? distances_json(r.distances) : Json(nullptr)},
         {"bit_exact", done ? Json(r.bit_exact) : Json(nullptr)},
         {"hash",
          {{"start", hex(r.start_hash)},
           {"turn", done ? Json(hex(r.turn_hash)) : Json(nullptr)},
           {"end", done ? Json(hex(r.end_hash)) : Json(nullptr)}}},
         {"method_reversible", method.reversible},
         {"expected_bit_exact", report.expected_bit_exact},
         {"note", report.note},
         {"digits_lost", done ? Json(digits_lost(r, scenario.request.arithmetic)) : Json(nullptr)}};
  if (const std::size_t bodies = bodies_in(scenario); bodies > 0) {
    s["return_error"] = done ? return_error(r, bodies) : Json(nullptr);
    const Effort effort = simulation.effort();
    const std::int64_t forces = effort.force;
    // A way that failed at once has taken none.
    const bool by_forces_alone = (forces > 0 || !done) && effort.gradient == 0 && effort.hessian == 0;
    const bool ends = scenario.request.parameters.contains(GasKeys::cutoff);
    if (r.steps > 0 && !by_forces_alone) {
      s["pair_evaluations"] = nullptr;
      s["force_evaluations"] = forces > 0 ? Json(forces) : Json(nullptr);
      s["pair_evaluations_note"] = fmt::format(other_than_forces, method.name);
    } else if (ends) {
      s["pair_evaluations"] = nullptr;
      s["force_evaluations"] = forces;
      s["pair_evaluations_note"] = uncounted_pairs;
    } else {
      s["pair_evaluations"] = forces * static_cast<std::int64_t>(bodies * (bodies - 1) / 2);
    }
  }
  s["warnings"] = warnings;
  if (s["status"] == "failed") {
    RunResult result;
    result.outcome = r.outcome;
    result.failure = r.failure;
    s["error"] = summary_of(scenario, simulation, result)["error"];
  }
  return s;
}

std::string readable_reversal(const Json& s) {
  const auto row = [](std::string_view label, const std::string& text) {
    return fmt::format("{:<20}{}\n", label, text);
  };
  const auto list = [](const Json& xs) {
    constexpr std::size_t most_shown = 60;
    if (xs.size() > most_shown) return fmt::format("{} numbers (--json prints them)", xs.size());
    return joined(xs, [](const Json& x) { return number_text(x, "{:.17g}"); });
  };
  std::string text = row("status", s["status"].get<std::string>()) + row("problem", s["problem"].get<std::string>());
  text += row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s["method"].get<std::string>(),
                                    s["dt"].get<double>(), s["arithmetic"].get<std::string>()));
  text += row("steps", fmt::format("{} there, {} back", s["steps"].get<long long>(), s["steps"].get<long long>()));
  const auto state_rows = [&](const std::string& label, const Json& at) {
    if (at.contains("q")) return row(label + " q", list(at["q"])) + row(label + " p", list(at["p"]));
    return row(label, at["dataset"].is_null() ? "kept nowhere: --out DIR keeps it in reverse.h5"
                                              : at["dataset"].get<std::string>() + " of reverse.h5");
  };
  text += state_rows("start", s["start"]);
  if (!s["returned"].is_null()) {
    text += state_rows("returned", s["returned"]);
    constexpr std::size_t most_groups = 4;
    Json groups = s["distances"];
    if (groups.size() > most_groups) {  // that which is furthest off
      std::erase_if(groups.get_ref<Json::array_t&>(),
                    [&](const Json& each) { return each["relative"] != s["relative_distance"]; });
      groups.get_ref<Json::array_t&>().resize(1);
    }
    text += row("distance", joined(groups, [](const Json& each) {
                  return fmt::format("{} {} ({} of its size along the motion)", each["of"].get<std::string>(),
                                     number_text(each["distance"], "{:.3g}"), number_text(each["relative"], "{:.3g}"));
                }));
    text += row("digits lost", fmt::format("{:.2f}", s["digits_lost"].get<double>()));
    if (s.contains("return_error")) {
      const auto counted = [&](const char* key, const char* what) {
        const bool is_known = s.contains(key) && !s[key].is_null();
        return is_known ? fmt::format("; {} {}", s[key].get<std::int64_t>(), what) : "";
      };
      const std::string effort =
          counted("pair_evaluations", "pairs computed") + counted("force_evaluations", "force evaluations");
      text += row("return error", fmt::format("positions {}, momenta {} (sqrt(sum |difference|^2)/N){}",
                                              number_text(s["return_error"]["position"], "{:.3g}"),
                                              number_text(s["return_error"]["momentum"], "{:.3g}"), effort));
    }
    text += row("every bit", s["bit_exact"].get<bool>() ? "yes" : "no");
    text +=
        row("hash of the bits", fmt::format("{} -> {} -> {}", s["hash"]["start"].get<std::string>(),
                                            s["hash"]["turn"].get<std::string>(), s["hash"]["end"].get<std::string>()));
  }
  if (!s["note"].get<std::string>().empty()) text += row("note", s["note"].get<std::string>());
  return text;
}

}  // namespace

namespace {

ReversalReport report_of(const Scenario& scenario, const Simulation& simulation, Reversal reversal,
                         const Excursion& there, const TurnWatch& turns, bool kept) {
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
    report.note = nothing_returned;  // what a method is said to return was not seen here
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
        std::string("steps that leave the walls are rejected, which is not one-to-one: no return is promised");
  }
  if (r.outcome == Outcome::done && !r.bit_exact && r.distance.value == 0 && r.distance.text.empty()) {
    report.note += (report.note.empty() ? "" : "; ") + std::string(below_the_digits);
  }
  const Json json =
      json_of(scenario, simulation, report, warnings_about(scenario, simulation, r, same_motion, there, turns), kept);
  report.warnings = warning_lines(json);
  report.status = json["status"].get<std::string>();
  if (json.contains("error")) {
    report.message = json["error"]["message"].get<std::string>();
    report.hint = json["error"]["hint"].get<std::string>();
    if (!parity.is_defined) {
      report.message = why_not_reversed(parity);
      report.hint = "to go back along this motion, begin at its end with the other sign of dt";
    }
  }
  report.json = json_text(json);
  report.text = readable_reversal(json);
  return report;
}

}  // namespace

ReversalReport reverse_scenario(const Scenario& scenario, const std::function<bool(std::int64_t)>& pulse) {
  const auto simulation = make_simulation(scenario.request);
  TurnWatch turns(scenario.dt, takes_equal_steps(simulation->method()));
  WayThere way_there(turns, scenario.steps);
  Observer* const observers[] = {&way_there};
  ReversalProgress progress;
  const std::function<bool()> goes_on = [&] { return !pulse || pulse(simulation->step() - progress.first); };
  const StopQuestion question(goes_on);
  Reversal reversal = reverse(*simulation, scenario.steps, pulse, observers, progress,
                              unit_groups(*scenario.problem, scenario.start_q.size()));
  return report_of(scenario, *simulation, std::move(reversal), progress.energy_there, turns, false);
}

ReversalReport reverse_scenario(const Scenario& scenario, const ReversalSettings& settings) {
  if (settings.folder.empty()) return reverse_scenario(scenario, settings.pulse);
  const auto note = [&](const std::string& text) {
    if (settings.note) settings.note(text);
  };
  std::optional<Checkpoint> from;
  WorkFolder folder(settings.folder, reversal_folder(), settings.existing);
  if (!folder.note().empty()) note(folder.note());
  if (folder.goes_on()) from = kept_reversal(scenario, settings.folder);
  folder.prepare(scenario);
  if (from) {
    if (const auto kept = complete_reversal(*from, settings.folder)) {
      note("the reversal is complete: there is nothing to do");
      ReversalReport report;
      report.json = *kept;
      const Json json = read_json(*kept);
      report.status = json["status"].get<std::string>();
      report.expected_bit_exact = json["expected_bit_exact"].get<bool>();
      report.note = json["note"].get<std::string>();
      report.warnings = warning_lines(json);
      report.text = readable_reversal(json);
      return report;
    }
  }
  const auto simulation = make_simulation(scenario.request);
  ReversalCheckpoints checkpoints(scenario, *simulation, settings.folder, from ? &*from : nullptr);
  WayThere way_there(checkpoints.turns(), scenario.steps);
  Observer* const observers[] = {&way_there, &checkpoints};
  const auto asked_at = [&](std::int64_t step) { return !settings.pulse || settings.pulse(step); };
  const std::function<bool()> goes_on = [&] { return asked_at(simulation->step() - checkpoints.progress().first); };
  const StopQuestion question(goes_on);
  Reversal reversal = reverse(
      *simulation, scenario.steps,
      [&](std::int64_t step) {
        checkpoints.write_if_due();
        return asked_at(step);
      },
      observers, checkpoints.progress(), unit_groups(*scenario.problem, scenario.start_q.size()));
  if (reversal.outcome == Outcome::stopped) checkpoints.write();
  ReversalReport report = report_of(scenario, *simulation, std::move(reversal), checkpoints.progress().energy_there,
                                    checkpoints.turns(), true);
  const Reversal& r = report.reversal;
  write_reverse_file(settings.folder / "reverse.h5", scenario.text, r.start, r.turn,
                     r.outcome == Outcome::done ? &r.end : nullptr);
  if (r.outcome == Outcome::done) checkpoints.complete(report.json);
  folder.write("reverse.json", report.json);
  return report;
}

}  // namespace hamflow
