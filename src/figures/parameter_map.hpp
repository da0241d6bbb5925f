// **Parameter map**: one number for each member of a sweep over the varied keys. It is a curve over one key, a coloured
// plane over two keys, or one curve for each value of a key that has words or few values.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

constexpr std::size_t most_map_lines = 24;

struct ParameterMap {
  std::string title;
  std::string x_label;  // enhanced text, like every label here
  std::string y_label;  // empty: there is only one key
  std::string value_label;
  std::vector<double> x;             // one entry for each member; y varies fastest
  std::vector<double> y;             // empty: there is only one key
  std::vector<double> value;         // NaN: there is no value
  std::vector<std::string> x_words;  // labels at x = 0, 1, 2, ...; empty: x are numbers
  std::vector<std::string> line;     // name of the curve to which each member belongs; empty: there is one curve
  std::vector<std::string> notes;    // lines below the map
  std::vector<double> error{};       // error bar of each value; empty: there are none, as with two keys
};

/// Writes SVG, PDF or PNG, by the extension of `file`. If all values are positive and span more than two decades, their
/// logarithms determine the colours.
/// @throws Error if the extension or the data do not fit   @throws FileError if gnuplot or writing fails
void write_parameter_map(const ParameterMap& map, const std::filesystem::path& file);

}  // namespace hamflow
