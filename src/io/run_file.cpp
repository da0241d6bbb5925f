#include "run_file.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <span>

#include "h5md_groups.hpp"
#include "hdf5_text.hpp"
#include "stored_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

constexpr std::size_t batch_rows = 8192;  // rows for each write call: 35 ns a row instead of 25 us
// bytes for each write call; limits the rows of large systems
constexpr std::size_t batch_bytes = std::size_t{1} << 23;
// written rows stay in memory up to this size, because figures are drawn from them
constexpr std::size_t bytes_in_memory = std::size_t{1} << 24;
constexpr double flush_seconds = 0.25;  // a crash loses at most the rows of this time
using Clock = std::chrono::steady_clock;

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::tm parts{};
  gmtime_r(&now, &parts);
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

/// A dataset and the column of its table that it contains.
struct Shown {
  StoredColumn stored;
  std::size_t column;
  std::vector<double> divisors{};  // each row is divided by these, to turn momenta into velocities
  std::vector<double> constant{};  // each row has these values instead
};

/// The datasets of a table, in the order of its columns.
struct StoredTable {
  std::vector<Shown> shown{};
  std::size_t written = 0;  // number of rows that are written and still in memory

  void write(const Table& table) {
    const std::size_t rows = table.rows();
    if (rows == written) return;
    std::vector<double> changed;
    for (Shown& each : shown) {
      const Column& column = table.columns()[each.column];
      const std::size_t of_row = column.info().width;
      if (!each.constant.empty()) {
        changed.clear();
        for (std::size_t k = written; k < rows; ++k) {
          changed.insert(changed.end(), each.constant.begin(), each.constant.end());
        }
      } else if (!each.divisors.empty()) {
        const std::span<const double> values = column.numbers().subspan(written * of_row, (rows - written) * of_row);
        changed.assign(values.begin(), values.end());
        for (std::size_t k = 0; k < changed.size(); ++k) changed[k] /= each.divisors[k % of_row];
      } else {
        each.stored.write(column.bytes().data() + written * column.bytes_of_row(), rows - written);
        continue;
      }
      each.stored.write(changed.data(), rows - written);
    }
    written = rows;
  }
  void copy_from(hid_t other, std::uint64_t rows, std::size_t at_once) {
    for (Shown& each : shown) each.stored.copy_from(other, rows, at_once);
  }
};

/// Returns the path of a column: "digits/q" of a table in the group "section/" is "digits/section/q".
std::string path_in(const std::string& group, const std::string& column) {
  constexpr std::string_view digits = "digits/";
  if (!column.starts_with(digits)) return group + column;
  return std::string(digits) + group + column.substr(digits.size());
}

StoredTable stored_table(hid_t file, const std::string& group, const Table& table, std::size_t rows) {
  StoredTable all;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    const ColumnInfo& info = table.columns()[k].info();
    all.shown.push_back({StoredColumn(file, path_in(group, info.name), info, rows), k});
  }
  return all;
}

/// Makes the datasets of particles at the paths of H5MD.
StoredTable stored_particles(hid_t file, const RunDescription& run, const Table& table, std::size_t rows) {
  const std::size_t space = run.particles.space;
  StoredTable all;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    ColumnInfo info = table.columns()[k].info();
    const auto show = [&](const char* path, const std::string& meaning) -> Shown& {
      ColumnInfo its = info;
      its.parts.clear();
      its.meaning = meaning;
      return all.shown.emplace_back(Shown{StoredColumn(file, path, its, rows, space), k});
    };
    if (info.name == "q") {
      show(H5mdNames::position, "coordinates, not folded into a periodic box");
    } else if (info.name == "p") {
      show(H5mdNames::momentum, "canonical momenta");
      if (!run.particles.unit_masses()) {
        info.unit.clear();
        Shown& velocity = show(H5mdNames::velocity, "momenta divided by masses");
        for (std::size_t i = 0; i < run.dimension; ++i) velocity.divisors.push_back(run.particles.masses[i / space]);
      }
      if (!run.particles.edges.empty()) {
        const ColumnInfo edges{.name = H5mdNames::edges,
                               .width = space,
                               .scalar = false,
                               .meaning = H5mdNames::edges_meaning,
                               .unit = run.units.q};
        all.shown.push_back({StoredColumn(file, H5mdNames::edges, edges, rows), k, {}, run.particles.edges});
      }
    } else {
      const std::string path = info.name.starts_with("observables/") ? info.name + "/value" : info.name;
      all.shown.push_back({StoredColumn(file, path, info, rows), k});
    }
  }
  return all;
}

void write_attributes(hid_t file, const RunDescription& run) {
  if (!run.identity.empty()) write_attribute(file, "run", run.identity);
  write_attribute(file, "hamflow", run.version);
  write_attribute(file, "host", run.host);
  write_attribute(file, "problem", run.problem);
  write_attribute(file, "method", run.method);
  write_attribute(file, "arithmetic", run.arithmetic);
  write_attribute(file, "created", run.created.empty() ? now_utc() : run.created);
  write_attribute(file, "dt", run.dt);
  write_attribute(file, "dt_text", run.dt_text);
  if (!run.coordinates.empty()) write_attribute(file, "coordinates", run.coordinates);
  if (!run.momenta.empty()) write_attribute(file, "momenta", run.momenta);
  if (!run.masses.empty()) write_attribute(file, "masses", run.masses);
}

}  // namespace

struct RunFile::Impl {
  RunRows& rows;
  Hdf5Handle file;
  StoredTable samples;
  StoredTable section;
  StoredTable bounces;
  std::vector<StoredTable> events;
  bool failed = false;
  std::size_t most_waiting = batch_rows;
  Clock::time_point flushed = Clock::now();

  /// Largest number of rows of a table that wait to be written.
  std::size_t waiting() const {
    const RunTables& tables = rows.tables();
    std::size_t most = std::max({tables.samples.rows() - samples.written, tables.section.rows() - section.written,
                                 tables.bounces.rows() - bounces.written});
    for (std::size_t k = 0; k < events.size(); ++k) {
      most = std::max(most, tables.events[k].rows() - events[k].written);
    }
    return most;
  }
  void write() {
    const RunTables& tables = rows.tables();
    failed = true;  // reset below if every write succeeds
    bounces.write(tables.bounces);
    section.write(tables.section);
    samples.write(tables.samples);
    for (std::size_t k = 0; k < events.size(); ++k) events[k].write(tables.events[k]);
    failed = false;
    std::size_t bytes = tables.samples.bytes() + tables.section.bytes() + tables.bounces.bytes();
    for (const Table& event : tables.events) bytes += event.bytes();
    if (rows.complete() && bytes <= bytes_in_memory) return;
    rows.drop();
    samples.written = section.written = bounces.written = 0;
    for (StoredTable& event : events) event.written = 0;
  }
};

std::unique_ptr<RunFile::Impl> RunFile::create(const std::filesystem::path& file, const RunDescription& description,
                                               RunRows& rows) {
  silence_hdf5();
  auto impl = std::make_unique<Impl>(Impl{rows});
  impl->file = create_hdf5(file);
  const hid_t id = impl->file;
  write_attributes(id, description);
  write_text_dataset(id, "scenario", description.scenario);
  for (const char* group : {"invariants", "solver", "events"}) (void)make_group(id, group);
  const bool particles = description.particles.space > 0;
  if (!description.observables.empty() || particles) (void)make_group(id, "observables");
  if (particles) write_h5md_groups(id, description);
  const RunTables& tables = rows.tables();
  const bool digits = description.digits_length > 0;
  /// Makes the group of a table whose rows are not samples.
  const auto in_group = [&](const std::string& group, const Table& table) {
    (void)make_group(id, group);
    if (digits) (void)make_group(id, "digits/" + group);
    return stored_table(id, group + "/", table, batch_rows);
  };
  if (digits) (void)make_group(id, "digits");
  if (description.section) impl->section = in_group("section", tables.section);
  if (digits && (description.walls || !description.events.empty())) (void)make_group(id, "digits/events");
  if (description.walls) impl->bounces = in_group("events/wall", tables.bounces);
  if (!description.events.empty()) {
    (void)make_group(id, "events/user");
    if (digits) (void)make_group(id, "digits/events/user");
  }
  for (const Table& event : tables.events) impl->events.push_back(in_group("events/user/" + event.name(), event));
  const std::size_t expected = description.samples > 0 ? description.samples : batch_rows;
  impl->samples = particles ? stored_particles(id, description, tables.samples, expected)
                            : stored_table(id, "", tables.samples, expected);
  if (particles) link_h5md_elements(id, description);
  std::size_t bytes = 0;
  for (const Shown& each : impl->samples.shown) bytes += each.stored.bytes_of_row();
  impl->most_waiting = std::clamp<std::size_t>(batch_bytes / bytes, 1, batch_rows);
  // Every object has to exist before this call. Afterwards readers may open the file, and a crash leaves a readable
  // file.
  check_hdf5(H5Fstart_swmr_write(id), "start single-writer mode in " + file.string());
  return impl;
}

RunFile::RunFile(const std::filesystem::path& file, const RunDescription& description, RunRows& rows) {
  const std::filesystem::path fresh = next_name(file);
  const bool goes_on = !rows.complete();
  try {
    if (!goes_on) {
      impl_ = create(fresh, description, rows);
    } else {
      silence_hdf5();
      const Hdf5Handle old = open_to_read(file);
      RunDescription same = description;
      same.created = text_attribute(old, "created");
      impl_ = create(fresh, same, rows);
      const RowCounts before = rows.counts();
      impl_->samples.copy_from(old, before.samples, impl_->most_waiting);
      impl_->section.copy_from(old, before.section, impl_->most_waiting);
      impl_->bounces.copy_from(old, before.bounces, impl_->most_waiting);
      for (std::size_t k = 0; k < impl_->events.size(); ++k) {
        impl_->events[k].copy_from(old, before.events[k], impl_->most_waiting);
      }
      force_to_disk(fresh);
    }
    std::filesystem::rename(fresh, file);  // from now on readers can open it by its name; the open file stays the same
  } catch (const std::exception& error) {
    impl_.reset();
    std::error_code ignored;
    std::filesystem::remove(fresh, ignored);
    if (!goes_on) throw;
    throw FileError("cannot resume with " + file.string() + ": " + error.what());
  }
}

RunFile::~RunFile() {
  if (!impl_) return;
  try {
    flush();
  } catch (const FileError&) {  // NOLINT: a destructor cannot report; flush() was called before where it matters
  }
  // After a failed write HDF5 holds metadata of data that are not in the file, and would write them when the file is
  // closed. The file is left open instead, as after a kill, so that readers can open it.
  if (impl_->failed) (void)impl_.release();
}

void RunFile::flush() {
  if (impl_->failed) throw FileError("HDF5: a write has failed before");
  if (impl_->waiting() == 0) return;
  impl_->write();
  impl_->flushed = Clock::now();
}

void RunFile::flush_if_many() {
  if (impl_->waiting() >= impl_->most_waiting) flush();
}

void RunFile::flush_if_due() {
  if (std::chrono::duration<double>(Clock::now() - impl_->flushed).count() > flush_seconds) flush();
}

}  // namespace hamflow
