// Columns of a run by name: time, coordinates, momenta, energy, and others.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// Sort of a quantity. Columns of the same sort have the same unit and can share an axis.
enum class Sort { time, position, angle, momentum, angular_momentum, energy, energy_error, other };

struct Column {
  std::string name;   // as --x and --y accept it
  std::string label;  // enhanced text
  Sort sort = Sort::other;
  // returns values of the data from which the column was made; valid as long as these exist
  std::function<std::vector<double>()> values;
};

/// Returns the unit of a sort in a figure.
std::string unit_of(const Figure& figure, Sort sort);
/// Returns the label of a column with its unit.
std::string axis_label(const Figure& figure, const Column& column);
/// Returns all columns that can be drawn over each other: t, coordinates, momenta, energy, energy-error, observables,
/// invariants, diagnostics.
std::vector<Column> columns_of(const FigureData& data);
std::vector<std::string> column_names(const FigureData& data);
/// @throws Error if no column has that name
Column column_of(const FigureData& data, const std::string& name);

}  // namespace hamflow::figures
