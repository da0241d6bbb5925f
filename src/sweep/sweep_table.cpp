#include "sweep_table.hpp"

#include <algorithm>
#include <limits>

#include "bounce_names.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// A column of `width` numbers a row; value(row) is a vector that may be empty.
template <class F>
SweepColumn vectors(const Sweep& sweep, std::string name, std::size_t width, bool scalar, const F& value) {
  SweepColumn column{std::move(name), width, scalar};
  column.numbers.reserve(sweep.members() * width);
  for (const MemberRow& row : sweep.rows()) {
    const std::vector<double>& x = value(row);
    for (std::size_t i = 0; i < width; ++i) column.numbers.push_back(i < x.size() ? x[i] : nothing);
  }
  return column;
}

template <class F>
SweepColumn numbers(const Sweep& sweep, std::string name, const F& value) {
  SweepColumn column{std::move(name)};
  column.numbers.reserve(sweep.members());
  for (const MemberRow& row : sweep.rows()) column.numbers.push_back(row.q.empty() ? nothing : value(row));
  return column;
}

void add_varied(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    SweepColumn column{"varied/" + varied.keys()[key].path};
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      if (varied.keys()[key].is_number()) {
        column.numbers.push_back(varied.number(member, key));
      } else {
        column.texts.push_back(varied.text(member, key));
      }
    }
    columns.push_back(std::move(column));
  }
}

void add_invariants(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const Scenario& common = sweep.common();
  const std::vector<InvariantInfo>& declared = common.problem->info.invariants;
  const std::vector<std::size_t> sizes =
      common.problem->invariant_sizes(common.request.parameters, common.start_q.size());
  static const InvariantExcursion none{{}, {}, nothing};
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const std::string group = "invariants/" + declared[i].name + "/";
    const auto of = [i](const MemberRow& row) -> const InvariantExcursion& {
      return i < row.invariants.size() ? row.invariants[i] : none;
    };
    const bool scalar = sizes[i] == 1;
    columns.push_back(vectors(sweep, group + "initial", sizes[i], scalar,
                              [&](const MemberRow& row) -> const std::vector<double>& { return of(row).initial; }));
    columns.push_back(vectors(sweep, group + "final", sizes[i], scalar,
                              [&](const MemberRow& row) -> const std::vector<double>& { return of(row).final; }));
    columns.push_back(numbers(sweep, group + "max_error", [&](const MemberRow& row) { return of(row).max_error; }));
  }
}

/// How often each hard wall was met, each event of the user, and how many steps were halved.
void add_events(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const Scenario& common = sweep.common();
  const auto add = [&](const std::string& name, const auto& count) {
    SweepColumn column{"events/" + name};
    for (const MemberRow& row : sweep.rows()) column.counts.push_back(count(row));
    columns.push_back(std::move(column));
  };
  const std::vector<std::string> walls = bounce_names(common);
  std::vector<SweepColumn> of_walls;
  for (const EventCount& wall : bounces_of({}, walls)) of_walls.push_back({"events/" + wall.name});
  for (const MemberRow& row : sweep.rows()) {
    if (of_walls.empty()) break;
    const std::vector<EventCount> counts = bounces_of(row, walls);
    for (std::size_t k = 0; k < counts.size(); ++k) of_walls[k].counts.push_back(counts[k].count);
  }
  columns.insert(columns.end(), of_walls.begin(), of_walls.end());
  for (std::size_t i = 0; i < common.events.size(); ++i) {
    add("user:" + common.events[i].name,
        [i](const MemberRow& row) { return i < row.events.size() ? row.events[i] : 0; });
  }
  if (sweep.halves_steps()) add("halved", [](const MemberRow& row) { return row.halved; });
}

/// Of the event that ended a member's run; of the others an empty text and NaN.
void add_stops(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const std::vector<UserEvent>& events = sweep.common().events;
  if (std::none_of(events.begin(), events.end(), [](const UserEvent& event) { return event.stops; })) return;
  static const std::vector<double> none;
  const std::size_t n = sweep.common().start_q.size();
  SweepColumn event{"stopped_by/event"};
  for (const MemberRow& row : sweep.rows()) {
    event.texts.push_back(row.stopped_by ? events[row.stopped_by->event].name : "");
  }
  columns.push_back(std::move(event));
  columns.push_back(numbers(sweep, "stopped_by/t",
                            [](const MemberRow& row) { return row.stopped_by ? row.stopped_by->t : nothing; }));
  columns.push_back(vectors(sweep, "stopped_by/q", n, false, [](const MemberRow& row) -> const std::vector<double>& {
    return row.stopped_by ? row.stopped_by->q : none;
  }));
  columns.push_back(vectors(sweep, "stopped_by/p", n, false, [](const MemberRow& row) -> const std::vector<double>& {
    return row.stopped_by ? row.stopped_by->p : none;
  }));
}

/// A third is no double: a member is run again from the text.
void add_given(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    if (!varied.keys()[key].is_number()) continue;
    SweepColumn column{"digits/varied/" + varied.keys()[key].path};
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      column.texts.push_back(without_quotes(varied.text(member, key)));
    }
    columns.push_back(std::move(column));
  }
}

/// All digits of a row. Of a member in double, where others have more, those that read back as the same double.
FrameDigits digits_of(const MemberRow& row) {
  if (!row.digits.q.empty() || row.q.empty()) return row.digits;
  FrameDigits all{shortest(row.t), {}, {}, shortest(row.energy.final), shortest(row.energy.initial)};
  for (const double x : row.q) all.q.push_back(shortest(x));
  for (const double x : row.p) all.p.push_back(shortest(x));
  return all;
}

void add_digits(const Sweep& sweep, std::size_t n, std::vector<SweepColumn>& columns) {
  const auto add = [&](const char* name, std::size_t width, bool scalar, const auto& value) {
    SweepColumn column{name, width, scalar};
    for (const MemberRow& row : sweep.rows()) {
      const std::vector<std::string> texts = value(digits_of(row));
      for (std::size_t i = 0; i < width; ++i) column.texts.push_back(i < texts.size() ? texts[i] : "");
    }
    columns.push_back(std::move(column));
  };
  using List = std::vector<std::string>;
  add("digits/final/t", 1, true, [](const FrameDigits& d) { return List{d.time}; });
  add("digits/final/q", n, false, [](const FrameDigits& d) { return d.q; });
  add("digits/final/p", n, false, [](const FrameDigits& d) { return d.p; });
  add("digits/energy/initial", 1, true, [](const FrameDigits& d) { return List{d.initial_energy}; });
  add("digits/energy/final", 1, true, [](const FrameDigits& d) { return List{d.energy}; });
}

}  // namespace

std::vector<EventCount> bounces_of(const MemberRow& row, const std::vector<std::string>& walls) {
  std::vector<EventCount> all;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::int64_t bounces = k < row.walls.size() ? row.walls[k].bounces : 0;
    const auto same =
        std::find_if(all.begin(), all.end(), [&](const EventCount& each) { return each.name == walls[k]; });
    if (same == all.end()) {
      all.push_back({walls[k], bounces});
    } else {
      same->count += bounces;
    }
  }
  return all;
}

std::vector<SweepColumn> columns_of(const Sweep& sweep) {
  std::vector<SweepColumn> columns;
  add_varied(sweep, columns);
  SweepColumn status{"member/status"};
  SweepColumn steps{"member/steps"};
  for (const MemberRow& row : sweep.rows()) {
    status.texts.push_back(row.status_name());
    steps.counts.push_back(row.steps);
  }
  columns.push_back(std::move(status));
  columns.push_back(std::move(steps));
  const std::size_t n = sweep.common().start_q.size();
  columns.push_back(numbers(sweep, "final/t", [](const MemberRow& row) { return row.t; }));
  columns.push_back(
      vectors(sweep, "final/q", n, false, [](const MemberRow& row) -> const std::vector<double>& { return row.q; }));
  columns.push_back(
      vectors(sweep, "final/p", n, false, [](const MemberRow& row) -> const std::vector<double>& { return row.p; }));
  columns.push_back(numbers(sweep, "energy/initial", [](const MemberRow& row) { return row.energy.initial; }));
  columns.push_back(numbers(sweep, "energy/final", [](const MemberRow& row) { return row.energy.final; }));
  columns.push_back(numbers(sweep, "energy/max_error", [](const MemberRow& row) { return row.energy.max_error; }));
  columns.push_back(numbers(sweep, "energy/scale", [](const MemberRow& row) { return row.energy_scale; }));
  add_invariants(sweep, columns);
  add_events(sweep, columns);
  add_stops(sweep, columns);
  for (std::size_t i = 0; i < sweep.observables().names.size(); ++i) {
    columns.push_back(numbers(sweep, "observables/" + sweep.observables().names[i], [&](const MemberRow& row) {
      return i < row.observables.size() ? row.observables[i] : nothing;
    }));
  }
  if (!sweep.beyond_double()) return columns;
  add_digits(sweep, n, columns);
  add_given(sweep, columns);
  return columns;
}

std::vector<SweepColumn> section_columns_of(const Sweep& sweep) {
  if (!sweep.common().section) return {};
  const std::size_t n = sweep.common().start_q.size();
  SweepColumn member{"section/member"};
  SweepColumn t{"section/t"};
  SweepColumn q{"section/q", n, false};
  SweepColumn p{"section/p", n, false};
  for (std::size_t i = 0; i < sweep.members(); ++i) {
    const std::vector<double>& points = sweep.rows()[i].section;
    for (auto at = points.begin(); at != points.end(); at += static_cast<std::ptrdiff_t>(1 + 2 * n)) {
      const auto middle = at + static_cast<std::ptrdiff_t>(1 + n);
      member.counts.push_back(static_cast<std::int64_t>(i));
      t.numbers.push_back(*at);
      q.numbers.insert(q.numbers.end(), at + 1, middle);
      p.numbers.insert(p.numbers.end(), middle, middle + static_cast<std::ptrdiff_t>(n));
    }
  }
  return {std::move(member), std::move(t), std::move(q), std::move(p)};
}

}  // namespace hamflow
