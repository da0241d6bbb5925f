// The summary of a run for people: a line for each entry.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "certificate_json.hpp"
#include "hamflow/core/text.hpp"
#include "json_text.hpp"
#include "measures/measure.hpp"
#include "number_text.hpp"
#include "summary.hpp"

namespace hamflow {

nlohmann::ordered_json json_of(const LongNumber& x) {
  return x.text.empty() ? nlohmann::ordered_json(x.value) : nlohmann::ordered_json(x.text);
}

nlohmann::ordered_json json_of(const std::string& event, const MemberStop& stop) {
  const FrameDigits& digits = stop.digits;
  if (digits.q.empty()) return {{"event", event}, {"t", stop.t}, {"q", stop.q}, {"p", stop.p}};
  return {{"event", event}, {"t", digits.time}, {"q", digits.q}, {"p", digits.p}};
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string number_text(const nlohmann::ordered_json& x, const char* form, const char* none) {
  if (x.is_string()) return x.get<std::string>();
  // A live summary holds what JSON writes as null: both have to read alike.
  if (x.is_null() || !std::isfinite(x.get<double>())) return none;
  return fmt::format(fmt::runtime(form), x.get<double>());
}

namespace {
using Json = nlohmann::ordered_json;

std::string orbit_text(const Json& orbit) {
  std::string text = orbit["type"].get<std::string>();
  if (!orbit["conic"].is_null()) text += " (" + orbit["conic"].get<std::string>() + ")";
  const auto number = [&](const char* key) { return number_text(orbit[key], "{:.6g}"); };
  const auto is_finite = [](const Json& x) {
    return x.is_string() || (!x.is_null() && std::isfinite(x.get<double>()));
  };
  const bool bounded = is_finite(orbit["r_max"]);
  text += fmt::format(", r = {} .. {}, apsidal angle {}", number("r_min"), bounded ? number("r_max") : "inf",
                      is_finite(orbit["apsidal_angle"]) ? number("apsidal_angle") : "infinite or not known");
  if (orbit["falls_into_centre"].get<bool>()) text += ", falls into the centre";
  return text;
}
}  // namespace

std::string readable(const Json& s) {
  const auto row = [](std::string_view label, const std::string& text) {
    return fmt::format("{:<19} {}\n", label, text);
  };
  const auto number = [](const Json& x) { return value_text(x, "{:.17g}"); };
  const auto list = [&](const Json& xs) { return joined(xs, number); };
  const auto shown = [&](const Json& x) { return x.is_array() ? "[" + list(x) + "]" : number(x); };
  const auto watched = [&](const Json& x) {
    const std::string ends = fmt::format("{} -> {}, ", shown(x["initial"]), shown(x["final"]));
    const Json& off = x["max_error"];
    if (off.is_null() || (off.is_number() && !std::isfinite(off.get<double>())))
      return ends + "how far off is not known";
    return ends + "at most " + number_text(off, "{:.3g}") + " off";
  };
  std::string text = row("status", s["status"].get<std::string>());
  text += row("problem", s["problem"].get<std::string>());
  text += row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s["method"].get<std::string>(),
                                    s["dt"].get<double>(), s["arithmetic"].get<std::string>()));
  text += row("steps", fmt::format("{}, t = {}", s["steps"].get<std::int64_t>(), number(s["final"]["t"])));
  constexpr std::size_t most_shown = 60;
  for (const char* const key : {"q", "p"}) {
    if (!s["final"].contains(key)) continue;
    const Json& numbers = s["final"][key];
    text += row(std::string("final ") + key, numbers.size() <= most_shown
                                                 ? list(numbers)
                                                 : fmt::format("{} numbers (--json prints them)", numbers.size()));
  }
  const Json& energy = s["energy"];
  const bool has_scale = !energy["scale"].is_null() && energy["scale"].get<double>() > 0 &&
                         (!energy["max_relative_error"].is_null() || energy["max_error"].is_null());
  const bool driven = s.contains("hamiltonian");
  if (driven) {
    text += row("H(q, p, t)", number_text(s["hamiltonian"]["initial"], "{:.17g}") + " -> " +
                                  number_text(s["hamiltonian"]["final"], "{:.17g}"));
  }
  text += row(driven ? "H - int dH/dt" : "energy",
              watched(s["energy"]) + (has_scale ? fmt::format(" ({} of its scale)",
                                                              number_text(s["energy"]["max_relative_error"], "{:.3g}"))
                                                : " (not relative: H is 0 at the start)"));
  for (const auto& [key, watch] : s["invariants"].items()) text += row(key, watched(watch));
  if (s.contains("constraints")) {
    const Json& residuals = s["constraints"];
    text += row("constraints", "|g| at most " + number_text(residuals["position"], "{:.3g}") +
                                   ", |g' M^-1 p| at most " + number_text(residuals["velocity"], "{:.3g}"));
  }
  if (s.contains("exact")) {
    const Json& exact = s["exact"];
    std::string off;
    for (const auto& [name, difference] : exact["differences"].items()) {
      off += (off.empty() ? "" : ", ") + number_text(difference, "{:.3g}") + " (" + name + ")";
    }
    const bool unknown = exact.contains("uncertainty") && !exact["max_difference"].is_null() &&
                         exact["max_difference"].get<double>() <= exact["uncertainty"].get<double>();
    text += row("exact", unknown ? fmt::format("at most {} off the closed form, which is known to {:.2g} only", off,
                                               exact["uncertainty"].get<double>())
                                 : fmt::format("at most {} off the exact state", off));
  }
  if (s.contains("orbit")) text += row("orbit", orbit_text(s["orbit"]));
  if (s.contains("bodies")) {
    for (const Json& body : s["bodies"]) {
      text += row("body", fmt::format("mass {}, at [{}], velocity [{}]", number(body["mass"]), list(body["position"]),
                                      list(body["velocity"])));
    }
  }
  if (s.contains("diagnostics")) {
    for (const auto& [key, x] : s["diagnostics"].items()) {
      if (x.is_null()) continue;
      text += row(key == "condition_inverse_mass" ? "condition_M^-1" : key,
                  fmt::format("{} (t = {:g}) .. {} (t = {:g})", number_text(x["min"], "{:.6g}"),
                              x["t_min"].get<double>(), number_text(x["max"], "{:.6g}"), x["t_max"].get<double>()));
    }
  }
  text +=
      row("evaluations",
          fmt::format("force {}, gradient {}, Hessian {}, linear solves {}", s["evaluations"]["force"].get<long long>(),
                      s["evaluations"]["gradient"].get<long long>(), s["evaluations"]["hessian"].get<long long>(),
                      s["evaluations"]["linear_solves"].get<long long>()));
  if (!s["newton"].is_null()) {
    const std::string chosen =
        s["newton"].contains("iteration") ? ", iteration " + s["newton"]["iteration"].get<std::string>() : "";
    text += row("Newton per step",
                fmt::format("min {}, mean {:.4g}, max {}, stagnated {}", s["newton"]["min"].get<long long>(),
                            s["newton"]["mean"].get<double>(), s["newton"]["max"].get<long long>(),
                            s["newton"]["stagnated"].get<long long>()) +
                    chosen);
  }
  for (const auto& [key, value] : s["events"].items()) text += row("event " + key, written_json(value));
  if (s.contains("event_notes")) {
    for (const Json& note : s["event_notes"]) text += row("event note", note.get<std::string>());
  }
  for (const MeasureKind& kind : measure_kinds()) {
    if (s.contains(kind.key)) text += row(kind.label, kind.text(s[kind.key]));
  }
  if (s.contains("certificate") && !s["certificate"].is_null()) {
    text += row("certificate", certificate_text(s["certificate"]));
  } else if (s.contains("certificate") && !energy["scale"].is_null()) {  // a map has neither
    text += row("certificate", "not asked for");
  }
  text += row("wall time", fmt::format("{:.3g} s, {:.4g} steps/s", s["wall_seconds"].get<double>(),
                                       s["steps_per_second"].get<double>()));
  return text;
}

}  // namespace hamflow
