// Writes columns of numbers to an HDF5 file, for programs that store curves of their own.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace hamflow {

/// Columns of one group; their lengths may differ.
struct ColumnGroup {
  std::string name;
  std::vector<std::pair<std::string, std::vector<double>>> columns;
};

/// Contents of the file: attributes, texts, and groups of columns.
struct ColumnsFile {
  std::vector<std::pair<std::string, std::string>> attributes;  // names and values, for the root group
  std::vector<std::pair<std::string, std::string>> texts;       // each a dataset of one string
  std::vector<ColumnGroup> groups;                              // each column a dataset of doubles
};

/// Writes the whole file; if that fails, the old file is kept. Names must differ within a group. @throws FileError
void write_columns(const std::filesystem::path& file, const ColumnsFile& contents);

}  // namespace hamflow
