#include "reverse_file.hpp"

#include <algorithm>

#include "hdf5_text.hpp"
#include "stored_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

void write_numbers(hid_t group, const char* name, const std::vector<double>& numbers) {
  const hsize_t size = numbers.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "make a dataspace");
  const Hdf5Handle data(H5Dcreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                        std::string("make ") + name);
  check_hdf5(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
             std::string("write ") + name);
}

void write_digits(hid_t group, const char* name, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::vector<char> bytes(texts.size() * length);
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::copy(texts[i].begin(), texts[i].end(), bytes.begin() + static_cast<std::ptrdiff_t>(i * length));
  const hsize_t size = texts.size();
  const Hdf5Handle type = digits_type(length);
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "make a dataspace");
  const Hdf5Handle data(H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                        std::string("make ") + name);
  check_hdf5(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), std::string("write ") + name);
}

void write_state(hid_t file, const std::string& name, const Frame& frame) {
  const Hdf5Handle group = make_group(file, name);
  write_attribute(group, "t", frame.time);
  write_attribute(group, "step", static_cast<double>(frame.step));
  write_numbers(group, "q", frame.q);
  write_numbers(group, "p", frame.p);
  if (frame.digits.q.empty()) return;
  const Hdf5Handle digits = make_group(file, name + "/digits");
  write_digits(digits, "q", frame.digits.q);
  write_digits(digits, "p", frame.digits.p);
}

}  // namespace

void write_reverse_file(const std::filesystem::path& file, const std::string& scenario, const Frame& start,
                        const Frame& turn, const Frame* end) {
  silence_hdf5();
  WholeFile whole(file, next_name(file));
  {
    Hdf5Handle h5 = create_hdf5(whole.part());
    write_format(h5);
    write_text_dataset(h5, "scenario", scenario);
    write_state(h5, "start", start);
    write_state(h5, "turn", turn);
    if (end != nullptr) write_state(h5, "end", *end);
    h5.close_now("write " + file.string());
  }
  whole.put_in_place();
}

}  // namespace hamflow
