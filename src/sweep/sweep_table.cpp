#include "sweep_table.hpp"

#include <algorithm>
#include <limits>

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
        column.texts.push_back(without_quotes(varied.text(member, key)));
      }
    }
    columns.push_back(std::move(column));
  }
}

void add_invariants(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  static const InvariantExcursion none{{}, {}, nothing};
  for (const UnitedName& invariant : sweep.names().invariants()) {
    const std::string group = "invariants/" + invariant.name + "/";
    const std::size_t size = sweep.names().size(invariant);
    std::vector<const InvariantExcursion*> seen;
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      const InvariantExcursion* const own = value_of(sweep, invariant, member, &MemberRow::invariants);
      seen.push_back(own == nullptr ? &none : own);
    }
    const auto of = [&](const MemberRow& row) -> const InvariantExcursion& {
      return *seen[static_cast<std::size_t>(&row - sweep.rows().data())];
    };
    columns.push_back(vectors(sweep, group + "initial", size, size == 1,
                              [&](const MemberRow& row) -> const std::vector<double>& { return of(row).initial; }));
    columns.push_back(vectors(sweep, group + "final", size, size == 1,
                              [&](const MemberRow& row) -> const std::vector<double>& { return of(row).final; }));
    columns.push_back(numbers(sweep, group + "max_error", [&](const MemberRow& row) { return of(row).max_error; }));
  }
}

/// How often each hard wall was met, each event of the user, and how many steps were halved.
void add_events(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const std::vector<EventCount> counts = events_of(sweep, member);
    if (member == 0) {
      for (const EventCount& event : counts) columns.push_back({"events/" + event.name});
    }
    SweepColumn* const first = columns.data() + columns.size() - counts.size();
    for (std::size_t k = 0; k < counts.size(); ++k) first[k].counts.push_back(counts[k].count);
  }
}

/// Of the event that ended a member's run; of the others an empty text and NaN.
void add_stops(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  if (!sweep.names().stop()) return;
  static const std::vector<double> none;
  const std::size_t n = sweep.common().start_q.size();
  SweepColumn event{"stopped_by/event"};
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const std::optional<MemberStop>& stop = sweep.rows()[member].stopped_by;
    event.texts.push_back(stop ? sweep.names().of(member).events.at(stop->event) : "");
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

void add_observables(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  for (const UnitedName& observable : sweep.names().observables()) {
    SweepColumn column{"observables/" + observable.name};
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      const double* const x = value_of(sweep, observable, member, &MemberRow::observables);
      column.numbers.push_back(x == nullptr || sweep.rows()[member].q.empty() ? nothing : *x);
    }
    columns.push_back(std::move(column));
  }
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

std::vector<std::string> all_shortest(const std::vector<double>& numbers) {
  std::vector<std::string> all;
  for (const double x : numbers) all.push_back(shortest(x));
  return all;
}

/// All digits of a row. Of a member in double, where others have more, those that read back as the same double.
FrameDigits digits_of(const MemberRow& row) {
  if (!row.digits.q.empty() || row.q.empty()) return row.digits;
  return {shortest(row.t), all_shortest(row.q), all_shortest(row.p), shortest(row.energy.final),
          shortest(row.energy.initial)};
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
  if (sweep.names().stop()) {
    static const MemberStop none;
    const auto stop = [&](const char* name, std::size_t width, bool scalar, const auto& value, const auto& digits) {
      SweepColumn column{name, width, scalar};
      for (const MemberRow& row : sweep.rows()) {
        const MemberStop& seen = row.stopped_by ? *row.stopped_by : none;
        List texts = digits(seen.digits);
        if (seen.digits.q.empty() && row.stopped_by) texts = all_shortest(value(seen));  // a member in double
        texts.resize(width);
        column.texts.insert(column.texts.end(), texts.begin(), texts.end());
      }
      columns.push_back(std::move(column));
    };
    stop(
        "digits/stopped_by/t", 1, true, [](const MemberStop& s) { return std::vector<double>{s.t}; },
        [](const FrameDigits& d) { return List{d.time}; });
    stop(
        "digits/stopped_by/q", n, false, [](const MemberStop& s) { return s.q; },
        [](const FrameDigits& d) { return d.q; });
    stop(
        "digits/stopped_by/p", n, false, [](const MemberStop& s) { return s.p; },
        [](const FrameDigits& d) { return d.p; });
  }
  add("digits/final/t", 1, true, [](const FrameDigits& d) { return List{d.time}; });
  add("digits/final/q", n, false, [](const FrameDigits& d) { return d.q; });
  add("digits/final/p", n, false, [](const FrameDigits& d) { return d.p; });
  add("digits/energy/initial", 1, true, [](const FrameDigits& d) { return List{d.initial_energy}; });
  add("digits/energy/final", 1, true, [](const FrameDigits& d) { return List{d.energy}; });
}

}  // namespace

std::vector<EventCount> events_of(const Sweep& sweep, std::size_t member) {
  const MemberRow& row = sweep.rows()[member];
  std::vector<EventCount> all;
  for (const UnitedName& wall : sweep.names().walls()) {
    EventCount& count = all.emplace_back(EventCount{wall.name});
    for (const std::size_t k : sweep.names().places(wall, member)) {
      if (k < row.walls.size()) count.count += row.walls[k].bounces;
    }
  }
  for (const UnitedName& event : sweep.names().events()) {
    const std::int64_t* const count = value_of(sweep, event, member, &MemberRow::events);
    all.push_back({"user:" + event.name, count == nullptr ? 0 : *count});
  }
  if (sweep.halves_steps()) all.push_back({"halved", row.halved});
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
  columns.push_back(numbers(sweep, "energy/scale", [](const MemberRow& row) { return row.energy.scale(); }));
  add_invariants(sweep, columns);
  add_events(sweep, columns);
  add_stops(sweep, columns);
  add_observables(sweep, columns);
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
  std::vector<SweepColumn> all{std::move(member), std::move(t), std::move(q), std::move(p)};
  if (!sweep.beyond_double()) return all;
  SweepColumn t_digits{"digits/section/t"};
  SweepColumn q_digits{"digits/section/q", n, false};
  SweepColumn p_digits{"digits/section/p", n, false};
  for (const MemberRow& row : sweep.rows()) {
    const std::vector<std::string> texts = row.section_digits.empty() ? all_shortest(row.section) : row.section_digits;
    for (auto at = texts.begin(); at != texts.end(); at += static_cast<std::ptrdiff_t>(1 + 2 * n)) {
      const auto middle = at + static_cast<std::ptrdiff_t>(1 + n);
      t_digits.texts.push_back(*at);
      q_digits.texts.insert(q_digits.texts.end(), at + 1, middle);
      p_digits.texts.insert(p_digits.texts.end(), middle, middle + static_cast<std::ptrdiff_t>(n));
    }
  }
  for (SweepColumn* column : {&t_digits, &q_digits, &p_digits}) all.push_back(std::move(*column));
  return all;
}

}  // namespace hamflow
