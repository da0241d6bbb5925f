#include "sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "hamflow/core/inverse_cube.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/state_names.hpp"
#include "hdf5_text.hpp"
#include "whole_file.hpp"

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

/// How often each hard wall was met.
void add_walls(const Sweep& sweep, std::vector<SweepColumn>& columns) {
  const Scenario& common = sweep.common();
  const auto any =
      std::find_if(sweep.rows().begin(), sweep.rows().end(), [](const MemberRow& row) { return !row.walls.empty(); });
  if (any == sweep.rows().end()) return;
  const StateNames names = state_names(*common.problem, common.request.parameters, common.start_q.size());
  for (std::size_t k = 0; k < any->walls.size(); ++k) {
    const WallCount& wall = any->walls[k];
    SweepColumn column{"events/wall:" + names.q.at(wall.coordinate) + (wall.side < 0 ? ":min" : ":max")};
    for (const MemberRow& row : sweep.rows()) column.counts.push_back(k < row.walls.size() ? row.walls[k].bounces : 0);
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

/// With a checksum for each chunk; chunks of 64 kilobytes at most, or of one row.
Hdf5Handle protected_chunks(int rank, const hsize_t* size, std::size_t bytes) {
  constexpr hsize_t most_bytes = 1 << 16;
  const hsize_t width = rank > 1 ? size[1] : 1;
  const hsize_t chunk[2] = {std::clamp<hsize_t>(most_bytes / (bytes * width), 1, std::max<hsize_t>(size[0], 1)), width};
  Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_chunk(plist, rank, chunk), "choose the chunks");
  check_hdf5(H5Pset_fletcher32(plist), "choose a checksum");
  return plist;
}

void write_dataset(hid_t file, const std::string& name, hid_t stored, hid_t memory, int rank, const hsize_t* size,
                   const void* values) {
  const Hdf5Handle space(H5Screate_simple(rank, size, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_create_intermediate_group(links, 1), "request intermediate groups");
  const Hdf5Handle plist = protected_chunks(rank, size, H5Tget_size(stored));
  const Hdf5Handle dataset(H5Dcreate2(file, name.c_str(), stored, space, links, plist, H5P_DEFAULT), H5Dclose,
                           "create dataset " + name);
  check_hdf5(H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write " + name);
}

void write_column(hid_t file, const SweepColumn& column) {
  const hsize_t rows = column.rows();
  const hsize_t size[2] = {rows, column.width};
  const int rank = column.scalar ? 1 : 2;
  if (!column.texts.empty()) {
    std::size_t longest = 1;
    for (const std::string& text : column.texts) longest = std::max(longest, text.size());
    std::string all;
    for (const std::string& text : column.texts) all += text + std::string(longest - text.size(), '\0');
    const Hdf5Handle type = text_type(longest);
    write_dataset(file, column.name, type, type, rank, size, all.data());
  } else if (!column.counts.empty()) {
    write_dataset(file, column.name, H5T_STD_I64LE, H5T_NATIVE_INT64, rank, size, column.counts.data());
  } else {
    write_dataset(file, column.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, size, column.numbers.data());
  }
}

}  // namespace

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
  add_walls(sweep, columns);
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

void write_sweep_h5(const std::filesystem::path& file, const Sweep& sweep, const SweepDescription& description) {
  silence_hdf5();
  WholeFile whole(file, next_name(file));
  Hdf5Handle id(H5Fcreate(whole.part().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                "create " + file.string());
  const Request& request = sweep.common().request;
  write_attribute(id, "hamflow", description.version);
  write_attribute(id, "host", description.host);
  write_attribute(id, "problem", request.problem);
  write_attribute(id, "arithmetic", request.arithmetic);
  write_attribute(id, "kernel", request.kernel);
  if (request.kernel == "fast") {
    write_attribute(id, "instruction_set", std::string(name(fast_kernel_instruction_set())));
  }
  write_text_dataset(id, "scenario", sweep.text());
  for (const SweepColumn& column : columns_of(sweep)) write_column(id, column);
  for (const SweepColumn& column : section_columns_of(sweep)) write_column(id, column);
  id.close_now("write " + file.string() + " (is the disk full?)");
  whole.put_in_place();
}

namespace {

/// A text with commas, quotes or line ends as CSV has it.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + "\"";
}

std::string cell(const SweepColumn& column, std::size_t at) {
  if (!column.texts.empty()) return quoted(column.texts[at]);
  if (!column.counts.empty()) return std::to_string(column.counts[at]);
  return fmt::format("{:.17g}", column.numbers[at]);
}

/// @throws FileError
void write_csv(const std::filesystem::path& file, const std::vector<SweepColumn>& columns) {
  WholeFile whole(file, next_name(file));
  std::ofstream out(whole.part());
  if (!out) throw FileError("cannot write " + file.string());
  std::vector<std::string> labels;
  for (const SweepColumn& column : columns) {
    for (std::size_t i = 0; i < column.width; ++i) labels.push_back(quoted(csv_name(column, i)));
  }
  out << joined(labels, ",") << '\n';
  for (std::size_t row = 0; row < columns[0].rows(); ++row) {
    std::vector<std::string> cells;
    for (const SweepColumn& column : columns) {
      for (std::size_t i = 0; i < column.width; ++i) cells.push_back(cell(column, row * column.width + i));
    }
    out << joined(cells, ",") << '\n';
  }
  out.close();
  if (!out) throw FileError("cannot write " + file.string() + " (is the disk full?)");
  whole.put_in_place();
}

}  // namespace

std::string csv_name(const SweepColumn& column, std::size_t i) {
  const std::string varied = "varied/", section = "section/";
  std::string name = column.name;
  for (const std::string& table : {varied, section}) {
    if (name.starts_with(table)) name = name.substr(table.size());
  }
  return name + (column.scalar ? "" : std::to_string(i + 1));
}

void write_sweep_csv(const std::filesystem::path& folder, const Sweep& sweep) {
  // Each column with all its digits, where there are more than those of a double. What was varied stays a number.
  std::vector<SweepColumn> columns = columns_of(sweep);
  const std::string beyond_double = "digits/";
  for (SweepColumn& column : columns) {
    for (const SweepColumn& other : columns) {
      const bool varied = column.name.starts_with("varied/");
      if (!varied && other.name == beyond_double + column.name) column.texts = other.texts;
    }
  }
  std::erase_if(columns, [&](const SweepColumn& column) { return column.name.starts_with(beyond_double); });
  write_csv(folder / "sweep.csv", columns);
  if (sweep.common().section) write_csv(folder / "section.csv", section_columns_of(sweep));
}

}  // namespace hamflow
