#include "run_file.hpp"

#include <algorithm>
#include <ctime>
#include <span>

#include "hdf5_text.hpp"
#include "run_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

constexpr std::size_t batch_rows = 8192;                   // one write call per batch: 35 ns a row instead of 25 us
constexpr std::size_t batch_bytes = std::size_t{1} << 23;  // of large systems fewer rows
constexpr double flush_seconds = 0.25;                     // at most so much is lost by a crash
using Clock = std::chrono::steady_clock;
struct NamedColumn {
  const char* name;
  const char* meaning;
};
constexpr NamedColumn diagnostic_columns[] = {
    {"solver/iterations", "of the last step; NaN at the start"},
    {"solver/residual", "of the last step"},
    {"solver/condition_tangent", "of the tangent matrix of the last step"},
    {"solver/determinant_tangent", "of the tangent matrix of the last step"},
    {"solver/condition_inverse_mass", "of the inverse mass matrix at the last step"}};
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
  std::vector<std::size_t> invariant_sizes;
  bool diagnostics = false;
  bool digits = false;
  std::size_t section_waiting = 0;
  std::size_t walls_waiting = 0;
  std::size_t waiting = 0;
  bool failed = false;
  std::size_t most_waiting = batch_rows;
  std::uint64_t rows = 0;
  std::uint64_t section_rows = 0;
  std::uint64_t wall_rows = 0;
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
  all.emplace_back(file, "q", H5T_IEEE_F64LE, n, rows, ColumnText{run.coordinates, "coordinates", unit.q});
  all.emplace_back(file, "p", H5T_IEEE_F64LE, n, rows, ColumnText{run.momenta, "canonical momenta", unit.p});
  number("energy", H5T_IEEE_F64LE, "H(q, p); of H(q, p, t) less the integral of dH/dt, which is constant", unit.energy);
  for (const InvariantColumn& each : run.invariants) {
    all.emplace_back(file, "invariants/" + each.name, H5T_IEEE_F64LE, each.size == 1 ? 0 : each.size, rows,
                     ColumnText{component_names(each), each.meaning, each.unit});
  }
  for (const InvariantColumn& each : run.observables) {
    all.emplace_back(file, "observables/" + each.name, H5T_IEEE_F64LE, 0, rows,
                     ColumnText{{each.name}, each.meaning, each.unit});
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

std::vector<Column> section_columns(hid_t file, const RunDescription& run) {
  const std::size_t n = run.dimension;
  std::vector<Column> all;
  const auto add = [&](const char* name, std::size_t width, const ColumnText& text) {
    all.emplace_back(file, name, H5T_IEEE_F64LE, width, batch_rows, text);
  };
  add("section/q", n, {run.coordinates, "coordinates of the points of the section", run.units.q});
  add("section/p", n, {run.momenta, "canonical momenta of the points of the section", run.units.p});
  add("section/t", 0, {{"t"}, "times of the points of the section", run.units.t});
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
  for (const InvariantColumn& each : description.invariants) impl->invariant_sizes.push_back(each.size);
  if (!description.observables.empty()) (void)make_group(id, "observables");
  if (impl->digits) (void)make_group(id, "digits");
  if (description.section) {
    (void)make_group(id, "section");
    impl->section = section_columns(id, description);
  }
  if (description.walls) {
    (void)make_group(id, "events/wall");
    impl->walls = wall_columns(id, description);
  }
  impl->columns = sample_columns(id, description);
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
                 std::uint64_t section_rows, std::uint64_t wall_rows) {
  silence_hdf5();
  const std::filesystem::path fresh = next_name(file);
  try {
    const Hdf5Handle old = open_to_read(file);
    RunDescription same = description;
    same.created = read_attribute(old, "created");
    auto copy = create(fresh, same);
    for (Column& column : copy->columns) column.copy_from(old, rows, copy->most_waiting);
    for (Column& column : copy->section) column.copy_from(old, section_rows, copy->most_waiting);
    copy->rows = rows;
    for (Column& column : copy->walls) column.copy_from(old, wall_rows, copy->most_waiting);
    copy->section_rows = section_rows;
    copy->wall_rows = wall_rows;
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
  number(frame.energy);
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
  impl_->section[2].add(point.time);
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
  impl_->failed = false;
  if (rows == 0 && bounces == 0) return;
  impl_->flushed = Clock::now();
}

void RunFile::flush_if_due() {
  if (std::chrono::duration<double>(Clock::now() - impl_->flushed).count() > flush_seconds) flush();
}

namespace {
/// A dataset of rows of `width` numbers, open to be read.
struct OpenColumn {
  OpenColumn(hid_t file, const char* its_name)
      : name(its_name), dataset(H5Dopen2(file, its_name, H5P_DEFAULT), H5Dclose, "open dataset " + name) {
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open the space of " + name);
    if (H5Sget_simple_extent_ndims(space) > 2) throw FileError("HDF5: dataset " + name + " has too many dimensions");
    check_hdf5(H5Sget_simple_extent_dims(space, size, nullptr), "read the size of " + name);
  }
  std::size_t rows() const { return size[0]; }
  std::size_t width() const { return size[1]; }
  /// A chunk that its writer is writing at this moment has another checksum: a moment later it is whole.
  void read(hid_t type, void* values) const {
    for (int attempt = 1; attempt < 3; ++attempt) {
      if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) return;
    }
    check_hdf5(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "read " + name);
  }

  std::string name;
  Hdf5Handle dataset;
  hsize_t size[2] = {0, 1};
};

/// Row by row.
std::vector<double> read_column(hid_t file, const char* name, std::size_t& width) {
  const OpenColumn column(file, name);
  width = column.width();
  std::vector<double> values(column.rows() * width);
  if (!values.empty()) column.read(H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::vector<std::string> read_texts(hid_t file, const char* name, std::size_t& width) {
  const OpenColumn column(file, name);
  width = column.width();
  const Hdf5Handle type(H5Dget_type(column.dataset), H5Tclose, "read the type of " + column.name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) {
    throw FileError("HDF5: dataset " + column.name + " holds no texts of one length");
  }
  const std::size_t length = H5Tget_size(type);
  std::string all(column.rows() * width * length, '\0');
  if (!all.empty()) column.read(type, all.data());
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += length) {
    const std::string_view text = std::string_view(all).substr(at, length);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

template <class T>
std::vector<std::vector<T>> by_coordinate(const std::vector<T>& rows, std::size_t width, std::size_t count) {
  std::vector<std::vector<T>> out(width, std::vector<T>(count));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < width; ++i) out[i][k] = rows[k * width + i];
  }
  return out;
}
}  // namespace

namespace {
/// The names in a group; none where it is not there.
std::vector<std::string> names_in(hid_t file, const char* group_name) {
  if (H5Lexists(file, group_name, H5P_DEFAULT) <= 0) return {};
  const Hdf5Handle group(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose, "open group " + std::string(group_name));
  H5G_info_t info{};
  check_hdf5(H5Gget_info(group, &info), "count the objects of " + std::string(group_name));
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    char name[256] = "";
    const bool read =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT) >= 0;
    check_hdf5(read ? 0 : -1, "read a name in " + std::string(group_name));
    names.emplace_back(name);
  }
  return names;
}

RunSamples read_samples(const std::filesystem::path& path) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  RunSamples run;
  run.description.scenario = read_text_dataset(file, "scenario");
  run.description.version = read_attribute(file, "hamflow");
  run.description.host = read_attribute(file, "host");
  run.description.problem = read_attribute(file, "problem");
  run.description.method = read_attribute(file, "method");
  run.description.arithmetic = read_attribute(file, "arithmetic");
  std::size_t width = 0;
  run.t = read_column(file, "t", width);
  run.energy = read_column(file, "energy", width);
  std::size_t q_width = 0;
  std::size_t p_width = 0;
  const std::vector<double> q = read_column(file, "q", q_width);
  const std::vector<double> p = read_column(file, "p", p_width);
  std::size_t one = 0;
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (H5Lexists(file, name, H5P_DEFAULT) <= 0) continue;
    run.diagnostics.emplace_back(name + std::string("solver/").size(), read_column(file, name, one));
  }
  for (const std::string& name : names_in(file, "observables")) {
    run.observables.emplace_back(name, read_column(file, ("observables/" + name).c_str(), one));
  }
  // After a crash between two flushes the columns may differ in length: what all of them have is complete.
  std::size_t count = std::min({run.t.size(), run.energy.size(), q.size() / q_width, p.size() / p_width});
  for (const auto& column : run.diagnostics) count = std::min(count, column.second.size());
  for (const auto& column : run.observables) count = std::min(count, column.second.size());
  for (auto* columns : {&run.diagnostics, &run.observables}) {
    for (auto& column : *columns) column.second.resize(count);
  }
  run.t.resize(count);
  run.energy.resize(count);
  run.q = by_coordinate(q, q_width, count);
  run.p = by_coordinate(p, p_width, count);
  run.description.dimension = q_width;
  if (H5Lexists(file, "section", H5P_DEFAULT) > 0) {
    run.section_t = read_column(file, "section/t", one);
    const std::vector<double> section_q = read_column(file, "section/q", one);
    const std::vector<double> section_p = read_column(file, "section/p", one);
    const std::size_t points = std::min({run.section_t.size(), section_q.size() / q_width, section_p.size() / p_width});
    run.section_t.resize(points);
    run.section_q = by_coordinate(section_q, q_width, points);
    run.section_p = by_coordinate(section_p, p_width, points);
    run.description.section = true;
  }
  return run;
}

RunDigits read_digits(const std::filesystem::path& path) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  RunDigits run;
  if (H5Lexists(file, "digits", H5P_DEFAULT) <= 0) return run;
  std::size_t one = 0;
  std::size_t width = 0;
  run.t = read_texts(file, "digits/t", one);
  run.energy = read_texts(file, "digits/energy", one);
  const std::vector<std::string> q = read_texts(file, "digits/q", width);
  const std::vector<std::string> p = read_texts(file, "digits/p", width);
  const std::size_t count = std::min({run.t.size(), run.energy.size(), q.size() / width, p.size() / width});
  run.t.resize(count);
  run.energy.resize(count);
  run.q = by_coordinate(q, width, count);
  run.p = by_coordinate(p, width, count);
  return run;
}

/// What goes wrong while a file is read names the file.
template <class Read>
auto naming(const std::filesystem::path& path, const Read& read) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) {
    const bool of_sweep = std::filesystem::exists(path.parent_path() / "sweep.h5", unknown) && path.has_parent_path();
    throw FileError(path.string() + " cannot be read: there is no such file" +
                    (of_sweep ? "; this is the folder of a sweep: hamflow sweep --figure draws it" : ""));
  }
  try {
    return read(path);
  } catch (const FileError& error) {
    throw FileError(path.string() + " cannot be read, damaged or no run of hamflow: " + error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  } catch (const std::length_error&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  }
}

}  // namespace

RunSamples read_run_file(const std::filesystem::path& path) { return naming(path, read_samples); }
RunDigits read_run_digits(const std::filesystem::path& path) { return naming(path, read_digits); }

}  // namespace hamflow
