#include "sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "number_text.hpp"
#include "run_keys.hpp"
#include "summary.hpp"
#include "sweep_table.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t most_failures = 10;

std::size_t count(const Sweep& sweep, Outcome status) {
  return static_cast<std::size_t>(std::count_if(sweep.rows().begin(), sweep.rows().end(), [&](const MemberRow& row) {
    return row.status == status && !row.no_start;
  }));
}
std::size_t count_without_start(const Sweep& sweep) {
  return static_cast<std::size_t>(
      std::count_if(sweep.rows().begin(), sweep.rows().end(), [](const MemberRow& row) { return row.no_start; }));
}

/// The first members that failed; behind those that broke off the ones without a start, of which there may be many.
Json failures_of(const Sweep& sweep) {
  Json all = Json::array();
  for (const bool no_start : {false, true}) {
    for (std::size_t member = 0; member < sweep.members() && all.size() < most_failures; ++member) {
      const MemberRow& row = sweep.rows()[member];
      if (row.message.empty() || row.no_start != no_start) continue;
      all.push_back({{"member", member},
                     {"kind", row.status_name()},
                     {"step", row.no_start ? 0 : row.steps + 1},
                     {"t", row.t},
                     {"message", row.message}});
    }
  }
  return all;
}

/// Of all members together. That dt is long for an oscillation, or an orbit falls into the centre, is said by a run of
/// a single member.
Json sweep_warnings(const Sweep& sweep) {
  const auto is_nonsense = [](const MemberRow& row) { return row.nonsense; };
  const auto first = std::find_if(sweep.rows().begin(), sweep.rows().end(), is_nonsense);
  const auto count = std::count_if(first, sweep.rows().end(), is_nonsense);
  Json all = Json::array();
  if (count == 0) return all;
  all.push_back(
      {{"kind", "energy_error"},
       {"message",
        fmt::format("the energy of {} of {} members was off by more than the motion exchanges, first of member "
                    "{}: they are done, but no motion of {}; try a smaller dt",
                    count, sweep.members(), first - sweep.rows().begin(), sweep.common().request.problem)}});
  return all;
}

Json varied_of(const Sweep& sweep) {
  Json varied = Json::object();
  const std::vector<Vary>& keys = sweep.varied().keys();
  for (std::size_t key = 0; key < keys.size(); ++key) {
    const Vary& vary = keys[key];
    Json& entry = varied[vary.path];
    entry["count"] = vary.formula.empty() ? vary.texts.size() : sweep.members();
    if (!vary.is_number()) {
      entry["values"] = Json::array();
      for (const std::string& text : vary.texts) entry["values"].push_back(without_quotes(text));
      continue;
    }
    entry["first"] = sweep.varied().number(0, key);
    entry["last"] = sweep.varied().number(sweep.members() - 1, key);
    if (!vary.formula.empty()) entry["formula"] = vary.formula;
  }
  return varied;
}

/// What one key says of every member; null where it is varied: the summary's "varied" has it then.
Json common_to_all(const Sweep& sweep, const std::string& path, const std::string& value) {
  const std::vector<Vary>& keys = sweep.varied().keys();
  const bool is_varied = std::any_of(keys.begin(), keys.end(), [&](const Vary& key) { return key.path == path; });
  return is_varied ? Json(nullptr) : Json(value);
}

}  // namespace

Json sweep_row(const Sweep& sweep, std::size_t member) {
  const MemberRow& row = sweep.rows()[member];
  Json json = Json::object();
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    const Vary& vary = varied.keys()[key];
    const std::string text = varied.text(member, key);
    json[vary.path] = vary.is_number() ? Json(varied.number(member, key)) : Json(without_quotes(text));
    if (!vary.is_number() || !sweep.beyond_double()) continue;
    // A third is no double: the row gives what the member can be run again from.
    const std::string given = without_quotes(text);
    if (given != shortest(varied.number(member, key))) json[vary.path] = given;
  }
  json["status"] = row.status_name();
  json["steps"] = row.steps;
  if (row.no_start) json["message"] = row.message;
  if (row.status == Outcome::not_run) return json;
  json["final"] = {{"t", row.t}, {"q", row.q}, {"p", row.p}};
  json["energy"] = {{"initial", row.energy.initial},
                    {"final", row.energy.final},
                    {"max_error", row.energy.max_error},
                    {"scale", row.energy.scale()}};
  if (!row.digits.q.empty()) {  // more digits than a JSON number may be read with: texts
    json["final"] = {{"t", row.digits.time}, {"q", row.digits.q}, {"p", row.digits.p}};
    json["energy"]["initial"] = row.digits.initial_energy;
    json["energy"]["final"] = row.digits.energy;
  }
  json["invariants"] = Json::object();
  const MemberNames& names = sweep.names().of(member);
  for (const UnitedName& invariant : sweep.names().invariants()) {
    const InvariantExcursion* const seen = value_of(sweep, invariant, member, &MemberRow::invariants);
    Json& entry = json["invariants"][invariant.name];
    entry = {{"initial", nullptr}, {"final", nullptr}, {"max_error", nullptr}};
    if (seen == nullptr) continue;
    entry = invariant_json(names.invariants[sweep.names().places(invariant, member).front()], *seen);
  }
  json["events"] = Json::object();
  for (const EventCount& event : events_of(sweep, member)) json["events"][event.name] = event.count;
  if (!row.event_notes.empty()) json["event_notes"] = row.event_notes;
  if (row.stopped_by) {
    json["stopped_by"] = json_of(names.events.at(row.stopped_by->event), *row.stopped_by);
  }
  for (const UnitedName& observable : sweep.names().observables()) {
    if (row.observables.empty() && !names.observables.empty()) break;  // not done
    const double* const x = value_of(sweep, observable, member, &MemberRow::observables);
    json[observable.name] = x == nullptr ? Json(nullptr) : Json(*x);
  }
  for (const NamedExpression& observable : sweep.common().observables) {  // as in the summary of the single run
    for (const char* what : {"initial", "mean", "final"}) {
      const auto column = json.find(observable.name + "_" + what);
      if (column != json.end()) json[output_keys().observables.name][observable.name][what] = Json(*column);
    }
  }
  if (sweep.common().section) {
    json["section"] = {{"points", row.section_points()}, {"max_residual", row.section_residual}};
    if (!row.section_message.empty()) json["section"]["message"] = row.section_message;
  }
  if (!row.message.empty()) json["message"] = row.message;
  return json;
}

Json sweep_summary(const Sweep& sweep, double seconds, bool interrupted) {
  const std::size_t done = count(sweep, Outcome::done);
  const std::size_t unfinished = count(sweep, Outcome::stopped) + count(sweep, Outcome::not_run);
  const std::size_t failed = sweep.members() - done - unfinished;
  std::int64_t steps = 0;
  for (const MemberRow& row : sweep.rows()) steps += row.steps;
  Json s;
  s["status"] = interrupted && unfinished > 0 ? "interrupted" : done == 0 ? "failed" : "done";
  s["problem"] = common_to_all(sweep, "problem.name", sweep.common().request.problem);
  s["arithmetic"] = common_to_all(sweep, run_path(run_keys().arithmetic), sweep.common().request.arithmetic);
  s["kernel"] = common_to_all(sweep, run_path(run_keys().kernel), sweep.common().request.kernel);
  s["members"] = sweep.members();
  s["done"] = done;
  s["failed"] = failed;
  s["unfinished"] = unfinished;
  if (const std::size_t without = count_without_start(sweep); without > 0) s["no_start"] = without;
  s["varied"] = varied_of(sweep);
  s["wall_seconds"] = seconds;
  s["member_steps_per_second"] = seconds > 0 ? static_cast<double>(steps) / seconds : 0.0;
  s["members_per_second"] = seconds > 0 ? static_cast<double>(done + failed) / seconds : 0.0;
  s["instruction_set"] = std::string(name(sweep.lanes()));
  s["lanes"] = sweep.members_in_lanes() > 0 ? sweep.lane_count() : 1;
  s["members_in_lanes"] = sweep.members_in_lanes();
  if (sweep.beyond_double()) s["note"] = "members beyond double run one by one on the threads: lanes are for double";
  s["threads"] = sweep.threads();
  s["warnings"] = sweep_warnings(sweep);
  if (sweep.common().section) {
    std::size_t points = 0;
    for (const MemberRow& row : sweep.rows()) points += row.section_points();
    s["section"] = {{"points", points}};
  }
  s["failures"] = failures_of(sweep);
  return s;
}

std::string readable_sweep(const Json& s) {
  std::string text;
  const auto line = [&](std::string_view label, const std::string& what) {
    text += fmt::format("{:<20}{}\n", label, what);
  };
  line("status", s["status"].get<std::string>());
  line("members",
       fmt::format("{} ({} done, {} failed, {} unfinished)", s["members"].get<std::size_t>(),
                   s["done"].get<std::size_t>(), s["failed"].get<std::size_t>(), s["unfinished"].get<std::size_t>()));
  if (s.contains("no_start")) {
    line("no start", fmt::format("{} of the failed: the energy, or what a formula asks for, is out of reach",
                                 s["no_start"].get<std::size_t>()));
  }
  for (const auto& [path, entry] : s["varied"].items()) {
    const auto count = entry["count"].get<std::size_t>();
    std::string values = counted(count, "value");
    if (entry.contains("first")) {
      values += count == 1
                    ? fmt::format(", {:g}", entry["first"].get<double>())
                    : fmt::format(", first {:g}, last {:g}", entry["first"].get<double>(), entry["last"].get<double>());
    }
    line("varied", path + ": " + values);
  }
  if (s.contains("section")) line("section", counted(s["section"]["points"].get<std::size_t>(), "point"));
  line("lanes", fmt::format("{} ({}), {} in lanes, threads {}", s["lanes"].get<std::size_t>(),
                            s["instruction_set"].get<std::string>(),
                            counted(s["members_in_lanes"].get<std::size_t>(), "member"), s["threads"].get<int>()));
  if (s.contains("note")) line("note", s["note"].get<std::string>());
  line("wall time", fmt::format("{:.3g} s, {:.4g} member steps/s, {:.4g} members/s", s["wall_seconds"].get<double>(),
                                s["member_steps_per_second"].get<double>(), s["members_per_second"].get<double>()));
  return text;
}

}  // namespace hamflow
