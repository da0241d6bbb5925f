#include "run_file.hpp"

#include <algorithm>
#include <ctime>

#include "hdf5_text.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

constexpr std::size_t batch_rows = 8192;                     // one write call per batch: 35 ns a row instead of 25 us
constexpr std::size_t batch_numbers = std::size_t{1} << 20;  // of large systems fewer rows: 8 megabytes wait at most
constexpr std::size_t chunk_numbers = std::size_t{1} << 17;  // a chunk has to fit the cache of 1 megabyte
constexpr double flush_seconds = 0.25;                       // at most so much is lost by a crash
using Clock = std::chrono::steady_clock;
constexpr const char* diagnostic_names[] = {"iterations", "residual", "condition_tangent", "determinant_tangent",
                                            "condition_inverse_mass"};

/// A dataset that grows by rows of `width` doubles or 64-bit integers, with the rows that wait to be written.
template <class T>
class Column {
 public:
  Column(hid_t file, std::string name, std::size_t width, std::size_t rows) : name_(std::move(name)), width_(width) {
    const int rank = width > 0 ? 2 : 1;
    const hsize_t columns = std::max<std::size_t>(width, 1);
    const hsize_t size[2] = {0, columns};
    const hsize_t most[2] = {H5S_UNLIMITED, columns};
    const hsize_t most_rows = std::max<hsize_t>(chunk_numbers / columns, 1);
    const hsize_t chunk[2] = {std::min(std::max<hsize_t>(std::min(batch_rows, rows) / columns, 16), most_rows),
                              columns};
    const Hdf5Handle space(H5Screate_simple(rank, size, most), H5Sclose, "make a data space");
    const Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
    check_hdf5(H5Pset_chunk(plist, rank, chunk), "chunk " + name_);
    dataset_ = Hdf5Handle(H5Dcreate2(file, name_.c_str(), stored_type(), space, H5P_DEFAULT, plist, H5P_DEFAULT),
                          H5Dclose, "create dataset " + name_);
  }
  void add(T value) { waiting_.push_back(value); }
  std::size_t numbers_a_row() const { return std::max<std::size_t>(width_, 1); }
  /// Writes the first `rows` rows of the dataset of the same name in another file.
  void copy_from(hid_t other, std::uint64_t rows, std::size_t at_once) {
    const Hdf5Handle source(H5Dopen2(other, name_.c_str(), H5P_DEFAULT), H5Dclose, "open dataset " + name_);
    const Hdf5Handle space(H5Dget_space(source), H5Sclose, "open the space of " + name_);
    const int rank = width_ > 0 ? 2 : 1;
    hsize_t size[2] = {0, 1};
    if (H5Sget_simple_extent_ndims(space) != rank) throw FileError("HDF5: dataset " + name_ + " has another shape");
    check_hdf5(H5Sget_simple_extent_dims(space, size, nullptr), "read the size of " + name_);
    if (size[1] != numbers_a_row()) throw FileError("HDF5: dataset " + name_ + " has another width");
    if (size[0] < rows) {
      throw FileError("HDF5: dataset " + name_ + " has " + std::to_string(size[0]) + " rows, not the " +
                      std::to_string(rows) + " that the checkpoint counts");
    }
    while (written_ < rows) {
      const hsize_t offset[2] = {written_, 0};
      const hsize_t count[2] = {std::min<hsize_t>(rows - written_, at_once), size[1]};
      const Hdf5Handle part(H5Dget_space(source), H5Sclose, "open the space of " + name_);
      check_hdf5(H5Sselect_hyperslab(part, H5S_SELECT_SET, offset, nullptr, count, nullptr), "select rows of " + name_);
      const Hdf5Handle memory(H5Screate_simple(rank, count, nullptr), H5Sclose, "make a data space");
      waiting_.resize(count[0] * count[1]);
      check_hdf5(H5Dread(source, memory_type(), memory, part, H5P_DEFAULT, waiting_.data()), "read " + name_);
      write(count[0]);
    }
  }
  void write(std::size_t rows) {
    const hsize_t columns = std::max<std::size_t>(width_, 1);
    const int rank = width_ > 0 ? 2 : 1;
    const hsize_t size[2] = {written_ + rows, columns};
    const hsize_t offset[2] = {written_, 0};
    const hsize_t count[2] = {rows, columns};
    check_hdf5(H5Dset_extent(dataset_, size), "extend dataset " + name_);
    const Hdf5Handle space(H5Dget_space(dataset_), H5Sclose, "open the space of " + name_);
    check_hdf5(H5Sselect_hyperslab(space, H5S_SELECT_SET, offset, nullptr, count, nullptr), "select rows of " + name_);
    const Hdf5Handle memory(H5Screate_simple(rank, count, nullptr), H5Sclose, "make a data space");
    check_hdf5(H5Dwrite(dataset_, memory_type(), memory, space, H5P_DEFAULT, waiting_.data()), "write " + name_);
    check_hdf5(H5Dflush(dataset_), "flush " + name_);
    written_ += rows;
    waiting_.clear();
  }

 private:
  static hid_t stored_type() { return std::is_same_v<T, double> ? H5T_IEEE_F64LE : H5T_STD_I64LE; }
  static hid_t memory_type() { return std::is_same_v<T, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64; }

  std::string name_;
  std::size_t width_;
  Hdf5Handle dataset_;
  std::vector<T> waiting_;
  hsize_t written_ = 0;
};

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
  std::vector<Column<double>> vectors;  // q, p
  std::vector<Column<double>> invariants;
  std::vector<std::size_t> invariant_sizes;
  std::vector<Column<double>> diagnostics;
  std::vector<Column<double>> scalars;  // energy
  std::vector<Column<std::int64_t>> counts;
  std::vector<Column<double>> section;  // q, p, t of its points: rows of their own
  std::size_t section_waiting = 0;
  std::vector<Column<double>> time;  // last: its length tells how many rows are complete
  std::size_t waiting = 0;
  bool failed = false;
  std::size_t most_waiting = batch_rows;
  std::uint64_t rows = 0;
  std::uint64_t section_rows = 0;
  Clock::time_point flushed = Clock::now();

  template <class F>
  void for_each_column(F&& f) {
    for (auto* columns : {&vectors, &scalars, &invariants, &diagnostics}) {
      for (auto& column : *columns) f(column);
    }
    for (auto& column : counts) f(column);
    for (auto& column : time) f(column);
  }
};

std::unique_ptr<RunFile::Impl> RunFile::create(const std::filesystem::path& file, const RunDescription& description) {
  silence_hdf5();
  auto impl = std::make_unique<Impl>();
  impl->file = create_hdf5(file);
  const hid_t id = impl->file;
  if (!description.identity.empty()) write_attribute(id, "run", description.identity);
  write_attribute(id, "hamflow", description.version);
  write_attribute(id, "host", description.host);
  write_attribute(id, "problem", description.problem);
  write_attribute(id, "method", description.method);
  write_attribute(id, "arithmetic", description.arithmetic);
  write_attribute(id, "kernel", description.kernel);
  write_attribute(id, "created", description.created.empty() ? now_utc() : description.created);
  write_text_dataset(id, "scenario", description.scenario);
  const Hdf5Handle groups[] = {make_group(id, "invariants"), make_group(id, "solver"), make_group(id, "events")};
  const std::size_t rows = description.samples > 0 ? description.samples : batch_rows;
  impl->vectors.emplace_back(id, "q", description.dimension, rows);
  impl->vectors.emplace_back(id, "p", description.dimension, rows);
  impl->scalars.emplace_back(id, "energy", 0, rows);
  for (const auto& [name, size] : description.invariants) {
    impl->invariants.emplace_back(id, "invariants/" + name, size == 1 ? 0 : size, rows);
    impl->invariant_sizes.push_back(size);
  }
  for (const char* name : diagnostic_names) {
    if (description.diagnostics) impl->diagnostics.emplace_back(id, std::string("solver/") + name, 0, rows);
  }
  for (const char* name : {"step", "solver/force", "solver/hessian", "solver/linear_solves", "events/halved"}) {
    impl->counts.emplace_back(id, name, 0, rows);
  }
  if (description.section) {
    (void)make_group(id, "section");
    impl->section.emplace_back(id, "section/q", description.dimension, batch_rows);
    impl->section.emplace_back(id, "section/p", description.dimension, batch_rows);
    impl->section.emplace_back(id, "section/t", 0, batch_rows);
  }
  impl->time.emplace_back(id, "t", 0, rows);
  std::size_t numbers = 0;
  impl->for_each_column([&](const auto& column) { numbers += column.numbers_a_row(); });
  impl->most_waiting = std::clamp<std::size_t>(batch_numbers / numbers, 1, batch_rows);
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
                 std::uint64_t section_rows) {
  silence_hdf5();
  const std::filesystem::path fresh = next_name(file);
  try {
    const Hdf5Handle old = open_to_read(file);
    RunDescription same = description;
    same.created = read_attribute(old, "created");
    auto copy = create(fresh, same);
    copy->for_each_column([&](auto& column) { column.copy_from(old, rows, copy->most_waiting); });
    for (auto& column : copy->section) column.copy_from(old, section_rows, copy->most_waiting);
    copy->rows = rows;
    copy->section_rows = section_rows;
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

void RunFile::append(const Frame& frame) {
  for (const double x : frame.q) impl_->vectors[0].add(x);
  for (const double x : frame.p) impl_->vectors[1].add(x);
  impl_->scalars[0].add(frame.energy);
  std::size_t at = 0;
  for (std::size_t i = 0; i < impl_->invariants.size(); ++i) {
    for (std::size_t k = 0; k < impl_->invariant_sizes[i]; ++k) impl_->invariants[i].add(frame.invariants[at++]);
  }
  const StepDiagnostics& d = frame.diagnostics;
  const double of_step[] = {d.iterations, d.residual, d.condition_tangent, d.determinant_tangent,
                            d.condition_inverse_mass};
  for (std::size_t i = 0; i < impl_->diagnostics.size(); ++i) impl_->diagnostics[i].add(of_step[i]);
  const std::int64_t counts[] = {frame.step, frame.effort.force, frame.effort.hessian, frame.effort.linear_solves,
                                 frame.effort.halved};
  for (std::size_t i = 0; i < impl_->counts.size(); ++i) impl_->counts[i].add(counts[i]);
  impl_->time[0].add(frame.time);
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

void RunFile::flush() {
  if (impl_->failed) throw FileError("HDF5: a write has failed before");
  const std::size_t points = std::exchange(impl_->section_waiting, 0);
  const std::size_t rows = std::exchange(impl_->waiting, 0);
  impl_->failed = true;  // until all is written
  for (auto& column : impl_->section) {
    if (points > 0) column.write(points);
  }
  impl_->for_each_column([&](auto& column) {
    if (rows > 0) column.write(rows);
  });
  impl_->failed = false;
  if (rows == 0) return;
  impl_->flushed = Clock::now();
}

void RunFile::flush_if_due() {
  if (std::chrono::duration<double>(Clock::now() - impl_->flushed).count() > flush_seconds) flush();
}

namespace {
/// A dataset as rows of `width` numbers, row by row.
std::vector<double> read_column(hid_t file, const char* name, std::size_t& width) {
  const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, std::string("open dataset ") + name);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, std::string("open the space of ") + name);
  hsize_t size[2] = {0, 1};
  if (H5Sget_simple_extent_ndims(space) > 2)
    throw FileError(std::string("HDF5: dataset ") + name + " has too many dimensions");
  check_hdf5(H5Sget_simple_extent_dims(space, size, nullptr), std::string("read the size of ") + name);
  width = size[1];
  std::vector<double> values(size[0] * size[1]);
  if (!values.empty()) {
    check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
               std::string("read ") + name);
  }
  return values;
}

std::vector<std::vector<double>> by_coordinate(const std::vector<double>& rows, std::size_t width, std::size_t count) {
  std::vector<std::vector<double>> out(width, std::vector<double>(count));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < width; ++i) out[i][k] = rows[k * width + i];
  }
  return out;
}
}  // namespace

namespace {
RunSamples read_samples(const std::filesystem::path& path) {
  silence_hdf5();
  if (!std::filesystem::exists(path)) throw FileError("there is no such file");
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
  for (const char* name : diagnostic_names) {
    const std::string path_in_file = std::string("solver/") + name;
    if (H5Lexists(file, path_in_file.c_str(), H5P_DEFAULT) <= 0) continue;
    run.diagnostics.emplace_back(name, read_column(file, path_in_file.c_str(), one));
  }
  // After a crash between two flushes the columns may differ in length: what all of them have is complete.
  std::size_t count = std::min({run.t.size(), run.energy.size(), q.size() / q_width, p.size() / p_width});
  for (const auto& column : run.diagnostics) count = std::min(count, column.second.size());
  for (auto& column : run.diagnostics) column.second.resize(count);
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

}  // namespace

RunSamples read_run_file(const std::filesystem::path& path) {
  try {
    return read_samples(path);
  } catch (const FileError& error) {
    throw FileError(path.string() + " cannot be read, damaged or no run of hamflow: " + error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  } catch (const std::length_error&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  }
}

}  // namespace hamflow
