// What files of runs and of sweeps have in common: texts and attributes in UTF-8, groups, and how a file is made.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hdf5_read.hpp"

namespace hamflow {

/// A text of `length` bytes, at least one. Shorter texts end with a zero byte.
Hdf5Handle text_type(std::size_t length);

void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, double x);
void write_attribute(hid_t object, const std::string& name, const std::vector<double>& numbers);
/// An array of texts of one length, at least one.
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& texts);

/// A dataset that holds one text, and its hash as the attribute `fnv1a`, by which damage is found when it is read.
void write_text_dataset(hid_t file, const std::string& name, const std::string& text);
std::string read_text_dataset(hid_t file, const std::string& name);

Hdf5Handle make_group(hid_t file, const std::string& name);

/// Creates a new file in the place of what had its name, in the latest format, which the single-writer mode needs. What
/// fills most of a page of memory lies on one page. @throws FileError
Hdf5Handle create_hdf5(const std::filesystem::path& path);
/// The same in the usual format, which older programs read too. @throws FileError
Hdf5Handle create_hdf5_in_usual_format(const std::filesystem::path& path);

}  // namespace hamflow
