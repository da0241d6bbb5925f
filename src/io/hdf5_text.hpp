// Texts and attributes in UTF-8, groups, and creation of files, for files of runs and of sweeps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hdf5_read.hpp"

namespace hamflow {

/// The type of a text of `length` bytes, at least one. Shorter texts end with a zero byte.
Hdf5Handle text_type(std::size_t length);

void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, double x);
void write_attribute(hid_t object, const std::string& name, const std::vector<double>& numbers);
/// Writes an array of texts with the same length.
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& texts);

/// Writes the version of the format of hamflow's files as the attribute `format` of a file.
void write_format(hid_t file);

/// Writes a dataset that holds one text, with its hash in the attribute `fnv1a`, so that damage is found when it is
/// read.
void write_text_dataset(hid_t file, const std::string& name, const std::string& text);
std::string read_text_dataset(hid_t file, const std::string& name);

Hdf5Handle make_group(hid_t file, const std::string& name);

/// Creates a file in place of any file of that name, in the latest format, which single-writer mode needs. Objects that
/// fill most of a memory page are aligned to a page. @throws FileError
Hdf5Handle create_hdf5(const std::filesystem::path& path);
/// The same in the usual format, which older programs can read, too. @throws FileError
Hdf5Handle create_hdf5_in_usual_format(const std::filesystem::path& path);

}  // namespace hamflow
