#include "hamflow/workflow/columns_file.hpp"

#include "hdf5_text.hpp"
#include "whole_file.hpp"

namespace hamflow {

void write_columns(const std::filesystem::path& file, const ColumnsFile& contents) {
  silence_hdf5();
  WholeFile whole(file, next_name(file));
  Hdf5Handle id = create_hdf5_in_usual_format(whole.part());
  for (const auto& [name, text] : contents.attributes) write_attribute(id, name, text);
  for (const auto& [name, text] : contents.texts) write_text_dataset(id, name, text);
  for (const ColumnGroup& each : contents.groups) {
    const Hdf5Handle group = make_group(id, each.name);
    for (const auto& [name, numbers] : each.columns) {
      const hsize_t size = numbers.size();
      const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "describe " + name);
      const Hdf5Handle set(
          H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
          "create " + name);
      check_hdf5(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "write " + name);
    }
  }
  id.close_now("write " + file.string() + " (is the disk full?)");
  whole.put_in_place();
}

}  // namespace hamflow
