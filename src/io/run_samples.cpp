// What run.h5 holds, read again: also while it grows, and after a crash.
#include <algorithm>
#include <iterator>
#include <new>
#include <stdexcept>

#include "hdf5_text.hpp"
#include "run_column.hpp"
#include "run_file.hpp"

namespace hamflow {

namespace {

/// A dataset of one number a row.
StoredData column(hid_t file, const std::string& path) {
  StoredData data = StoredData::dataset(file, path);
  if (data.shape().size() != 1) {
    throw FileError("HDF5: " + data.name() + " has rank " + std::to_string(data.shape().size()) + "; allowed rank 1");
  }
  return data;
}

/// A dataset of states: of rank 2, of particles of rank 3.
/// @param width of a row, 0: any
StoredData rows_of_states(hid_t file, const std::string& path, std::size_t width) {
  StoredData data = StoredData::dataset(file, path);
  const std::size_t rank = data.shape().size();
  if (rank != 2 && rank != 3) {
    throw FileError("HDF5: " + data.name() + " has rank " + std::to_string(rank) + "; allowed rank 2 or 3");
  }
  if (data.width() == 0 || (width != 0 && data.width() != width)) {
    throw FileError("HDF5: " + data.name() + " has rows of " + std::to_string(data.width()) + " values; allowed " +
                    (width != 0 ? std::to_string(width) : "at least 1"));
  }
  return data;
}

/// Decimal texts, in which an expression would be evaluated.
std::vector<std::string> digits_of(const StoredData& data) {
  std::vector<std::string> texts = data.texts();
  for (const std::string& text : texts) {
    if (text.find_first_not_of("0123456789+-.enaif") != std::string::npos) {
      throw FileError("HDF5: " + data.name() + " holds a text that is not a number");
    }
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

bool has_particles(hid_t file) { return has_object(file, "particles/all"); }

/// The states that reverse.h5 has, in their order.
std::vector<std::string> states_of_reversal(hid_t file) {
  std::vector<std::string> names;
  if (has_object(file, "t")) return names;
  for (const char* name : {"start", "turn", "end"}) {
    if (has_object(file, name)) names.emplace_back(name);
  }
  return names;
}

/// q or p of a state of a reversal.
std::vector<double> state_of_reversal(hid_t file, const std::string& path, std::size_t width) {
  const StoredData data = column(file, path);
  if (data.rows() == 0 || (width != 0 && data.rows() != width)) throw FileError("HDF5: states differ in length");
  return data.numbers();
}

/// A reversal as a run of three samples.
RunSamples read_reversal(hid_t file, const std::vector<std::string>& names, std::size_t most_coordinates) {
  RunSamples run;
  run.description.scenario = read_text_dataset(file, "scenario");
  std::vector<double> q;
  std::vector<double> p;
  std::size_t width = 0;
  for (const std::string& name : names) {
    const Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, "open group " + name);
    run.t.push_back(number_attribute(group, "t"));
    for (const auto& [numbers, letter] : {std::pair{&q, "/q"}, std::pair{&p, "/p"}}) {
      const std::vector<double> row = state_of_reversal(file, name + letter, width);
      width = row.size();
      numbers->insert(numbers->end(), row.begin(), row.end());
    }
  }
  run.description.dimension = width;
  if (width > most_coordinates) return run;
  run.q = by_coordinate(q, width, names.size());
  run.p = by_coordinate(p, width, names.size());
  return run;
}

/// What stands among the samples and may be somebody else's: it is a column where it has numbers in as many rows.
struct OtherColumn {
  std::string name;
  std::string path;
  std::vector<std::pair<std::string, std::vector<double>>>* to;
};

/// A column, or NAME_1, NAME_2, ... of several numbers a row.
void add_other_column(hid_t file, const OtherColumn& other, RunSamples& run) {
  const std::size_t rows = run.t.size();
  const auto leave_out = [&](const std::string& why) {
    run.left_out.push_back("/" + other.path + " is left out: it " + why);
  };
  if (!has_object(file, other.path)) return leave_out("is a link that leads nowhere");
  {
    const Hdf5Handle object(H5Oopen(file, other.path.c_str(), H5P_DEFAULT), H5Oclose, "open " + other.path);
    if (H5Iget_type(object) != H5I_DATASET) return leave_out("is no dataset");
  }
  const StoredData data = StoredData::dataset(file, other.path);
  const std::size_t rank = data.shape().size();
  if (data.kind() != StoredData::Kind::numbers || rank < 1 || rank > 2 || data.width() == 0) {
    return leave_out("has no rows of numbers");
  }
  if (data.rows() < rows) {
    return leave_out("has " + std::to_string(data.rows()) + " rows, the run " + std::to_string(rows) + " samples");
  }
  auto columns = by_coordinate(data.numbers(), data.width(), rows);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    other.to->emplace_back(columns.size() == 1 ? other.name : other.name + "_" + std::to_string(k + 1),
                           std::move(columns[k]));
  }
}

RunSamples read_samples(const std::filesystem::path& path, std::size_t most_coordinates) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    return read_reversal(file, states, most_coordinates);
  }
  RunSamples run;
  run.description.scenario = read_text_dataset(file, "scenario");
  run.description.version = text_attribute(file, "hamflow");
  run.description.host = text_attribute(file, "host");
  run.description.problem = text_attribute(file, "problem");
  run.description.method = text_attribute(file, "method");
  run.description.arithmetic = text_attribute(file, "arithmetic");
  run.t = column(file, "t").numbers();
  run.energy = column(file, "energy").numbers();
  const bool particles = has_particles(file);
  const StoredData q = rows_of_states(file, particles ? H5mdNames::position : "q", 0);
  const std::size_t width = q.width();
  const StoredData p = rows_of_states(file, particles ? H5mdNames::momentum : "p", width);
  // After a crash between two flushes the columns may differ in length: what all of them have is complete. Time is
  // written last, so that no other column of the run is shorter.
  const std::size_t count = std::min({run.t.size(), run.energy.size(), q.rows(), p.rows()});
  run.t.resize(count);
  run.energy.resize(count);
  if (width <= most_coordinates) {
    run.q = by_coordinate(q.numbers(), width, count);
    run.p = by_coordinate(p.numbers(), width, count);
  }
  run.description.dimension = width;
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (has_object(file, name)) {
      add_other_column(file, {name + std::string("solver/").size(), name, &run.diagnostics}, run);
    }
  }
  std::vector<std::pair<std::string, std::vector<double>>> range;
  for (const auto& [name, meaning] : energy_range_columns) {
    if (has_object(file, name)) add_other_column(file, {name, name, &range}, run);
  }
  if (range.size() == std::size(energy_range_columns)) {  // both of them, with a number a row
    run.least_difference = std::move(range[0].second);
    run.largest_difference = std::move(range[1].second);
  }
  const auto names_of_group = [&](const char* name) {
    if (!has_object(file, name)) return std::vector<std::string>();
    const Hdf5Handle group(H5Gopen2(file, name, H5P_DEFAULT), H5Gclose, "open group " + std::string(name));
    return names_in(group);
  };
  for (const std::string& name : names_of_group("observables")) {
    if (particles && (name == "energy" || has_object(file, "invariants/" + name))) continue;
    add_other_column(file, {name, "observables/" + name + (particles ? "/value" : ""), &run.observables}, run);
  }
  for (const std::string& name : names_of_group("invariants")) {
    add_other_column(file, {name, "invariants/" + name, &run.invariants}, run);
  }
  if (has_object(file, "section/t")) {
    run.section_t = column(file, "section/t").numbers();
    const StoredData section_q = rows_of_states(file, "section/q", width);
    const StoredData section_p = rows_of_states(file, "section/p", width);
    const std::size_t points = std::min({run.section_t.size(), section_q.rows(), section_p.rows()});
    run.section_t.resize(points);
    run.section_q = by_coordinate(section_q.numbers(), width, points);
    run.section_p = by_coordinate(section_p.numbers(), width, points);
    run.description.section = true;
  }
  if (has_object(file, "events/wall/t")) {
    run.wall_t = column(file, "events/wall/t").numbers();
    const StoredData wall_q = rows_of_states(file, "events/wall/q", width);
    const std::size_t bounces = std::min(run.wall_t.size(), wall_q.rows());
    run.wall_t.resize(bounces);
    run.wall_q = by_coordinate(wall_q.numbers(), width, bounces);
  }
  return run;
}

std::vector<double> read_positions(const std::filesystem::path& path, std::size_t sample) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    if (sample >= states.size()) throw FileError("HDF5: a state is gone");
    return state_of_reversal(file, states[sample] + "/q", 0);
  }
  return rows_of_states(file, has_particles(file) ? H5mdNames::position : "q", 0).numbers_of_row(sample);
}

RunDigits read_digits(const std::filesystem::path& path) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  RunDigits run;
  if (!has_object(file, "digits/t")) return run;
  run.t = digits_of(column(file, "digits/t"));
  run.energy = digits_of(column(file, "digits/energy"));
  const StoredData q_data = rows_of_states(file, "digits/q", 0);
  const std::size_t width = q_data.width();
  const std::vector<std::string> q = digits_of(q_data);
  const std::vector<std::string> p = digits_of(rows_of_states(file, "digits/p", width));
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

RunSamples read_run_file(const std::filesystem::path& path, std::size_t most_coordinates) {
  return naming(path, [&](const std::filesystem::path& file) { return read_samples(file, most_coordinates); });
}
std::vector<double> read_run_positions(const std::filesystem::path& path, std::size_t sample) {
  return naming(path, [&](const std::filesystem::path& file) { return read_positions(file, sample); });
}
RunDigits read_run_digits(const std::filesystem::path& path) { return naming(path, read_digits); }

}  // namespace hamflow
