#include "run_mark.hpp"

#include <fmt/format.h>

#include <random>

#include "hdf5_text.hpp"

namespace hamflow {

std::string new_identity() {
  std::random_device random;
  std::string identity;
  for (int i = 0; i < 4; ++i) identity += fmt::format("{:08x}", random());
  return identity;
}

std::string refused_run_file(const std::filesystem::path& file, const std::string& identity, std::uint64_t rows) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return "it is gone";
  silence_hdf5();
  try {
    const Hdf5Handle in = open_to_read(file);
    if (read_attribute(in, "run") != identity) return "it is of another run";
    const Hdf5Handle times(H5Dopen2(in, "t", H5P_DEFAULT), H5Dclose, "open dataset t");
    const Hdf5Handle space(H5Dget_space(times), H5Sclose, "open the space of t");
    const hssize_t found = H5Sget_simple_extent_npoints(space);
    if (found >= 0 && static_cast<std::uint64_t>(found) >= rows) return {};
    return fmt::format("it has {} samples, not the {} that the checkpoint counts", found, rows);
  } catch (const FileError& error) {
    return std::string("it cannot be read: ") + error.what();
  }
}

}  // namespace hamflow
