// Reads time and energy from a log of any program: text in columns, a log of LAMMPS, or HDF5.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct LogColumns {
  std::vector<double> time;
  std::vector<double> energy;
  std::vector<std::size_t> lines{};  // line of each sample, counted from 1; empty for HDF5
  std::size_t tables = 1;            // number of tables in a log of LAMMPS; the last one is read
  std::size_t cut_line = 0;          // last line, left out because it was cut; 0: there is none
};

/// Reads the columns that `--time` and `--energy` name.
/// - Text: numbers separated by commas, semicolons, or blanks. Names are in the first row, or in the last comment above
///   it; columns also have numbers, counted from 1. Lines that begin with #, %, @ or ! are comments.
/// - log.lammps: the rows between a line that begins with "Step" and "Loop time". If there are several tables, the last
///   one with at least two rows is read, because the others are different runs, such as a minimisation or an
///   equilibration.
/// - HDF5: the path of a dataset, "samples/t"; "samples/q:2" is its second column.
///
/// A last line without line end is left out if it has fewer columns than the others. In a table of LAMMPS it is always
/// left out, because LAMMPS ends every line, so a number in it may be cut.
/// @throws FileError if the file cannot be read, Rejection with line and column if it is not such a log
LogColumns read_log_columns(const std::filesystem::path& file, const std::string& time, const std::string& energy);

}  // namespace hamflow
