// Panels whose axes fit their data, and marks that distinguish many series.
#pragma once

#include <cstddef>
#include <string>

#include "hamflow/figures/page.hpp"

namespace hamflow::figures {

constexpr double padding = 0.06;  // margin between data and frame, as a fraction of the range

/// Makes a panel over time or another quantity that grows. The caller sets the y-axis.
Panel panel_over(const Extent& times, const std::string& label);
/// Sets both axes with the same scale. The box gets the shape of the data, within limits.
void fit_equal_axes(Panel& panel, const Extent& x, const Extent& y);

/// Returns colours that differ in hue and in brightness. The first is the colour of a figure of one run. They repeat
/// after eight.
std::string colour_of(std::size_t place);
/// Returns the colour of a series: its own, or that of its ink.
std::string colour_of(const Series& series);
/// Returns the mark of the n-th of many series: its colour, and a dash pattern if colours repeat.
Mark mark_of(std::size_t place);

}  // namespace hamflow::figures
