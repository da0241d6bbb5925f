// **Parameter map**: one number of every member of a sweep over the keys that were varied; a curve over one key, a
// coloured plane over two.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct ParameterMap {
  std::string title;
  std::string x_name;
  std::string y_name;  // empty: one key
  std::string value_name;
  std::vector<double> x;  // one entry per member; y varies fastest
  std::vector<double> y;
  std::vector<double> value;  // NaN: none
};

/// Writes svg, pdf or png by the extension of `file`. Values that are all positive and span more than two decades are
/// coloured by their logarithm.
/// @throws Error when the extension or the data do not fit   @throws FileError when gnuplot or the file fails
void write_parameter_map(const ParameterMap& map, const std::filesystem::path& file);

}  // namespace hamflow
