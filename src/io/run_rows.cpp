#include "run_rows.hpp"

namespace hamflow {

namespace {

constexpr const char* all_digits = "with all digits: decimal texts that read back exactly";

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// Returns the names of an invariant's components: NAME, or NAME_1, NAME_2, ...
std::vector<std::string> component_names(const InvariantColumn& invariant) {
  if (invariant.size == 1) return {invariant.name};
  std::vector<std::string> names;
  for (std::size_t k = 1; k <= invariant.size; ++k) names.push_back(invariant.name + "_" + std::to_string(k));
  return names;
}

ColumnInfo one(const std::string& name, ValueType type, const std::string& meaning, const std::string& unit = {}) {
  return {.name = name, .type = type, .parts = {last_part(name)}, .meaning = meaning, .unit = unit};
}
ColumnInfo list(const std::string& name, const std::vector<std::string>& parts, std::size_t width,
                const std::string& meaning, const std::string& unit) {
  return {.name = name, .width = width, .scalar = false, .parts = parts, .meaning = meaning, .unit = unit};
}
ColumnInfo with_digits(ColumnInfo info, const RunDescription& run) {
  info.name = "digits/" + info.name;
  info.type = ValueType::text;
  info.meaning = all_digits;
  info.text_size = run.digits_length;
  return info;
}

/// Meanings of q, p and t in a table.
struct StateMeaning {
  const char* q;
  const char* p;
  const char* t;
};
void add_state(const RunDescription& run, const StateMeaning& meaning, Table& table) {
  table.add(list("q", run.coordinates, run.dimension, meaning.q, run.units.q));
  table.add(list("p", run.momenta, run.dimension, meaning.p, run.units.p));
}
/// t is added last: a row that has t is complete.
void add_digits_and_time(const RunDescription& run, const StateMeaning& meaning, Table& table) {
  const ColumnInfo t = one("t", ValueType::number, meaning.t, run.units.t);
  if (run.digits_length > 0) {
    table.add(with_digits(list("q", run.coordinates, run.dimension, "", run.units.q), run));
    table.add(with_digits(list("p", run.momenta, run.dimension, "", run.units.p), run));
    table.add(with_digits(t, run));
  }
  table.add(t);
}

Table samples_of(const RunDescription& run) {
  Table table;
  table.rename("samples");
  add_state(run, {"coordinates", "canonical momenta", ""}, table);
  const ColumnInfo energy =
      one("energy", ValueType::number, "H(q, p); for H(q, p, t) minus the integral of dH/dt, which makes it constant",
          run.units.energy);
  table.add(energy);
  for (const auto& [name, meaning] : energy_range_columns) {
    if (run.energy_range) table.add(one(name, ValueType::number, meaning, run.units.energy));
  }
  for (const InvariantColumn& each : run.invariants) {
    ColumnInfo info = list("invariants/" + each.name, component_names(each), each.size, each.meaning, each.unit);
    info.scalar = each.size == 1;
    table.add(info);
  }
  for (const InvariantColumn& each : run.observables) {
    table.add(one("observables/" + each.name, ValueType::number, each.meaning, each.unit));
  }
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (run.diagnostics) table.add(one(name, ValueType::number, meaning));
  }
  for (const auto& [name, meaning] : count_columns) table.add(one(name, ValueType::integer, meaning));
  const ColumnInfo t = one("t", ValueType::number, "time", run.units.t);
  if (run.digits_length > 0) {
    table.add(with_digits(list("q", run.coordinates, run.dimension, "", run.units.q), run));
    table.add(with_digits(list("p", run.momenta, run.dimension, "", run.units.p), run));
    table.add(with_digits(energy, run));
    table.add(with_digits(t, run));
  }
  table.add(t);
  return table;
}

Table section_of(const RunDescription& run) {
  constexpr StateMeaning meaning{"coordinates of the points of the section",
                                 "canonical momenta of the points of the section",
                                 "times of the points of the section"};
  Table table;
  table.rename("section");
  if (!run.section) return table;
  add_state(run, meaning, table);
  add_digits_and_time(run, meaning, table);
  return table;
}

Table bounces_of(const RunDescription& run) {
  constexpr StateMeaning meaning{"coordinates at the bounces", "canonical momenta after the bounces",
                                 "times of the bounces"};
  Table table;
  table.rename("bounces");
  if (!run.walls) return table;
  add_state(run, meaning, table);
  table.add(one("step", ValueType::integer, "number of steps taken when the step with the bounce ends"));
  table.add(one("coordinate", ValueType::integer, "column of q, from 0"));
  table.add(one("side", ValueType::integer, "-1: lower wall, 1: upper wall"));
  add_digits_and_time(run, meaning, table);
  return table;
}

Table event_of(const RunDescription& run, const std::string& event) {
  constexpr StateMeaning meaning{"coordinates at the event", "canonical momenta at the event", "times of the event"};
  Table table;
  table.rename(event);
  add_state(run, meaning, table);
  table.add(one("step", ValueType::integer, "number of steps taken when the step with the event ends"));
  add_digits_and_time(run, meaning, table);
  return table;
}

/// Fills the columns of a row in order.
class Row {
 public:
  explicit Row(Table& table) : next_(table.columns().begin()) {}
  template <class T>
  void value(const T& x) {
    (next_++)->add(x);
  }
  template <class List>
  void values(const List& list) {
    for (const auto& x : list) next_->add(x);
    ++next_;
  }
  void state(const std::vector<double>& q, const std::vector<double>& p) {
    values(q);
    values(p);
  }
  void digits(const FrameDigits& digits) {
    values(digits.q);
    values(digits.p);
    value(digits.time);
  }

 private:
  std::vector<Column>::iterator next_;
};

}  // namespace

RunRows::RunRows(const RunDescription& run, const std::optional<RowCounts>& before)
    : tables_{samples_of(run), section_of(run), bounces_of(run), {}},
      before_(before.value_or(RowCounts{})),
      complete_(!before),
      diagnostics_(run.diagnostics),
      energy_range_(run.energy_range),
      digits_(run.digits_length > 0) {
  for (const std::string& event : run.events) tables_.events.push_back(event_of(run, event));
  for (const InvariantColumn& each : run.invariants) invariant_sizes_.push_back(each.size);
  before_.events.resize(run.events.size());
}

void RunRows::append(const Frame& frame, std::span<const double> observables) {
  Row row(tables_.samples);
  row.state(frame.q, frame.p);
  row.value(frame.energy);
  if (energy_range_) {
    row.value(frame.energy_range.least);
    row.value(frame.energy_range.largest);
  }
  std::size_t at = 0;
  for (const std::size_t size : invariant_sizes_) {
    row.values(std::span(frame.invariants).subspan(at, size));
    at += size;
  }
  for (const double x : observables) row.value(x);
  if (diagnostics_) {
    const StepDiagnostics& d = frame.diagnostics;
    for (const double x :
         {d.iterations, d.residual, d.condition_tangent, d.determinant_tangent, d.condition_inverse_mass}) {
      row.value(x);
    }
  }
  const Effort& effort = frame.effort;
  const std::int64_t counts[] = {frame.step,     effort.force,         effort.gradient,
                                 effort.hessian, effort.linear_solves, effort.halved};
  for (const std::int64_t count : counts) row.value(count);
  if (digits_) {
    row.values(frame.digits.q);
    row.values(frame.digits.p);
    row.value(frame.digits.energy);
    row.value(frame.digits.time);
  }
  row.value(frame.time);
}

void RunRows::append(const SectionPoint& point) {
  Row row(tables_.section);
  row.state(point.q, point.p);
  if (digits_) row.digits(point.digits);
  row.value(point.time);
}

void RunRows::append(const Bounce& bounce) {
  Row row(tables_.bounces);
  row.state(bounce.q, bounce.p);
  row.value(bounce.step);
  row.value(static_cast<std::int64_t>(bounce.coordinate));
  row.value(static_cast<std::int64_t>(bounce.side));
  if (digits_) row.digits(bounce.digits);
  row.value(bounce.time);
}

void RunRows::append(std::size_t event, std::int64_t step, const SectionPoint& point) {
  Row row(tables_.events.at(event));
  row.state(point.q, point.p);
  row.value(step);
  if (digits_) row.digits(point.digits);
  row.value(point.time);
}

RowCounts RunRows::counts() const {
  RowCounts all = before_;
  all.samples += tables_.samples.rows();
  all.section += tables_.section.rows();
  all.bounces += tables_.bounces.rows();
  for (std::size_t k = 0; k < all.events.size(); ++k) all.events[k] += tables_.events[k].rows();
  return all;
}

void RunRows::drop() {
  before_ = counts();
  complete_ = false;
  tables_.samples.cut(0);
  tables_.section.cut(0);
  tables_.bounces.cut(0);
  for (Table& event : tables_.events) event.cut(0);
}

}  // namespace hamflow
