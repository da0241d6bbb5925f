// **Parameter map**: one number of every member of a sweep over the keys that were varied: a curve over one key, a
// coloured plane over two, or a curve for each value of a key that has words or few values.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

constexpr std::size_t most_map_lines = 24;

struct ParameterMap {
  std::string title;
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;  // empty: one key is drawn over
  std::string value_label;
  std::vector<double> x;             // one entry per member; y varies fastest
  std::vector<double> y;             // empty: one key
  std::vector<double> value;         // NaN: none
  std::vector<std::string> x_words;  // names of x = 0, 1, 2, ...; empty: x are numbers
  std::vector<std::string> line;     // of each member, the name of its curve; empty: one curve
  std::vector<std::string> notes;    // below the map
  std::vector<double> error{};       // of each value, a bar up and down; empty: none, as where y is not
};

/// Writes svg, pdf or png by the extension of `file`. Values that are all positive and span more than two decades are
/// coloured by their logarithm.
/// @throws Error when the extension or the data do not fit   @throws FileError when gnuplot or the file fails
void write_parameter_map(const ParameterMap& map, const std::filesystem::path& file);

}  // namespace hamflow
