// What several kinds of figures draw alike: samples, curves over time, axes of one scale, names of energies.
#pragma once

#include <string>
#include <vector>

#include "axis.hpp"
#include "curves.hpp"
#include "figure.hpp"
#include "page.hpp"

namespace hamflow::figures {

constexpr double padding = 0.06;                // between data and frame, a fraction of the range
constexpr std::size_t most_separate_dots = 40;  // on a line over a page; more would run into each other
inline const std::string energy_name = "{/:Italic H}";
inline const std::string energy_start = "{/:Italic H}_0";

/// Samples without an exact curve: dots, or a line where there are many and the chords between them show the path.
Series samples(const Curve& track);
/// Dots about a millimetre apart in print, so that the exact line shows between them.
Curve dots_on_line(const Curve& track, const Panel& panel);
/// Over time: one line over all samples; dots as well while they can be told apart. The y-axis is left to the caller.
Panel over_time(const std::vector<double>& t, const std::vector<double>& y);
/// Both axes with one scale: the box takes the shape of the data, within limits.
void fit_equal_axes(Panel& panel, const Extent& x, const Extent& y);

/// H of the first sample, 0 without samples.
double start_of(const std::vector<double>& energy);
/// max(|H0|, |T0| + |V0|), 1 where it is none.
double scale_of(const FigureData& data);
/// The scale as a symbol; empty where it is 1.
std::string scale_name(const FigureData& data);
/// (H - H0)/scale at every sample. Where the difference overflows the quotient need not.
std::vector<double> relative_energy_error(const FigureData& data);

/// "there is no sample with a finite position".
std::string no_samples(const std::string& quantity);

}  // namespace hamflow::figures
