// Columns of a run by name: time, coordinates, momenta, energy.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// What is drawn on one axis with what: columns of one sort have one unit.
enum class Sort { time, position, angle, momentum, angular_momentum, energy, energy_error, other };

struct Column {
  std::string name;   // as --x and --y take it
  std::string label;  // enhanced text
  Sort sort = Sort::other;
  std::function<std::vector<double>()> values;  // of the data that it was made of, as long as they live
};

/// Of a column of one of the runs of a figure.
std::string unit_of(const Figure& figure, Sort sort);
/// Its label with its unit.
std::string axis_label(const Figure& figure, const Column& column);
/// All that can be drawn over each other: t, coordinates, momenta, energy, energy-error, observables,
/// invariants, diagnostics.
std::vector<Column> columns_of(const FigureData& data);
/// Their names.
std::vector<std::string> column_names(const FigureData& data);
/// @throws Error where there is none of that name
Column column_of(const FigureData& data, const std::string& name);

}  // namespace hamflow::figures
