// compare_runs A.h5 B.h5: whether two files hold the same datasets, bit for bit. Names those that differ, with
// status 1. compare_runs --scenario A.h5 prints the scenario that a run was given, --unprotected A.h5 the datasets of
// rows that have no checksum, --numbers=NAME A.h5 the numbers of a dataset.
#include <cstring>
#include <iostream>
#include <map>
#include <vector>

#include "hdf5_text.hpp"

namespace {

using hamflow::check_hdf5;
using hamflow::Hdf5Handle;

struct Content {
  std::vector<hsize_t> size;
  std::vector<char> bytes;
  bool operator==(const Content&) const = default;
};
using Contents = std::map<std::string, Content>;

Content read(hid_t file, const char* name) {
  const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "open a dataset");
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose, "read a type");
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open a space");
  Content content;
  content.size.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, content.size.data(), nullptr);
  content.bytes.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(type));
  if (!content.bytes.empty()) {
    check_hdf5(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.bytes.data()), "read a dataset");
  }
  return content;
}

std::vector<std::string> datasets_in(hid_t file) {
  std::vector<std::string> names;
  const auto note = [](hid_t, const char* name, const H5O_info_t* info, void* all) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
  };
  check_hdf5(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, note, &names, H5O_INFO_BASIC), "list the datasets");
  return names;
}

Contents contents(const char* path) {
  const Hdf5Handle file = hamflow::open_to_read(path);
  Contents all;
  for (const std::string& name : datasets_in(file)) all[name] = read(file, name.c_str());
  return all;
}

/// Of the datasets that have rows.
void print_unprotected(const char* path) {
  const Hdf5Handle file = hamflow::open_to_read(path);
  for (const std::string& name : datasets_in(file)) {
    const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
    const Hdf5Handle plist(H5Dget_create_plist(dataset), H5Pclose, "read a property list");
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open a space");
    if (H5Sget_simple_extent_ndims(space) > 0 && H5Pget_nfilters(plist) == 0) {
      std::cout << name << '\n';
    }
  }
}

void print_numbers(const char* path, const std::string& name) {
  const Hdf5Handle file = hamflow::open_to_read(path);
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open a space");
  std::vector<double> all(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (!all.empty()) {
    check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), "read a dataset");
  }
  std::cout.precision(17);
  for (const double x : all) std::cout << x << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: compare_runs A.h5 B.h5\n";
    return 2;
  }
  try {
    if (std::string(argv[1]) == "--scenario") {
      std::cout << hamflow::read_text_dataset(hamflow::open_to_read(argv[2]), "scenario");
      return 0;
    }
    if (std::string(argv[1]) == "--unprotected") {
      print_unprotected(argv[2]);
      return 0;
    }
    if (const std::string option = argv[1]; option.starts_with("--numbers=")) {
      print_numbers(argv[2], option.substr(option.find('=') + 1));
      return 0;
    }
    const Contents a = contents(argv[1]);
    const Contents b = contents(argv[2]);
    int different = a.size() == b.size() ? 0 : 1;
    for (const auto& [name, content] : a) {
      if (b.contains(name) && b.at(name) == content) continue;
      std::cout << name << " differs\n";
      ++different;
    }
    std::cout << a.size() << " datasets, " << (a.contains("t") ? a.at("t").bytes.size() / 8 : 0) << " rows, "
              << different << " differences\n";
    return different == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
