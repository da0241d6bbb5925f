// Panels whose axes fit their data, and marks that tell many series apart.
#pragma once

#include <cstddef>
#include <string>

#include "hamflow/figures/page.hpp"

namespace hamflow::figures {

constexpr double padding = 0.06;  // between data and frame, a fraction of the range

/// A panel over time, or over another quantity that grows; the y-axis is left to the caller.
Panel panel_over(const Extent& times, const std::string& label);
/// Both axes with one scale: the box takes the shape of the data, within limits.
void fit_equal_axes(Panel& panel, const Extent& x, const Extent& y);

/// Colours that differ in hue and in grey, the first that of a figure of one run; they repeat after eight.
std::string colour_of(std::size_t place);
/// The colour of a series, its own or that of its ink.
std::string colour_of(const Series& series);
/// For the n-th of many series: its colour, and dashes where colours repeat.
Mark mark_of(std::size_t place);

}  // namespace hamflow::figures
