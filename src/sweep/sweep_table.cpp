#include "sweep_table.hpp"

#include <algorithm>
#include <limits>

#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

Column empty_column(std::string name, ValueType type, std::size_t width = 1, bool scalar = true) {
  return Column({.name = std::move(name), .type = type, .width = width, .scalar = scalar});
}

/// Calls action(row) for every member.
template <class F>
void for_rows(const Sweep& sweep, const F& action) {
  for (std::size_t member = 0; member < sweep.members(); ++member) action(sweep.row(member));
}

/// Makes a column with `width` numbers in each row. value(row) is a vector that may be empty.
template <class F>
Column vectors(const Sweep& sweep, std::string name, std::size_t width, bool scalar, const F& value) {
  Column column = empty_column(std::move(name), ValueType::number, width, scalar);
  column.reserve(sweep.members());
  for_rows(sweep, [&](const MemberRow& row) {
    const std::vector<double>& x = value(row);
    for (std::size_t i = 0; i < width; ++i) column.add(i < x.size() ? x[i] : nothing);
  });
  return column;
}

template <class F>
Column numbers(const Sweep& sweep, std::string name, const F& value) {
  Column column = empty_column(std::move(name), ValueType::number);
  column.reserve(sweep.members());
  for_rows(sweep, [&](const MemberRow& row) { column.add(row.q.empty() ? nothing : value(row)); });
  return column;
}

void add_varied(const Sweep& sweep, Table& table) {
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    const bool is_number = varied.keys()[key].is_number();
    Column column = empty_column("varied/" + varied.keys()[key].path, is_number ? ValueType::number : ValueType::text);
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      if (is_number) {
        column.add(varied.number(member, key));
      } else {
        column.add(without_quotes(varied.text(member, key)));
      }
    }
    table.add(std::move(column));
  }
}

void add_invariants(const Sweep& sweep, Table& table) {
  static const InvariantExcursion none{{}, {}, nothing};
  for (const MergedName& invariant : sweep.names().invariants()) {
    const std::string group = "invariants/" + invariant.name + "/";
    const std::size_t size = sweep.names().size(invariant);
    Column initial = empty_column(group + "initial", ValueType::number, size, size == 1);
    Column final = empty_column(group + "final", ValueType::number, size, size == 1);
    Column max_error = empty_column(group + "max_error", ValueType::number);
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      const InvariantExcursion* const own = value_of(sweep, invariant, member, &MemberRow::invariants);
      const InvariantExcursion& x = own == nullptr ? none : *own;
      for (std::size_t i = 0; i < size; ++i) {
        initial.add(i < x.initial.size() ? x.initial[i] : nothing);
        final.add(i < x.final.size() ? x.final[i] : nothing);
      }
      max_error.add(sweep.row(member).q.empty() ? nothing : x.max_error);
    }
    for (Column* column : {&initial, &final, &max_error}) table.add(std::move(*column));
  }
}

/// Adds how often each hard wall was met, how often each event of the user occurred, and how many steps were halved.
void add_events(const Sweep& sweep, Table& table) {
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const std::vector<EventCount> counts = events_of(sweep, member);
    if (member == 0) {
      for (const EventCount& event : counts) table.add(empty_column("events/" + event.name, ValueType::integer));
    }
    Column* const first = table.columns().data() + table.columns().size() - counts.size();
    for (std::size_t k = 0; k < counts.size(); ++k) first[k].add(counts[k].count);
  }
}

/// Adds the event that ended a member's run; an empty text and NaN for other members.
void add_stops(const Sweep& sweep, Table& table) {
  if (!sweep.names().stop()) return;
  static const std::vector<double> none;
  const std::size_t n = sweep.common().start_q.size();
  Column event = empty_column("stopped_by/event", ValueType::text);
  for (std::size_t member = 0; member < sweep.members(); ++member) {
    const std::optional<MemberStop>& stop = sweep.row(member).stopped_by;
    event.add(std::string_view(stop ? sweep.names().of(member).events.at(stop->event) : ""));
  }
  table.add(std::move(event));
  table.add(numbers(sweep, "stopped_by/t",
                    [](const MemberRow& row) { return row.stopped_by ? row.stopped_by->t : nothing; }));
  table.add(vectors(sweep, "stopped_by/q", n, false, [](const MemberRow& row) -> const std::vector<double>& {
    return row.stopped_by ? row.stopped_by->q : none;
  }));
  table.add(vectors(sweep, "stopped_by/p", n, false, [](const MemberRow& row) -> const std::vector<double>& {
    return row.stopped_by ? row.stopped_by->p : none;
  }));
}

void add_observables(const Sweep& sweep, Table& table) {
  for (const MergedName& observable : sweep.names().observables()) {
    Column column = empty_column("observables/" + observable.name, ValueType::number);
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      const double* const x = value_of(sweep, observable, member, &MemberRow::observables);
      column.add(x == nullptr || sweep.row(member).q.empty() ? nothing : *x);
    }
    table.add(std::move(column));
  }
}

/// Adds the varied values as text, because a member is run again from its text and a third is not a double.
void add_given(const Sweep& sweep, Table& table) {
  const Varied& varied = sweep.varied();
  for (std::size_t key = 0; key < varied.size(); ++key) {
    if (!varied.keys()[key].is_number()) continue;
    Column column = empty_column("digits/varied/" + varied.keys()[key].path, ValueType::text);
    for (std::size_t member = 0; member < sweep.members(); ++member) {
      column.add(without_quotes(varied.text(member, key)));
    }
    table.add(std::move(column));
  }
}

std::vector<std::string> all_shortest(const std::vector<double>& numbers) {
  std::vector<std::string> all;
  for (const double x : numbers) all.push_back(shortest(x));
  return all;
}

/// Returns all digits of a row. If the member is in double but others have more digits, the digits are those that read
/// back as the same double.
FrameDigits digits_of(const MemberRow& row) {
  if (!row.digits.q.empty() || row.q.empty()) return row.digits;
  return {shortest(row.t), all_shortest(row.q), all_shortest(row.p), shortest(row.energy.final),
          shortest(row.energy.initial)};
}

void add_digits(const Sweep& sweep, std::size_t n, Table& table) {
  const auto add = [&](const char* name, std::size_t width, bool scalar, const auto& value) {
    Column column = empty_column(name, ValueType::text, width, scalar);
    for_rows(sweep, [&](const MemberRow& row) {
      const std::vector<std::string> texts = value(digits_of(row));
      for (std::size_t i = 0; i < width; ++i) column.add(std::string_view(i < texts.size() ? texts[i] : ""));
    });
    table.add(std::move(column));
  };
  using List = std::vector<std::string>;
  if (sweep.names().stop()) {
    static const MemberStop none;
    const auto stop = [&](const char* name, std::size_t width, bool scalar, const auto& value, const auto& digits) {
      Column column = empty_column(name, ValueType::text, width, scalar);
      for_rows(sweep, [&](const MemberRow& row) {
        const MemberStop& seen = row.stopped_by ? *row.stopped_by : none;
        List texts = digits(seen.digits);
        if (seen.digits.q.empty() && row.stopped_by) texts = all_shortest(value(seen));  // the member is in double
        texts.resize(width);
        for (const std::string& text : texts) column.add(text);
      });
      table.add(std::move(column));
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
  const MemberRow& row = sweep.row(member);
  std::vector<EventCount> all;
  for (const MergedName& wall : sweep.names().walls()) {
    EventCount& count = all.emplace_back(EventCount{wall.name});
    for (const std::size_t k : sweep.names().places(wall, member)) {
      if (k < row.walls.size()) count.count += row.walls[k].bounces;
    }
  }
  for (const MergedName& event : sweep.names().events()) {
    const std::int64_t* const count = value_of(sweep, event, member, &MemberRow::events);
    all.push_back({"user:" + event.name, count == nullptr ? 0 : *count});
  }
  if (sweep.halves_steps()) all.push_back({"halved", row.halved});
  return all;
}

Table members_of(const Sweep& sweep) {
  Table table;
  add_varied(sweep, table);
  Column status = empty_column("member/status", ValueType::text);
  Column steps = empty_column("member/steps", ValueType::integer);
  for_rows(sweep, [&](const MemberRow& row) {
    status.add(std::string_view(row.status_name()));
    steps.add(row.steps);
  });
  table.add(std::move(status));
  table.add(std::move(steps));
  const std::size_t n = sweep.common().start_q.size();
  table.add(numbers(sweep, "final/t", [](const MemberRow& row) { return row.t; }));
  table.add(
      vectors(sweep, "final/q", n, false, [](const MemberRow& row) -> const std::vector<double>& { return row.q; }));
  table.add(
      vectors(sweep, "final/p", n, false, [](const MemberRow& row) -> const std::vector<double>& { return row.p; }));
  table.add(numbers(sweep, "energy/initial", [](const MemberRow& row) { return row.energy.initial; }));
  table.add(numbers(sweep, "energy/final", [](const MemberRow& row) { return row.energy.final; }));
  table.add(numbers(sweep, "energy/max_error", [](const MemberRow& row) { return row.energy.max_error; }));
  table.add(numbers(sweep, "energy/scale", [](const MemberRow& row) { return row.energy.scale(); }));
  add_invariants(sweep, table);
  add_events(sweep, table);
  add_stops(sweep, table);
  add_observables(sweep, table);
  if (!sweep.beyond_double()) return table;
  add_digits(sweep, n, table);
  add_given(sweep, table);
  return table;
}

Table sections_of(const Sweep& sweep) {
  if (!sweep.common().section) return {};
  const std::size_t n = sweep.common().start_q.size();
  Column member = empty_column("section/member", ValueType::integer);
  Column t = empty_column("section/t", ValueType::number);
  Column q = empty_column("section/q", ValueType::number, n, false);
  Column p = empty_column("section/p", ValueType::number, n, false);
  /// A point consists of its time, then q, then p.
  const auto add_points = [n](const auto& points, Column& its_t, Column& its_q, Column& its_p) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::size_t place = k % (1 + 2 * n);
      (place == 0 ? its_t : place <= n ? its_q : its_p).add(points[k]);
    }
  };
  for (std::size_t i = 0; i < sweep.members(); ++i) {
    const MemberRow& row = sweep.row(i);
    add_points(row.section, t, q, p);
    for (std::size_t k = 0; k < row.section_points(); ++k) member.add(static_cast<std::int64_t>(i));
  }
  Table table;
  for (Column* column : {&member, &t, &q, &p}) table.add(std::move(*column));
  if (!sweep.beyond_double()) return table;
  Column t_digits = empty_column("digits/section/t", ValueType::text);
  Column q_digits = empty_column("digits/section/q", ValueType::text, n, false);
  Column p_digits = empty_column("digits/section/p", ValueType::text, n, false);
  for_rows(sweep, [&](const MemberRow& row) {
    add_points(row.section_digits.empty() ? all_shortest(row.section) : row.section_digits, t_digits, q_digits,
               p_digits);
  });
  for (Column* column : {&t_digits, &q_digits, &p_digits}) table.add(std::move(*column));
  return table;
}

}  // namespace hamflow
