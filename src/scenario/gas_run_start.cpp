// Reads the particles of a gas from the file of a run.
#include <algorithm>
#include <fstream>

#include "file_format.hpp"
#include "gas_start.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "hdf5_lock.hpp"
#include "hdf5_read.hpp"

namespace hamflow {

namespace {

/// Returns the shape of a dataset; empty if it does not exist or holds a single value.
std::vector<hsize_t> shape_of(hid_t file, const std::string& name) {
  return has_object(file, name) ? StoredData::dataset(file, name).shape() : std::vector<hsize_t>();
}

/// Returns the numbers of a state, with all digits if the run has more digits than double.
/// @param digits dataset of the digits; empty: there is none
std::vector<std::string> numbers_of(hid_t file, const std::string& name, const std::string& digits, hsize_t row) {
  if (!digits.empty() && has_object(file, digits)) return StoredData::dataset(file, digits).texts_of_row(row);
  std::vector<std::string> texts;
  for (const double x : StoredData::dataset(file, name).numbers_of_row(row)) texts.push_back(shortest(x));
  return texts;
}

/// Place of a state in the file.
struct StoredState {
  std::string q;
  std::string p;
  hsize_t row = 0;
  hsize_t numbers = 0;
  hsize_t dimension = 0;  // 0: all numbers are in one row
};

/// Returns the H5MD datasets of a gas, or /q and /p.
StoredState place_of(hid_t file, const std::filesystem::path& path, RunState which) {
  const std::vector<hsize_t> times = shape_of(file, "t");
  StoredState place{"particles/all/position/value", "particles/all/momentum/value", 0, 1};
  if (shape_of(file, place.q).empty()) place = {"q", "p", 0, 1};
  if (which == RunState::start && !shape_of(file, "particles/start/position/value").empty()) {
    place = {"particles/start/position/value", "particles/start/momentum/value", 0, 1};
  } else if (which == RunState::last && times.size() == 1 && times[0] > 0) {
    place.row = times[0] - 1;
    for (const char* const digits : {"digits/q", "digits/p"}) {  // after a kill they may have one row less
      const std::vector<hsize_t> rows = shape_of(file, digits);
      if (!rows.empty() && rows[0] > 0) place.row = std::min(place.row, rows[0] - 1);
    }
  }
  const std::vector<hsize_t> states = shape_of(file, place.q);
  if (times.size() != 1 || times[0] == 0 || states.size() < 2 || shape_of(file, place.p) != states ||
      place.row >= states[0]) {
    throw Error("found no samples /t and /particles/all, or /q, /p, in " + path.string() +
                "; allowed the run.h5 of a run with samples");
  }
  for (std::size_t k = 1; k < states.size(); ++k) place.numbers *= states[k];
  if (states.size() == 3) place.dimension = states[2];
  return place;
}

/// Returns the masses of an n-body run; empty if the file has none.
std::vector<double> masses_of_bodies(hid_t file) {
  if (H5Aexists(file, "masses") <= 0) return {};
  return StoredData::attribute(file, "masses").numbers();
}

/// Refuses particles in a space of another dimension, whose numbers would be read as other particles.
void check_dimension(hid_t file, const StoredState& place, std::size_t space, const std::string& path) {
  hsize_t dimension = place.dimension;
  if (dimension == 0) {
    const std::size_t bodies = masses_of_bodies(file).size();
    if (bodies == 0) {
      throw Error("found in " + path + " a run without bodies, whose states have " + std::to_string(place.numbers) +
                  " numbers; allowed the run.h5 of a gas or of n-body");
    }
    if (bodies > 1 && place.numbers % bodies == 0) dimension = place.numbers / bodies;
  }
  if (dimension != 0 ? dimension != space : place.numbers % space != 0) {
    throw Error("found particles in " +
                (dimension != 0 ? std::to_string(dimension) + " dimensions"
                                : "states of " + std::to_string(place.numbers) + " numbers") +
                " in " + path + "; allowed problem.dimension = " + std::to_string(space) +
                (dimension == 2 || dimension == 3 ? ", or the dimension of the file" : ""));
  }
}

/// Returns one mass for each particle, or a single one if all are equal; empty if the file has none.
std::vector<std::string> masses_in(hid_t file, hsize_t particles) {
  const char* const of_gas = "particles/all/mass/value";
  std::vector<double> masses =
      has_object(file, of_gas) ? StoredData::dataset(file, of_gas).numbers_of_row(0) : masses_of_bodies(file);
  if (masses.size() != particles && masses.size() != 1) return {};
  if (std::all_of(masses.begin(), masses.end(), [&](double m) { return m == masses[0]; })) masses.resize(1);
  std::vector<std::string> texts;
  for (const double m : masses) texts.push_back(shortest(m));
  return texts;
}

}  // namespace

GasStart gas_from_run(const std::filesystem::path& file, std::size_t space, RunState which) {
  const auto alone = lock_hdf5();
  silence_hdf5();
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none) || !std::ifstream(file).good()) {
    throw Error("cannot read the file " + file.string() + "; allowed a run.h5, or a CSV");
  }
  try {
    const Hdf5Handle h5 = open_to_read(file);
    const StoredState place = place_of(h5, file, which);
    check_dimension(h5, place, space, file.string());
    GasStart start;
    const bool sampled = place.q.find("start") == std::string::npos;
    start.q = numbers_of(h5, place.q, sampled ? "digits/q" : "", place.row);
    start.p = numbers_of(h5, place.p, sampled ? "digits/p" : "", place.row);
    if (start.q.size() != place.numbers || start.p.size() != place.numbers) {
      throw FileError("HDF5: states and their digits differ in length");
    }
    start.masses = masses_in(h5, place.numbers / space);
    return start;
  } catch (const OtherFormat& error) {
    throw Error(error.what());
  } catch (const FileError& error) {
    throw Error("found " + file.string() + ", which is damaged or not an HDF5 file (" + error.what() +
                "); allowed a complete run.h5, or a CSV");
  } catch (const std::bad_alloc&) {
    throw Error("found " + file.string() + ", which states an impossible size; allowed a complete run.h5, or a CSV");
  }
}

bool is_in_run_file(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;
  const auto alone = lock_hdf5();
  silence_hdf5();
  return H5Fis_hdf5(file.c_str()) > 0;
}

}  // namespace hamflow
