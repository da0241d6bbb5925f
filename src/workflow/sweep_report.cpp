#include "sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "json_text.hpp"
#include "number_text.hpp"
#include "run_keys.hpp"
#include "summary.hpp"
#include "summary_fields.hpp"
#include "sweep_table.hpp"

namespace hamflow {

namespace {

constexpr std::size_t most_failures = 10;

std::size_t count(const Sweep& sweep, Outcome status) {
  return static_cast<std::size_t>(std::ranges::count_if(
      sweep.own_rows(), [&](const MemberRow& row) { return row.status == status && !row.no_start; }));
}
std::size_t count_without_start(const Sweep& sweep) {
  return static_cast<std::size_t>(
      std::ranges::count_if(sweep.own_rows(), [](const MemberRow& row) { return row.no_start; }));
}

/// Returns the first members that failed. Members without a start come last, because there may be many of them.
std::vector<MemberFailure> failures_of(const Sweep& sweep) {
  std::vector<MemberFailure> all;
  for (const bool no_start : {false, true}) {
    for (std::size_t member = 0; member < sweep.members() && all.size() < most_failures; ++member) {
      const MemberRow& row = sweep.row(member);
      if (row.message.empty() || row.no_start != no_start) continue;
      all.push_back({member, row.status_name(), row.no_start ? 0 : row.steps + 1, row.t, row.message});
    }
  }
  return all;
}

/// How many members have a mark, and the first of them.
struct Marked {
  std::ptrdiff_t count = 0;
  std::size_t first = 0;
};
Marked members_with(const Sweep& sweep, bool MemberRow::*mark) {
  const auto first = std::ranges::find_if(sweep.own_rows(), mark);
  const auto count = std::count_if(first, sweep.own_rows().end(), std::mem_fn(mark));
  return {count, count == 0 ? 0 : sweep.own_member(static_cast<std::size_t>(first - sweep.own_rows().begin()))};
}

/// Returns the warnings for all members together. Only a run of a single member warns about a long dt or a fall into
/// the centre.
std::vector<Warning> sweep_warnings(const Sweep& sweep) {
  std::vector<Warning> all;
  if (const Marked found = members_with(sweep, &MemberRow::nonsense); found.count > 0) {
    all.push_back(
        {"energy_error",
         fmt::format("the energy error of {} of {} members is larger than the energy that the motion exchanges, first "
                     "in member {}; these results of {} are meaningless; try a smaller dt",
                     found.count, sweep.own_members(), found.first, sweep.common().request.problem)});
  }
  if (const Marked found = members_with(sweep, &MemberRow::close_encounter); found.count > 0) {
    all.push_back({"close_encounter",
                   fmt::format("in {} of {} members, first in member {}, two bodies came within 3 Hill radii of each "
                               "other, where {} is inaccurate; a run of that member names them; try dop853, which "
                               "adapts its steps, or a smaller dt",
                               found.count, sweep.own_members(), found.first, sweep.common().request.method.name)});
  }
  return all;
}

Named<VariedKey> varied_of(const Sweep& sweep) {
  Named<VariedKey> varied;
  const std::vector<Vary>& keys = sweep.varied().keys();
  for (std::size_t key = 0; key < keys.size(); ++key) {
    const Vary& vary = keys[key];
    VariedKey& entry = varied.emplace_back(vary.path, VariedKey{}).second;
    entry.count = vary.formula.empty() ? vary.count() : sweep.members();
    if (!vary.is_number()) {
      for (std::size_t i = 0; i < vary.count(); ++i) entry.values.push_back(without_quotes(vary.text(i)));
      continue;
    }
    entry.first = sweep.varied().number(0, key);
    entry.last = sweep.varied().number(sweep.members() - 1, key);
    entry.formula = vary.formula;
  }
  return varied;
}

/// Returns the value of a key that is the same for all members; nullopt if the key is varied.
std::optional<std::string> common_to_all(const Sweep& sweep, const std::string& path, const std::string& value) {
  const std::vector<Vary>& keys = sweep.varied().keys();
  const bool is_varied = std::any_of(keys.begin(), keys.end(), [&](const Vary& key) { return key.path == path; });
  return is_varied ? std::nullopt : std::optional(value);
}

Named<Value> varied_of_member(const Sweep& sweep, std::size_t member) {
  Named<Value> all;
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    const Vary& vary = varied.keys()[key];
    const std::string given = without_quotes(varied.text(member, key));
    // A number such as 1/3 is not a double. With more digits than double the row contains its text, from which the
    // member can be run again.
    const bool is_double =
        vary.is_number() && (!sweep.beyond_double() || given == shortest(varied.number(member, key)));
    all.emplace_back(vary.path, is_double ? Value(varied.number(member, key)) : Value(given));
  }
  return all;
}

Named<double> columns_of_member(const Sweep& sweep, std::size_t member) {
  Named<double> all;
  if (sweep.row(member).observables.empty() && !sweep.names().of(member).observables.empty())
    return all;  // the member is not finished
  for (const MergedName& name : sweep.names().observables()) {
    const double* const x = value_of(sweep, name, member, &MemberRow::observables);
    all.emplace_back(name.name, x == nullptr ? std::numeric_limits<double>::quiet_NaN() : *x);
  }
  return all;
}

/// Returns the observables as in the summary of a single run.
std::vector<ObservableSummary> observables_of_member(const Sweep& sweep, const Named<double>& columns) {
  std::vector<ObservableSummary> all;
  if (columns.empty()) return all;
  for (const NamedExpression& observable : sweep.common().observables) {
    const auto value = [&](const char* what) {
      const auto column = std::ranges::find(columns, observable.name + what, &std::pair<std::string, double>::first);
      return column != columns.end() ? column->second : std::numeric_limits<double>::quiet_NaN();
    };
    all.push_back({observable.name, value("_initial"), value("_mean"), value("_final")});
  }
  return all;
}

SweepRow sweep_row(const Sweep& sweep, std::size_t member) {
  const MemberRow& row = sweep.row(member);
  SweepRow all{.varied = varied_of_member(sweep, member),
               .status = row.status_name(),
               .steps = row.steps,
               .message = row.message};
  if (row.status == Outcome::not_run) return all;
  all.final = state_at(row.t, row.q, row.p, row.digits);
  all.energy = {with_digits(row.energy.initial, row.digits.initial_energy),
                with_digits(row.energy.final, row.digits.energy), row.energy.max_error, row.energy.scale()};
  const MemberNames& names = sweep.names().of(member);
  for (const MergedName& invariant : sweep.names().invariants()) {
    const InvariantExcursion* const seen = value_of(sweep, invariant, member, &MemberRow::invariants);
    auto& entry = all.invariants.emplace_back(invariant.name, std::nullopt).second;
    if (seen == nullptr) continue;
    entry = invariant_summary(names.invariants[sweep.names().places(invariant, member).front()], *seen);
  }
  for (const EventCount& event : events_of(sweep, member)) all.events.emplace_back(event.name, event.count);
  all.event_notes = row.event_notes;
  if (row.stopped_by) all.stopped_by = stop_summary(names.events.at(row.stopped_by->event), *row.stopped_by);
  all.columns = columns_of_member(sweep, member);
  all.observables = observables_of_member(sweep, all.columns);
  if (sweep.common().section) {
    all.section = {static_cast<std::int64_t>(row.section_points()), row.section_residual, row.section_message};
  }
  return all;
}

}  // namespace

SweepSummary sweep_summary(const Sweep& sweep, double seconds, bool interrupted, bool with_rows) {
  std::int64_t steps = 0;
  for (const MemberRow& row : sweep.own_rows()) steps += row.steps;
  SweepSummary s;
  s.members = sweep.own_members();
  if (sweep.shard().count > 1) s.shard = fmt::format("{}/{}", sweep.shard().index, sweep.shard().count);
  s.done = count(sweep, Outcome::done);
  s.unfinished = sweep.members_left();
  s.failed = s.members - s.done - s.unfinished;
  s.no_start = count_without_start(sweep);
  s.status = interrupted && s.unfinished > 0 ? "interrupted" : s.done == 0 && s.members > 0 ? "failed" : "done";
  const Request& common = sweep.common().request;
  s.problem = common_to_all(sweep, "problem.name", common.problem);
  s.arithmetic = common_to_all(sweep, run_path(run_keys().arithmetic), common.arithmetic);
  s.varied = varied_of(sweep);
  s.wall_seconds = seconds;
  s.member_steps_per_second = seconds > 0 ? static_cast<double>(steps) / seconds : 0.0;
  s.members_per_second = seconds > 0 ? static_cast<double>(s.done + s.failed) / seconds : 0.0;
  s.instruction_set = name(sweep.lanes());
  s.lanes = sweep.members_in_lanes() > 0 ? sweep.lane_count() : 1;
  s.members_in_lanes = sweep.members_in_lanes();
  if (sweep.beyond_double()) s.note = "SIMD lanes need double arithmetic, so each thread runs one member at a time";
  s.threads = sweep.threads();
  s.warnings = sweep_warnings(sweep);
  if (sweep.common().section) {
    s.section_points = 0;
    for (const MemberRow& row : sweep.own_rows()) *s.section_points += row.section_points();
  }
  s.failures = failures_of(sweep);
  const std::size_t rows = with_rows && s.members <= SweepSummary::most_rows ? s.members : 0;
  for (std::size_t member = 0; member < rows; ++member) s.rows.push_back(sweep_row(sweep, member));
  return s;
}

template <class Ar>
void fields(Ar& ar, VariedKey& x) {
  ar("count", x.count);
  if (!x.first) return ar("values", x.values);
  ar("first", x.first, "last", x.last);
  ar.if_any("formula", x.formula);
}

template <class Ar>
void fields(Ar& ar, MemberFailure& x) {
  ar("member", x.member, "kind", x.kind, "step", x.step, "t", x.t, "message", x.message);
}

template <class Ar>
void fields(Ar& ar, MemberEnergy& x) {
  ar("initial", x.initial, "final", x.final, "max_error", x.max_error, "scale", x.scale);
}

/// The entry of a member that does not have this invariant.
struct NoInvariant {
  std::optional<double> nothing;
};
template <class Ar>
void fields(Ar& ar, NoInvariant& x) {
  for (const char* key : {"initial", "final", "max_error"}) ar(key, x.nothing);
}

template <class Ar>
void fields(Ar& ar, SweepRow& x) {
  for (auto& [path, value] : x.varied) ar(path, value);
  ar("status", x.status, "steps", x.steps);
  if (!x.final) return ar.if_any("message", x.message);
  ar("final", x.final, "energy", x.energy);
  Ar invariants;
  for (auto& [name, seen] : x.invariants) {
    if (seen) {
      invariants(name, *seen);
    } else {
      invariants(name, NoInvariant());
    }
  }
  ar("invariants", invariants.take(), "events", x.events);
  ar.if_any("event_notes", x.event_notes);
  ar.if_any("stopped_by", x.stopped_by);
  for (auto& [name, value] : x.columns) ar(name, value);
  if (!x.observables.empty()) ar.by_name(output_keys().observables.name, x.observables);
  ar.if_any("section", x.section);
  ar.if_any("message", x.message);
}

std::string sweep_json(const SweepSummary& x, bool with_rows) {
  JsonWriter ar;
  format_of_file(ar);
  ar("status", x.status, "problem", x.problem, "arithmetic", x.arithmetic, "members", x.members, "done", x.done,
     "failed", x.failed, "unfinished", x.unfinished);
  ar.if_any("shard", x.shard);
  if (x.no_start > 0) ar("no_start", x.no_start);
  ar("varied", x.varied, "wall_seconds", x.wall_seconds, "member_steps_per_second", x.member_steps_per_second,
     "members_per_second", x.members_per_second, "instruction_set", x.instruction_set, "lanes", x.lanes,
     "members_in_lanes", x.members_in_lanes);
  ar.if_any("note", x.note);
  ar("threads", x.threads, "warnings", x.warnings);
  if (x.section_points) ar("section", Named<std::size_t>{{"points", *x.section_points}});
  ar("failures", x.failures);
  if (with_rows) ar.if_any("rows", x.rows);
  return json_text(ar.take());
}

std::string sweep_text(const SweepSummary& s) {
  std::string text;
  const auto line = [&](std::string_view label, const std::string& what) {
    text += fmt::format("{:<20}{}\n", label, what);
  };
  line("status", s.status);
  line("members", fmt::format("{} ({} done, {} failed, {} unfinished)", s.members, s.done, s.failed, s.unfinished));
  if (!s.shard.empty()) line("shard", s.shard);
  if (s.no_start > 0) {
    line("no start",
         fmt::format("{} of the failed members: no start has the given energy, or a formula has no value", s.no_start));
  }
  for (const auto& [path, key] : s.varied) {
    std::string values = counted(key.count, "value");
    if (key.first) {
      values += key.count == 1 ? fmt::format(", {:g}", *key.first)
                               : fmt::format(", first {:g}, last {:g}", *key.first, *key.last);
    }
    line("varied", path + ": " + values);
  }
  if (s.section_points) line("section", counted(*s.section_points, "point"));
  line("lanes", fmt::format("{} ({}), {} in lanes, threads {}", s.lanes, s.instruction_set,
                            counted(s.members_in_lanes, "member"), s.threads));
  if (!s.note.empty()) line("note", s.note);
  line("wall time", fmt::format("{:.3g} s, {:.4g} member steps/s, {:.4g} members/s", s.wall_seconds,
                                s.member_steps_per_second, s.members_per_second));
  return text;
}

}  // namespace hamflow
