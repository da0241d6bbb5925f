#include "run_identity.hpp"

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
    if (text_attribute(in, "run") != identity) return "it belongs to another run";
    const std::size_t found = StoredData::dataset(in, "t").rows();
    if (found >= rows) return {};
    return fmt::format("it has {} samples, but the checkpoint needs {}", found, rows);
  } catch (const FileError& error) {
    return std::string("it cannot be read: ") + error.what();
  }
}

}  // namespace hamflow
