// The particles of a gas as a run left them.
#include <hdf5.h>

#include <algorithm>

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

/// Row `row` of a dataset of rank 2, or the length of one of rank 1 and more; nothing where it is not there.
std::vector<hsize_t> shape_of(hid_t file, const char* name) {
  const Open data(H5Lexists(file, name, H5P_DEFAULT) > 0 ? H5Dopen2(file, name, H5P_DEFAULT) : -1, H5Dclose);
  if (data.id < 0) return {};
  const Open space(H5Dget_space(data.id), H5Sclose);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id))));
  (void)H5Sget_simple_extent_dims(space.id, shape.data(), nullptr);
  return shape;
}

std::vector<double> row_of(hid_t file, const char* name, hsize_t row, hsize_t width) {
  const Open data(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  const Open space(H5Dget_space(data.id), H5Sclose);
  const hsize_t first[2] = {row, 0};
  const hsize_t count[2] = {1, width};
  const Open memory(H5Screate_simple(1, &width, nullptr), H5Sclose);
  std::vector<double> numbers(width);
  const bool read = H5Sselect_hyperslab(space.id, H5S_SELECT_SET, first, nullptr, count, nullptr) >= 0 &&
                    H5Dread(data.id, H5T_NATIVE_DOUBLE, memory.id, space.id, H5P_DEFAULT, numbers.data()) >= 0;
  return read ? numbers : std::vector<double>();
}

}  // namespace

GasStart gas_from_run(const std::filesystem::path& file, std::size_t space) {
  const auto alone = alone_with_hdf5();
  (void)H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what failed is said below
  const auto open = [&](unsigned flags) { return H5Fopen(file.c_str(), flags, H5P_DEFAULT); };
  const hid_t plain = open(H5F_ACC_RDONLY);
  const Open h5(plain >= 0 ? plain : open(H5F_ACC_RDONLY | H5F_ACC_SWMR_READ), H5Fclose);
  if (h5.id < 0) throw Error("found no file " + file.string() + " that can be read; allowed a run.h5, or a CSV");
  const std::vector<hsize_t> times = shape_of(h5.id, "t");
  const std::vector<hsize_t> states = shape_of(h5.id, "q");
  if (times.size() != 1 || states.size() != 2 || shape_of(h5.id, "p") != states || times[0] == 0 ||
      times[0] > states[0]) {
    throw Error("found no samples /t, /q, /p in " + file.string() + "; allowed the run.h5 of a run that kept some");
  }
  if (states[1] % space != 0) {
    throw Error("found states of " + std::to_string(states[1]) + " numbers in " + file.string() + "; allowed " +
                std::to_string(space) + " for each particle");
  }
  GasStart start;
  for (const double x : row_of(h5.id, "q", times[0] - 1, states[1])) start.q.push_back(shortest(x));
  for (const double x : row_of(h5.id, "p", times[0] - 1, states[1])) start.p.push_back(shortest(x));
  if (start.q.size() != states[1] || start.p.size() != states[1]) {
    throw Error("found samples in " + file.string() + " that cannot be read; allowed a whole run.h5");
  }
  return start;
}

}  // namespace hamflow
