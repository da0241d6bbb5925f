// What files of runs and of sweeps have alike: texts and attributes in UTF-8, groups, and how a file is opened.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hdf5_handle.hpp"

namespace hamflow {

/// HDF5 prints its error stack by default; our messages say what failed.
void silence_hdf5();

/// A text of `length` bytes, at least one. Shorter texts end with a zero byte.
Hdf5Handle text_type(std::size_t length);

void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, double x);
void write_attribute(hid_t object, const std::string& name, const std::vector<double>& numbers);
/// An array of texts of one length, at least one.
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& texts);
/// Empty where there is no such attribute.
std::string read_attribute(hid_t object, const std::string& name);

/// A dataset that holds one text.
void write_text_dataset(hid_t file, const std::string& name, const std::string& text);
std::string read_text_dataset(hid_t file, const std::string& name);

Hdf5Handle make_group(hid_t file, const std::string& name);

/// Creates a file, or replaces one, in the latest format, which the single-writer mode needs. What fills most of a page
/// of memory lies on one page.
Hdf5Handle create_hdf5(const std::filesystem::path& path);
/// Opens what a writer has open or a crash has left. A reader beside a writer may meet metadata half written and tries
/// again, each time twice as long after. HDF5's own 100 attempts would wait for ever on a damaged file; 24 are over in
/// a few hundredths of a second each.
Hdf5Handle open_to_read(const std::filesystem::path& path);

}  // namespace hamflow
