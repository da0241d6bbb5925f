#include "run_file.hpp"

#include <algorithm>
#include <ctime>
#include <span>

#include "h5md_groups.hpp"
#include "hdf5_text.hpp"
#include "run_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

constexpr std::size_t batch_rows = 8192;                   // one write call per batch: 35 ns a row instead of 25 us
constexpr std::size_t batch_bytes = std::size_t{1} << 23;  // of large systems fewer rows
constexpr double flush_seconds = 0.25;                     // at most so much is lost by a crash
using Clock = std::chrono::steady_clock;
constexpr NamedColumn count_columns[] = {{"step", "steps since the start"},
                                         {"solver/force", "force evaluations since the start"},
                                         {"solver/gradient", "evaluations of the gradient of H since the start"},
                                         {"solver/hessian", "evaluations of second derivatives since the start"},
                                         {"solver/linear_solves", "linear systems solved since the start"},
                                         {"events/halved", "steps replaced by two half steps since the start"}};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::tm parts{};
  gmtime_r(&now, &parts);
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

struct RunFile::Impl {
  Hdf5Handle file;
  std::vector<Column> columns;  // in the order in which append() fills them; time is the last: its length tells how
                                // many rows are complete
  std::vector<Column> section;  // q, p, t of its points: rows of their own
  std::vector<Column> walls;    // of the bounces, likewise
  std::vector<std::vector<Column>> events;  // of the user
  std::vector<std::size_t> invariant_sizes;
  bool diagnostics = false;
  bool energy_range = false;
  bool digits = false;
  std::vector<double> edges;            // of the box; none: they are not written
  std::vector<double> velocity_masses;  // one for each number of p; none: velocities are not written
  std::size_t section_waiting = 0;
  std::size_t walls_waiting = 0;
  std::vector<std::size_t> events_waiting;
  std::size_t waiting = 0;
  bool failed = false;
  std::size_t most_waiting = batch_rows;
  std::uint64_t rows = 0;
  std::uint64_t section_rows = 0;
  std::uint64_t wall_rows = 0;
  std::vector<std::uint64_t> event_rows;
  Clock::time_point flushed = Clock::now();
};

namespace {

void write_attributes(hid_t file, const RunDescription& run) {
  if (!run.identity.empty()) write_attribute(file, "run", run.identity);
  write_attribute(file, "hamflow", run.version);
  write_attribute(file, "host", run.host);
  write_attribute(file, "problem", run.problem);
  write_attribute(file, "method", run.method);
  write_attribute(file, "arithmetic", run.arithmetic);
  write_attribute(file, "kernel", run.kernel);
  write_attribute(file, "created", run.created.empty() ? now_utc() : run.created);
  write_attribute(file, "dt", run.dt);
  write_attribute(file, "dt_text", run.dt_text);
  if (!run.coordinates.empty()) write_attribute(file, "coordinates", run.coordinates);
  if (!run.momenta.empty()) write_attribute(file, "momenta", run.momenta);
  if (!run.masses.empty()) write_attribute(file, "masses", run.masses);
}

/// The names of an invariant's numbers: NAME, or NAME_1, NAME_2, ...
std::vector<std::string> component_names(const InvariantColumn& invariant) {
  if (invariant.size == 1) return {invariant.name};
  std::vector<std::string> names;
  for (std::size_t k = 1; k <= invariant.size; ++k) names.push_back(invariant.name + "_" + std::to_string(k));
  return names;
}

std::vector<Column> sample_columns(hid_t file, const RunDescription& run) {
  const std::size_t rows = run.samples > 0 ? run.samples : batch_rows;
  const ColumnUnits& unit = run.units;
  const std::size_t n = run.dimension;
  const auto last_name = [](const std::string& name) { return name.substr(name.find('/') + 1); };
  std::vector<Column> all;
  const auto number = [&](const char* name, hid_t type, const char* meaning, const std::string& its_unit = {}) {
    all.emplace_back(file, name, type, 0, rows, ColumnText{{last_name(name)}, meaning, its_unit});
  };
  if (const std::size_t space = run.particles.space; space > 0) {
    const auto of_particles = [&](const char* name, const char* meaning, const std::string& its_unit) {
      all.emplace_back(file, name, H5T_IEEE_F64LE, n, rows, ColumnText{{}, meaning, its_unit}, space);
    };
    of_particles(H5mdNames::position, "coordinates, not folded into a periodic box", unit.q);
    of_particles(H5mdNames::momentum, "canonical momenta", unit.p);
    if (!run.particles.unit_masses()) of_particles(H5mdNames::velocity, "momenta over masses", {});
    if (!run.particles.edges.empty()) {
      all.emplace_back(file, H5mdNames::edges, H5T_IEEE_F64LE, space, rows,
                       ColumnText{{}, H5mdNames::edges_meaning, unit.q});
    }
  } else {
    all.emplace_back(file, "q", H5T_IEEE_F64LE, n, rows, ColumnText{run.coordinates, "coordinates", unit.q});
    all.emplace_back(file, "p", H5T_IEEE_F64LE, n, rows, ColumnText{run.momenta, "canonical momenta", unit.p});
  }
  number("energy", H5T_IEEE_F64LE, "H(q, p); of H(q, p, t) less the integral of dH/dt, which is constant", unit.energy);
  for (const auto& [name, meaning] : energy_range_columns) {
    if (run.energy_range) number(name, H5T_IEEE_F64LE, meaning, unit.energy);
  }
  for (const InvariantColumn& each : run.invariants) {
    all.emplace_back(file, "invariants/" + each.name, H5T_IEEE_F64LE, each.size == 1 ? 0 : each.size, rows,
                     ColumnText{component_names(each), each.meaning, each.unit});
  }
  for (const InvariantColumn& each : run.observables) {
    all.emplace_back(file, "observables/" + each.name + (run.particles.space > 0 ? "/value" : ""), H5T_IEEE_F64LE, 0,
                     rows, ColumnText{{each.name}, each.meaning, each.unit});
  }
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (run.diagnostics) number(name, H5T_IEEE_F64LE, meaning);
  }
  for (const auto& [name, meaning] : count_columns) number(name, H5T_STD_I64LE, meaning);
  if (run.digits_length > 0) {
    const Hdf5Handle type = digits_type(run.digits_length);
    const char* const meaning = "with all digits: decimal texts that read back to the last bit";
    all.emplace_back(file, "digits/q", type, n, rows, ColumnText{run.coordinates, meaning, unit.q});
    all.emplace_back(file, "digits/p", type, n, rows, ColumnText{run.momenta, meaning, unit.p});
    number("digits/energy", type, meaning, unit.energy);
    number("digits/t", type, meaning, unit.t);
  }
  number("t", H5T_IEEE_F64LE, "time", unit.t);
  return all;
}

/// Of a located state: q, p, t with all digits.
void add_digits(hid_t file, const RunDescription& run, const std::string& group, std::vector<Column>& all) {
  const Hdf5Handle type = digits_type(run.digits_length);
  const char* const meaning = "with all digits: decimal texts that read back to the last bit";
  all.emplace_back(file, group + "q", type, run.dimension, batch_rows,
                   ColumnText{run.coordinates, meaning, run.units.q});
  all.emplace_back(file, group + "p", type, run.dimension, batch_rows, ColumnText{run.momenta, meaning, run.units.p});
  all.emplace_back(file, group + "t", type, 0, batch_rows, ColumnText{{"t"}, meaning, run.units.t});
}
/// In that order.
std::vector<Column>::iterator put_digits(const FrameDigits& digits, std::vector<Column>::iterator column) {
  for (const std::string& x : digits.q) column->add(x);
  ++column;
  for (const std::string& x : digits.p) column->add(x);
  ++column;
  column->add(digits.time);
  return ++column;
}

std::vector<Column> section_columns(hid_t file, const RunDescription& run) {
  const std::size_t n = run.dimension;
  std::vector<Column> all;
  const auto add = [&](const char* name, std::size_t width, const ColumnText& text) {
    all.emplace_back(file, name, H5T_IEEE_F64LE, width, batch_rows, text);
  };
  add("section/q", n, {run.coordinates, "coordinates of the points of the section", run.units.q});
  add("section/p", n, {run.momenta, "canonical momenta of the points of the section", run.units.p});
  if (run.digits_length > 0) add_digits(file, run, "digits/section/", all);
  add("section/t", 0, {{"t"}, "times of the points of the section", run.units.t});
  return all;
}

std::vector<Column> event_columns(hid_t file, const RunDescription& run, const std::string& event) {
  const std::size_t n = run.dimension;
  const std::string group = "events/user/" + event + "/";
  std::vector<Column> all;
  const auto add = [&](const char* name, hid_t type, std::size_t width, const ColumnText& text) {
    all.emplace_back(file, group + name, type, width, batch_rows, text);
  };
  add("q", H5T_IEEE_F64LE, n, {run.coordinates, "coordinates at the event", run.units.q});
  add("p", H5T_IEEE_F64LE, n, {run.momenta, "canonical momenta at the event", run.units.p});
  add("step", H5T_STD_I64LE, 0, {{"step"}, "at the end of which the event is behind", {}});
  if (run.digits_length > 0) add_digits(file, run, "digits/" + group, all);
  add("t", H5T_IEEE_F64LE, 0, {{"t"}, "times of the event", run.units.t});
  return all;
}

std::vector<Column> wall_columns(hid_t file, const RunDescription& run) {
  const std::size_t n = run.dimension;
  std::vector<Column> all;
  const auto add = [&](const char* name, hid_t type, std::size_t width, const ColumnText& text) {
    all.emplace_back(file, name, type, width, batch_rows, text);
  };
  add("events/wall/q", H5T_IEEE_F64LE, n, {run.coordinates, "coordinates at the bounces", run.units.q});
  add("events/wall/p", H5T_IEEE_F64LE, n, {run.momenta, "canonical momenta behind the bounces", run.units.p});
  add("events/wall/step", H5T_STD_I64LE, 0, {{"step"}, "at the end of which the bounce is behind", {}});
  add("events/wall/coordinate", H5T_STD_I64LE, 0, {{"coordinate"}, "column of q, from 0", {}});
  add("events/wall/side", H5T_STD_I64LE, 0, {{"side"}, "-1 the wall below, 1 that above", {}});
  add("events/wall/t", H5T_IEEE_F64LE, 0, {{"t"}, "times of the bounces", run.units.t});
  return all;
}

}  // namespace

std::unique_ptr<RunFile::Impl> RunFile::create(const std::filesystem::path& file, const RunDescription& description) {
  silence_hdf5();
  auto impl = std::make_unique<Impl>();
  impl->file = create_hdf5(file);
  const hid_t id = impl->file;
  write_attributes(id, description);
  write_text_dataset(id, "scenario", description.scenario);
  for (const char* group : {"invariants", "solver", "events"}) (void)make_group(id, group);
  impl->digits = description.digits_length > 0;
  impl->diagnostics = description.diagnostics;
  impl->energy_range = description.energy_range;
  for (const InvariantColumn& each : description.invariants) impl->invariant_sizes.push_back(each.size);
  const H5mdParticles& particles = description.particles;
  if (!description.observables.empty() || particles.space > 0) (void)make_group(id, "observables");
  if (particles.space > 0) write_h5md_groups(id, description);
  impl->edges = particles.edges;
  for (std::size_t i = 0; particles.space > 0 && !particles.unit_masses() && i < description.dimension; ++i)
    impl->velocity_masses.push_back(particles.masses[i / particles.space]);
  if (impl->digits) (void)make_group(id, "digits");
  if (description.section) {
    (void)make_group(id, "section");
    if (impl->digits) (void)make_group(id, "digits/section");
    impl->section = section_columns(id, description);
  }
  if (description.walls) {
    (void)make_group(id, "events/wall");
    impl->walls = wall_columns(id, description);
  }
  if (!description.events.empty()) {
    (void)make_group(id, "events/user");
    if (impl->digits) {
      (void)make_group(id, "digits/events");
      (void)make_group(id, "digits/events/user");
    }
  }
  for (const std::string& event : description.events) {
    (void)make_group(id, ("events/user/" + event).c_str());
    if (impl->digits) (void)make_group(id, ("digits/events/user/" + event).c_str());
    impl->events.push_back(event_columns(id, description, event));
  }
  impl->events_waiting.resize(impl->events.size());
  impl->event_rows.resize(impl->events.size());
  impl->columns = sample_columns(id, description);
  if (particles.space > 0) link_h5md_elements(id, description);
  std::size_t bytes = 0;
  for (const Column& column : impl->columns) bytes += column.bytes_a_row();
  impl->most_waiting = std::clamp<std::size_t>(batch_bytes / bytes, 1, batch_rows);
  // Every object has to exist before this; from here on readers may look in, and a crash leaves a readable file.
  check_hdf5(H5Fstart_swmr_write(id), "start single-writer mode in " + file.string());
  return impl;
}

RunFile::RunFile(const std::filesystem::path& file, const RunDescription& description) {
  try {
    impl_ = create(next_name(file), description);
    std::filesystem::rename(next_name(file), file);  // whoever sees it can read it; the open file keeps its identity
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(next_name(file), ignored);
    throw;
  }
}

RunFile::RunFile(const std::filesystem::path& file, const RunDescription& description, std::uint64_t rows,
                 std::uint64_t section_rows, std::uint64_t wall_rows, std::span<const std::uint64_t> event_rows) {
  silence_hdf5();
  const std::filesystem::path fresh = next_name(file);
  try {
    const Hdf5Handle old = open_to_read(file);
    RunDescription same = description;
    same.created = text_attribute(old, "created");
    auto copy = create(fresh, same);
    for (Column& column : copy->columns) column.copy_from(old, rows, copy->most_waiting);
    for (Column& column : copy->section) column.copy_from(old, section_rows, copy->most_waiting);
    copy->rows = rows;
    for (Column& column : copy->walls) column.copy_from(old, wall_rows, copy->most_waiting);
    copy->section_rows = section_rows;
    copy->wall_rows = wall_rows;
    for (std::size_t k = 0; k < copy->events.size() && k < event_rows.size(); ++k) {
      for (Column& column : copy->events[k]) column.copy_from(old, event_rows[k], copy->most_waiting);
      copy->event_rows[k] = event_rows[k];
    }
    force_to_disk(fresh);
    std::filesystem::rename(fresh, file);  // the open file keeps its identity
    impl_ = std::move(copy);
  } catch (const FileError& error) {
    std::error_code ignored;
    std::filesystem::remove(fresh, ignored);
    throw FileError("cannot go on with " + file.string() + ": " + error.what());
  }
}

std::uint64_t RunFile::rows() const { return impl_->rows; }
std::uint64_t RunFile::section_rows() const { return impl_->section_rows; }
std::uint64_t RunFile::wall_rows() const { return impl_->wall_rows; }
const std::vector<std::uint64_t>& RunFile::event_rows() const { return impl_->event_rows; }

RunFile::~RunFile() {
  if (!impl_) return;
  try {
    flush();
  } catch (const FileError&) {  // NOLINT: a destructor cannot report; flush() was called before where it matters
  }
  // After a failed write HDF5 holds metadata of what is not in the file. Closed, it would write them: the file is left
  // as a kill would leave it, which readers can open.
  if (impl_->failed) (void)impl_.release();
}

void RunFile::append(const Frame& frame, std::span<const double> observables) {
  auto column = impl_->columns.begin();
  const auto number = [&](const auto& x) { (column++)->add(x); };
  const auto numbers = [&](const auto& row) {
    for (const auto& x : row) column->add(x);
    ++column;
  };
  numbers(frame.q);
  numbers(frame.p);
  if (!impl_->velocity_masses.empty()) {
    for (std::size_t i = 0; i < frame.p.size(); ++i) column->add(frame.p[i] / impl_->velocity_masses[i]);
    ++column;
  }
  if (!impl_->edges.empty()) numbers(impl_->edges);
  number(frame.energy);
  if (impl_->energy_range) {
    number(frame.energy_range.least);
    number(frame.energy_range.largest);
  }
  std::size_t at = 0;
  for (const std::size_t size : impl_->invariant_sizes) {
    numbers(std::span(frame.invariants).subspan(at, size));
    at += size;
  }
  for (const double x : observables) number(x);
  if (impl_->diagnostics) {
    const StepDiagnostics& d = frame.diagnostics;
    for (const double x :
         {d.iterations, d.residual, d.condition_tangent, d.determinant_tangent, d.condition_inverse_mass}) {
      number(x);
    }
  }
  const Effort& effort = frame.effort;
  const std::int64_t counts[] = {frame.step,     effort.force,         effort.gradient,
                                 effort.hessian, effort.linear_solves, effort.halved};
  for (const std::int64_t count : counts) number(count);
  if (impl_->digits) {
    numbers(frame.digits.q);
    numbers(frame.digits.p);
    number(frame.digits.energy);
    number(frame.digits.time);
  }
  number(frame.time);
  ++impl_->rows;
  if (++impl_->waiting == impl_->most_waiting) flush();
}

void RunFile::append(const SectionPoint& point) {
  for (const double x : point.q) impl_->section.at(0).add(x);
  for (const double x : point.p) impl_->section[1].add(x);
  auto next = impl_->section.begin() + 2;
  if (impl_->digits) next = put_digits(point.digits, next);
  next->add(point.time);
  ++impl_->section_rows;
  if (++impl_->section_waiting == impl_->most_waiting) flush();
}

void RunFile::append(const Bounce& bounce) {
  for (const double x : bounce.q) impl_->walls.at(0).add(x);
  for (const double x : bounce.p) impl_->walls[1].add(x);
  impl_->walls[2].add(bounce.step);
  impl_->walls[3].add(static_cast<std::int64_t>(bounce.coordinate));
  impl_->walls[4].add(static_cast<std::int64_t>(bounce.side));
  impl_->walls[5].add(bounce.time);
  ++impl_->wall_rows;
  if (++impl_->walls_waiting == impl_->most_waiting) flush();
}

void RunFile::append(std::size_t event, std::int64_t step, const SectionPoint& point) {
  std::vector<Column>& columns = impl_->events.at(event);
  for (const double x : point.q) columns.at(0).add(x);
  for (const double x : point.p) columns[1].add(x);
  columns[2].add(step);
  auto next = columns.begin() + 3;
  if (impl_->digits) next = put_digits(point.digits, next);
  next->add(point.time);
  ++impl_->event_rows[event];
  if (++impl_->events_waiting[event] == impl_->most_waiting) flush();
}

void RunFile::flush() {
  if (impl_->failed) throw FileError("HDF5: a write has failed before");
  const std::size_t points = std::exchange(impl_->section_waiting, 0);
  const std::size_t rows = std::exchange(impl_->waiting, 0);
  const std::size_t bounces = std::exchange(impl_->walls_waiting, 0);
  impl_->failed = true;  // until all is written
  for (Column& column : impl_->walls) {
    if (bounces > 0) column.write(bounces);
  }
  for (Column& column : impl_->section) {
    if (points > 0) column.write(points);
  }
  for (Column& column : impl_->columns) {
    if (rows > 0) column.write(rows);
  }
  bool any_event = false;
  for (std::size_t k = 0; k < impl_->events.size(); ++k) {
    const std::size_t found = std::exchange(impl_->events_waiting[k], 0);
    any_event = any_event || found > 0;
    for (Column& column : impl_->events[k]) {
      if (found > 0) column.write(found);
    }
  }
  impl_->failed = false;
  if (rows == 0 && bounces == 0 && !any_event) return;
  impl_->flushed = Clock::now();
}

void RunFile::flush_if_due() {
  if (std::chrono::duration<double>(Clock::now() - impl_->flushed).count() > flush_seconds) flush();
}

}  // namespace hamflow
