// Two columns of a log that any program has written: text in columns, a log of LAMMPS, or HDF5.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct LogColumns {
  std::vector<double> time;
  std::vector<double> energy;
  std::vector<std::size_t> lines{};  // of each sample, from 1; empty of HDF5
  std::size_t tables = 1;            // of a log of LAMMPS, of which the last one is read
  std::size_t cut_line = 0;          // a last line that was cut, and is left out; 0: there is none
};

/// The columns that `--time` and `--energy` name.
/// - Text: numbers separated by commas, semicolons, or blanks. The names are those of the first row, or of the last
///   comment above it; columns have numbers from 1, too. Lines that begin with #, %, @ or ! are comments.
/// - log.lammps: the rows between a line that begins with "Step" and "Loop time". Of several tables the last one with
///   at least two rows is read: those before it are other runs, such as a minimisation or an equilibration.
/// A last line without its end is left out where it has fewer columns than the others, and in a table of LAMMPS, which
/// ends each line: a number in it may be cut.
/// - HDF5: the path of a dataset, "samples/t"; "samples/q:2" is its second column.
/// @throws FileError where the file cannot be read, Rejection with line and column where it is no such log
LogColumns read_log_columns(const std::filesystem::path& file, const std::string& time, const std::string& energy);

}  // namespace hamflow
