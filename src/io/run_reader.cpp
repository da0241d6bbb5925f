// Reads run.h5, also while it grows and after a crash.
#include <algorithm>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>

#include "file_format.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hdf5_text.hpp"
#include "run_file.hpp"

namespace hamflow {

namespace {

/// Opens a dataset with one number in each row.
StoredData column(hid_t file, const std::string& path) {
  StoredData data = StoredData::dataset(file, path);
  if (data.shape().size() != 1) {
    throw FileError("HDF5: " + data.name() + " has rank " + std::to_string(data.shape().size()) + "; allowed rank 1");
  }
  return data;
}

/// Opens a dataset of states: of rank 2, or of rank 3 for particles.
/// @param width numbers in a row; 0: any
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

/// Returns decimal texts. Other texts are refused, because an expression in them would be evaluated.
std::vector<std::string> digits_of(const StoredData& data) {
  std::vector<std::string> texts = data.texts();
  for (const std::string& text : texts) {
    if (text.find_first_not_of("0123456789+-.enaif") != std::string::npos) {
      throw FileError("HDF5: " + data.name() + " holds a text that is not a number");
    }
  }
  return texts;
}

bool has_particles(hid_t file) { return has_object(file, "particles/all"); }

/// Returns the names of the states in a reverse.h5, in order.
std::vector<std::string> states_of_reversal(hid_t file) {
  std::vector<std::string> names;
  if (has_object(file, "t")) return names;
  for (const char* name : {"start", "turn", "end"}) {
    if (has_object(file, name)) names.emplace_back(name);
  }
  return names;
}

/// Reads q or p of a state of a reversal.
std::vector<double> state_of_reversal(hid_t file, const std::string& path, std::size_t width) {
  const StoredData data = column(file, path);
  if (data.rows() == 0 || (width != 0 && data.rows() != width)) throw FileError("HDF5: states differ in length");
  return data.numbers();
}

Column numbers_column(const std::string& name, std::size_t width, bool scalar, const std::vector<double>& values) {
  Column column({.name = name, .width = width, .scalar = scalar});
  column.add_bytes(std::as_bytes(std::span(values)));
  return column;
}
Column integers_column(const std::string& name, const std::vector<double>& values) {
  Column column({.name = name, .type = ValueType::integer});
  for (const double x : values) column.add(static_cast<std::int64_t>(x));
  return column;
}
Column digits_column(const std::string& name, std::size_t width, bool scalar, const std::vector<std::string>& values) {
  std::size_t longest = 1;
  for (const std::string& text : values) longest = std::max(longest, text.size());
  Column column({.name = name, .type = ValueType::text, .width = width, .scalar = scalar, .text_size = longest});
  for (const std::string& text : values) column.add(std::string_view(text));
  return column;
}

/// Reads a reversal as a run with three samples.
StoredRun read_reversal(hid_t file, const std::vector<std::string>& names, std::size_t most_coordinates) {
  StoredRun run;
  run.description.scenario = read_text_dataset(file, "scenario");
  std::vector<double> t;
  std::vector<double> q;
  std::vector<double> p;
  std::size_t width = 0;
  for (const std::string& name : names) {
    const Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, "open group " + name);
    t.push_back(number_attribute(group, "t"));
    for (const auto& [numbers, letter] : {std::pair{&q, "/q"}, std::pair{&p, "/p"}}) {
      const std::vector<double> row = state_of_reversal(file, name + letter, width);
      width = row.size();
      numbers->insert(numbers->end(), row.begin(), row.end());
    }
  }
  run.description.dimension = width;
  if (width <= most_coordinates) {
    run.tables.samples.add(numbers_column("q", width, false, q));
    run.tables.samples.add(numbers_column("p", width, false, p));
  }
  run.tables.samples.add(numbers_column("t", 1, true, t));
  return run;
}

/// Reads an object among the samples that another program may have written. It becomes a column if it has numbers in
/// the same number of rows.
void add_other_column(hid_t file, const std::string& name, const std::string& path, std::size_t rows, StoredRun& run) {
  const auto leave_out = [&](const std::string& why) {
    run.left_out.push_back("/" + path + " is left out: it " + why);
  };
  if (!has_object(file, path)) return leave_out("is a broken link");
  {
    const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path);
    if (H5Iget_type(object) != H5I_DATASET) return leave_out("is no dataset");
  }
  const StoredData data = StoredData::dataset(file, path);
  const std::size_t rank = data.shape().size();
  if (data.kind() != StoredData::Kind::numbers || rank < 1 || rank > 2 || data.width() == 0) {
    return leave_out("has no rows of numbers");
  }
  if (data.rows() < rows) {
    return leave_out("has " + std::to_string(data.rows()) + " rows, but the run has " + std::to_string(rows) +
                     " samples");
  }
  run.tables.samples.add(numbers_column(name, data.width(), data.width() == 1, data.numbers())).cut(rows);
}

/// Adds the digits of the samples, unless the run was in double. In a run that is still running they may have fewer
/// rows.
void add_digits(hid_t file, std::size_t width, Table& samples) {
  if (!has_object(file, "digits/t")) return;
  for (const char* name : {"digits/q", "digits/p"}) {
    samples.add(digits_column(name, width, false, digits_of(rows_of_states(file, name, width))));
  }
  for (const char* name : {"digits/energy", "digits/t"}) {
    samples.add(digits_column(name, 1, true, digits_of(column(file, name))));
  }
}

/// Cuts all columns to the shortest one: after a crash between two flushes their lengths may differ.
void cut_to_equal_length(Table& table) {
  std::size_t rows = std::numeric_limits<std::size_t>::max();
  for (const Column& column : table.columns()) rows = std::min(rows, column.rows());
  table.cut(rows);
}

/// Reads a table in a group of its own.
Table read_table(hid_t file, const std::string& group, std::size_t width, const std::vector<const char*>& states,
                 const std::vector<const char*>& integers) {
  Table table;
  for (const char* name : states) {
    table.add(numbers_column(name, width, false, rows_of_states(file, group + name, width).numbers()));
  }
  for (const char* name : integers) table.add(integers_column(name, column(file, group + name).numbers()));
  table.add(numbers_column("t", 1, true, column(file, group + "t").numbers()));
  cut_to_equal_length(table);
  return table;
}

StoredRun read_run(const std::filesystem::path& path, const StoredRunOptions& options) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    return read_reversal(file, states, options.most_coordinates);
  }
  StoredRun run;
  run.description.scenario = read_text_dataset(file, "scenario");
  run.description.version = text_attribute(file, "hamflow");
  run.description.host = text_attribute(file, "host");
  run.description.problem = text_attribute(file, "problem");
  run.description.method = text_attribute(file, "method");
  run.description.arithmetic = text_attribute(file, "arithmetic");
  Table& samples = run.tables.samples;
  const Column t = numbers_column("t", 1, true, column(file, "t").numbers());
  const Column energy = numbers_column("energy", 1, true, column(file, "energy").numbers());
  const bool particles = has_particles(file);
  const StoredData q = rows_of_states(file, particles ? H5mdNames::position : "q", 0);
  const std::size_t width = q.width();
  const StoredData p = rows_of_states(file, particles ? H5mdNames::momentum : "p", width);
  // Time is written last, so no other column of a run is shorter.
  const std::size_t count = std::min({t.rows(), energy.rows(), q.rows(), p.rows()});
  if (width <= options.most_coordinates) {
    samples.add(numbers_column("q", width, false, q.numbers()));
    samples.add(numbers_column("p", width, false, p.numbers()));
  }
  samples.add(energy);
  run.description.dimension = width;
  for (const auto& [name, meaning] : energy_range_columns) {
    if (has_object(file, name)) add_other_column(file, name, name, count, run);
  }
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (has_object(file, name)) add_other_column(file, name, name, count, run);
  }
  const auto names_of_group = [&](const char* name) {
    if (!has_object(file, name)) return std::vector<std::string>();
    const Hdf5Handle group(H5Gopen2(file, name, H5P_DEFAULT), H5Gclose, "open group " + std::string(name));
    return names_in(group);
  };
  for (const std::string& name : names_of_group("observables")) {
    if (particles && (name == "energy" || has_object(file, "invariants/" + name))) continue;
    const std::string column = "observables/" + name;
    add_other_column(file, column, column + (particles ? "/value" : ""), count, run);
  }
  for (const std::string& name : names_of_group("invariants")) {
    add_other_column(file, "invariants/" + name, "invariants/" + name, count, run);
  }
  for (const auto& [name, meaning] : count_columns) {
    if (options.counts && has_object(file, name)) samples.add(integers_column(name, column(file, name).numbers()));
  }
  if (options.digits) add_digits(file, width, samples);
  samples.add(t);
  cut_to_equal_length(samples);
  if (has_object(file, "section/t")) {
    run.tables.section = read_table(file, "section/", width, {"q", "p"}, {});
    run.description.section = true;
  }
  if (has_object(file, "events/wall/t")) {
    run.tables.bounces = options.events
                             ? read_table(file, "events/wall/", width, {"q", "p"}, {"step", "coordinate", "side"})
                             : read_table(file, "events/wall/", width, {"q"}, {});
  }
  for (const std::string& name : options.events ? names_of_group("events/user") : std::vector<std::string>()) {
    Table& event =
        run.tables.events.emplace_back(read_table(file, "events/user/" + name + "/", width, {"q", "p"}, {"step"}));
    event.rename(name);
    run.description.events.push_back(name);
  }
  return run;
}

std::vector<double> read_positions(const std::filesystem::path& path, std::size_t sample) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    if (sample >= states.size()) throw FileError("HDF5: a state is missing");
    return state_of_reversal(file, states[sample] + "/q", 0);
  }
  return rows_of_states(file, has_particles(file) ? H5mdNames::position : "q", 0).numbers_of_row(sample);
}

/// Adds the name of the file to errors that occur while it is read.
template <class Read>
auto naming(const std::filesystem::path& path, const Read& read) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) {
    const bool of_sweep = std::filesystem::exists(path.parent_path() / "sweep.h5", unknown) && path.has_parent_path();
    throw FileError(
        path.string() + " cannot be read: the file does not exist" +
        (of_sweep ? "; this is the folder of a sweep: " + command_name("sweep --figure") + " draws it" : ""));
  }
  try {
    return read(path);
  } catch (const OtherFormat&) {
    throw;
  } catch (const FileError& error) {
    throw FileError(path.string() + " is damaged or is not a run of hamflow: " + error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(path.string() + " cannot be read: it states an impossible size");
  } catch (const std::length_error&) {
    throw FileError(path.string() + " cannot be read: it states an impossible size");
  }
}

}  // namespace

StoredRun read_run_file(const std::filesystem::path& path, const StoredRunOptions& options) {
  return naming(path, [&](const std::filesystem::path& file) { return read_run(file, options); });
}
std::vector<double> read_run_positions(const std::filesystem::path& path, std::size_t sample) {
  return naming(path, [&](const std::filesystem::path& file) { return read_positions(file, sample); });
}

}  // namespace hamflow
