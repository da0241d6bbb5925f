// The particles of a gas as a run left them.
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/gas_start.hpp"
#include "hdf5_alone.hpp"

namespace hamflow {

namespace {

/// Closes what it holds.
struct Open {
  hid_t id;
  herr_t (*close)(hid_t);
  Open(hid_t opened, herr_t (*closes)(hid_t)) : id(opened), close(closes) {}
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  ~Open() {
    if (id >= 0) close(id);
  }
};

/// The shape of a dataset; nothing where it is not there.
std::vector<hsize_t> shape_of(hid_t file, const std::string& name) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1)) {
    if (H5Lexists(file, name.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return {};
  }
  const Open data(H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0 ? H5Dopen2(file, name.c_str(), H5P_DEFAULT) : -1,
                  H5Dclose);
  if (data.id < 0) return {};
  const Open space(H5Dget_space(data.id), H5Sclose);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id))));
  (void)H5Sget_simple_extent_dims(space.id, shape.data(), nullptr);
  return shape;
}

/// Row `row` of a dataset of any rank, in a type of memory; nothing where it cannot be read.
std::vector<char> bytes_of(hid_t file, const std::string& name, hsize_t row, hid_t type) {
  std::vector<hsize_t> count = shape_of(file, name);
  if (count.empty() || row >= count[0]) return {};
  std::vector<hsize_t> first(count.size(), 0);
  first[0] = row;
  count[0] = 1;
  hsize_t width = 1;
  for (const hsize_t n : count) width *= n;
  const Open data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Open space(H5Dget_space(data.id), H5Sclose);
  const Open memory(H5Screate_simple(1, &width, nullptr), H5Sclose);
  std::vector<char> bytes(width * H5Tget_size(type));
  const bool read = H5Sselect_hyperslab(space.id, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr) >= 0 &&
                    H5Dread(data.id, type, memory.id, space.id, H5P_DEFAULT, bytes.data()) >= 0;
  return read ? bytes : std::vector<char>();
}

std::vector<double> row_of(hid_t file, const std::string& name, hsize_t row) {
  const std::vector<char> bytes = bytes_of(file, name, row, H5T_NATIVE_DOUBLE);
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

/// Texts of fixed length, without what fills them.
std::vector<std::string> texts_of(hid_t file, const std::string& name, hsize_t row) {
  if (shape_of(file, name).empty()) return {};
  const Open data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Open type(H5Dget_type(data.id), H5Tclose);
  if (H5Tget_class(type.id) != H5T_STRING || H5Tis_variable_str(type.id) != 0) return {};
  const std::vector<char> bytes = bytes_of(file, name, row, type.id);
  const std::size_t length = H5Tget_size(type.id);
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < bytes.size(); at += length) {
    const std::string text(bytes.data() + at, length);
    texts.push_back(text.substr(0, text.find_first_of(std::string(" \0", 2))));
  }
  return texts;
}

/// The numbers of a state: of a run beyond double with all digits.
/// @param digits where they stand, if the run has some
std::vector<std::string> numbers_of(hid_t file, const std::string& name, const std::string& digits, hsize_t row) {
  if (!digits.empty() && !shape_of(file, digits).empty()) return texts_of(file, digits, row);
  std::vector<std::string> texts;
  for (const double x : row_of(file, name, row)) texts.push_back(shortest(x));
  return texts;
}

/// Where a state of so many numbers stands.
struct Place {
  std::string q;
  std::string p;
  hsize_t row = 0;
  hsize_t numbers = 0;
  hsize_t dimension = 0;  // 0: the numbers stand in one row
};

/// H5MD of a gas, else /q and /p.
Place place_of(hid_t file, const std::filesystem::path& path, RunState which) {
  const std::vector<hsize_t> times = shape_of(file, "t");
  Place place{"particles/all/position/value", "particles/all/momentum/value", 0, 1};
  if (shape_of(file, place.q).empty()) place = {"q", "p", 0, 1};
  if (which == RunState::start && !shape_of(file, "particles/start/position/value").empty()) {
    place = {"particles/start/position/value", "particles/start/momentum/value", 0, 1};
  } else if (which == RunState::last && times.size() == 1 && times[0] > 0) {
    place.row = times[0] - 1;
    for (const char* const digits : {"digits/q", "digits/p"}) {  // of a run that was killed they may be a row behind
      const std::vector<hsize_t> rows = shape_of(file, digits);
      if (!rows.empty() && rows[0] > 0) place.row = std::min(place.row, rows[0] - 1);
    }
  }
  const std::vector<hsize_t> states = shape_of(file, place.q);
  if (times.size() != 1 || times[0] == 0 || states.size() < 2 || shape_of(file, place.p) != states ||
      place.row >= states[0]) {
    throw Error("found no samples /t and /particles/all, or /q, /p, in " + path.string() +
                "; allowed the run.h5 of a run that kept some");
  }
  for (std::size_t k = 1; k < states.size(); ++k) place.numbers *= states[k];
  if (states.size() == 3) place.dimension = states[2];
  return place;
}

/// Of an n-body run; empty where the file has none.
std::vector<double> masses_of_bodies(hid_t file) {
  std::vector<double> masses;
  if (H5Aexists(file, "masses") <= 0) return masses;
  const Open attribute(H5Aopen(file, "masses", H5P_DEFAULT), H5Aclose);
  const Open space(H5Aget_space(attribute.id), H5Sclose);
  masses.resize(static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.id))));
  if (masses.empty() || H5Aread(attribute.id, H5T_NATIVE_DOUBLE, masses.data()) < 0) masses.clear();
  return masses;
}

/// The particles of another dimension would be as many numbers, and no particles.
void check_dimension(hid_t file, const Place& place, std::size_t space, const std::string& path) {
  hsize_t dimension = place.dimension;
  if (dimension == 0) {
    const std::size_t bodies = masses_of_bodies(file).size();
    if (bodies == 0) {
      throw Error("found in " + path + " the run of a system without bodies, whose states have " +
                  std::to_string(place.numbers) + " numbers; allowed the run.h5 of a gas or of n-body");
    }
    if (bodies > 1 && place.numbers % bodies == 0) dimension = place.numbers / bodies;
  }
  if (dimension != 0 ? dimension != space : place.numbers % space != 0) {
    throw Error("found particles in " +
                (dimension != 0 ? std::to_string(dimension) + " dimensions"
                                : "states of " + std::to_string(place.numbers) + " numbers") +
                " in " + path + "; allowed problem.dimension = " + std::to_string(space) +
                (dimension == 2 || dimension == 3 ? ", or that of the file" : ""));
  }
}

/// One for each particle, or one for all where they are equal; nothing where the file has none.
std::vector<std::string> masses_in(hid_t file, hsize_t particles) {
  std::vector<double> masses = row_of(file, "particles/all/mass/value", 0);
  if (masses.empty()) masses = masses_of_bodies(file);
  if (masses.size() != particles && masses.size() != 1) return {};
  if (std::all_of(masses.begin(), masses.end(), [&](double m) { return m == masses[0]; })) masses.resize(1);
  std::vector<std::string> texts;
  for (const double m : masses) texts.push_back(shortest(m));
  return texts;
}

}  // namespace

GasStart gas_from_run(const std::filesystem::path& file, std::size_t space, RunState which) {
  const auto alone = alone_with_hdf5();
  (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what failed is said below
  const auto open = [&](unsigned flags) { return H5Fopen(file.c_str(), flags, H5P_DEFAULT); };
  const hid_t plain = open(H5F_ACC_RDONLY);
  const Open h5(plain >= 0 ? plain : open(H5F_ACC_RDONLY | H5F_ACC_SWMR_READ), H5Fclose);
  if (h5.id < 0) {
    std::error_code none;
    const bool is_there = std::filesystem::is_regular_file(file, none) && std::ifstream(file).good();
    throw Error(is_there
                    ? "found " + file.string() + ", which is damaged or no HDF5 file; allowed a whole run.h5, or a CSV"
                    : "found no file " + file.string() + " that can be read; allowed a run.h5, or a CSV");
  }
  const Place place = place_of(h5.id, file, which);
  check_dimension(h5.id, place, space, file.string());
  GasStart start;
  const bool sampled = place.q.find("start") == std::string::npos;
  start.q = numbers_of(h5.id, place.q, sampled ? "digits/q" : "", place.row);
  start.p = numbers_of(h5.id, place.p, sampled ? "digits/p" : "", place.row);
  if (start.q.size() != place.numbers || start.p.size() != place.numbers) {
    throw Error("found samples in " + file.string() + " that cannot be read; allowed a whole run.h5");
  }
  start.masses = masses_in(h5.id, place.numbers / space);
  return start;
}

bool is_in_run_file(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;
  const auto alone = alone_with_hdf5();
  (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return H5Fis_hdf5(file.c_str()) > 0;
}

}  // namespace hamflow
