// hamflow reverse: forward, negate the momenta, forward again, negate: what came back.
#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "commands.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/verify/certificate.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace hamflow::app {

namespace {
using Json = nlohmann::ordered_json;

/// H(q, -p) = H(q, p) to rounding, along the way: else the motion itself is not reversed with the momenta.
bool even_in_momenta(const Scenario& scenario, const Reversal& reversal, double scale) {
  for (const Frame* frame : {&reversal.start, &reversal.turn}) {
    std::vector<double> p = frame->p;
    for (double& x : p) x = -x;
    const double there = scenario.problem->energy(scenario.request.parameters, frame->q, frame->p);
    const double back = scenario.problem->energy(scenario.request.parameters, frame->q, p);
    if (std::abs(there - back) > 64 * 0x1p-52 * scale) return false;
  }
  return true;
}

/// What runs on the lattice is made of kicks and drifts, which are one-to-one there; in a palindrome each is undone by
/// its mirror image.
bool palindromic_on_lattice(const Scenario& scenario) {
  return scenario.request.arithmetic == "lattice" && describe(scenario.request.method).symmetric;
}

std::string note_of(const MethodInfo& method, const std::string& arithmetic, bool even, bool expected) {
  if (!even) {
    return "H(q, -p) differs from H(q, p): the motion itself is not reversed by negating the momenta, so that a "
           "distance "
           "says nothing about the method";
  }
  if (expected) return "a palindromic splitting on the lattice returns every bit";
  if (!method.reversible)
    return method.name + " is not reversible: the distance is its own, not that of rounding alone";
  if (arithmetic != "lattice") {
    return method.name +
           " is reversible, but rounding is not: with run.arithmetic = \"lattice\" a palindromic splitting "
           "returns every bit";
  }
  return {};
}

Json state(const Frame& frame) {
  if (!frame.digits.q.empty()) return {{"q", frame.digits.q}, {"p", frame.digits.p}};
  return {{"q", frame.q}, {"p", frame.p}};
}
std::string hex(std::uint64_t x) { return fmt::format("{:016x}", x); }

Json report_of(const Scenario& scenario, const Simulation& simulation, const Reversal& r) {
  const MethodInfo method = describe(scenario.request.method);
  const bool even = even_in_momenta(scenario, r, simulation.energy_scale());
  const bool expected = even && palindromic_on_lattice(scenario);
  const bool done = r.outcome == Outcome::done;
  Json s{{"status", status_of(r.outcome)},
         {"problem", scenario.request.problem},
         {"method", method.name},
         {"arithmetic", scenario.request.arithmetic},
         {"dt", scenario.dt},
         {"steps", r.steps},
         {"start", state(r.start)},
         {"returned", done ? state(r.end) : Json(nullptr)},
         {"distance", done ? Json(r.distance) : Json(nullptr)},
         {"relative_distance", done ? Json(r.relative_distance) : Json(nullptr)},
         {"bit_exact", done ? Json(r.bit_exact) : Json(nullptr)},
         {"hash",
          {{"start", hex(r.start_hash)},
           {"turn", done ? Json(hex(r.turn_hash)) : Json(nullptr)},
           {"end", done ? Json(hex(r.end_hash)) : Json(nullptr)}}},
         {"method_reversible", method.reversible},
         {"expected_bit_exact", expected},
         {"note", note_of(method, scenario.request.arithmetic, even, expected)}};
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
    return joined(xs, [](const Json& x) {
      return x.is_string() ? x.get<std::string>() : fmt::format("{:.17g}", x.get<double>());
    });
  };
  std::string text = row("status", s["status"].get<std::string>()) + row("problem", s["problem"].get<std::string>());
  text += row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s["method"].get<std::string>(),
                                    s["dt"].get<double>(), s["arithmetic"].get<std::string>()));
  text += row("steps", fmt::format("{} there, {} back", s["steps"].get<long long>(), s["steps"].get<long long>()));
  text += row("start q", list(s["start"]["q"])) + row("start p", list(s["start"]["p"]));
  if (!s["returned"].is_null()) {
    text += row("returned q", list(s["returned"]["q"])) + row("returned p", list(s["returned"]["p"]));
    text += row("distance", fmt::format("{:.3g} ({:.3g} of the start's size)", s["distance"].get<double>(),
                                        s["relative_distance"].get<double>()));
    text += row("every bit", s["bit_exact"].get<bool>() ? "yes" : "no");
    text +=
        row("hash of the bits", fmt::format("{} -> {} -> {}", s["hash"]["start"].get<std::string>(),
                                            s["hash"]["turn"].get<std::string>(), s["hash"]["end"].get<std::string>()));
  }
  if (!s["note"].get<std::string>().empty()) text += row("note", s["note"].get<std::string>());
  return text;
}

int carry_out(const Scenario& scenario, const ReverseOptions& options) {
  if (!options.quiet) {
    for (const std::string& note : scenario.notes) std::cerr << "note: " << note << '\n';
  }
  const auto simulation = make_simulation(scenario.request);
  catch_interrupts();
  Reversal reversal;
  {
    Progress progress(0, 2 * scenario.steps, options.quiet);
    reversal = reverse(*simulation, scenario.steps, [&](std::int64_t step) {
      progress.show(step);
      return !interrupted();
    });
  }
  const Json report = report_of(scenario, *simulation, reversal);
  std::cout << (options.json ? json_text(report) : readable_reversal(report));
  if (report["status"] == "failed") {
    std::cerr << "error: " << report["error"]["message"].get<std::string>()
              << "\nhint: " << report["error"]["hint"].get<std::string>() << '\n';
    return exit_failed;
  }
  return reversal.outcome == Outcome::stopped ? exit_interrupted : exit_done;
}

}  // namespace

int reverse_scenario(const ReverseOptions& options) {
  try {
    const Reading reading = read_scenario(options.scenario, options.sets);
    if (reading.scenario) return carry_out(*reading.scenario, options);
    for (const Complaint& complaint : reading.complaints) std::cerr << complaint.text() << '\n';
    if (options.json) std::cout << json_text(rejection_of(reading.complaints));
    return exit_rejected;
  } catch (const FileError& error) {
    std::cerr << "error: " << error.what() << '\n';
    if (options.json) {
      std::cout << json_text({{"status", "failed"}, {"error", {{"kind", "file"}, {"message", error.what()}}}});
    }
    return exit_file;
  }
}

}  // namespace hamflow::app
