// What several kinds of figures draw alike: tracks, curves over time, axes of one scale, names of energies.
#pragma once

#include <string>
#include <vector>

#include "figure.hpp"
#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/curves.hpp"
#include "hamflow/figures/page.hpp"
#include "hamflow/figures/panel_axes.hpp"
#include "ink.hpp"

namespace hamflow::figures {

constexpr std::size_t most_separate_dots = 40;  // on a line over a page; more would run into each other
inline const std::string energy_name = "{/:Italic H}";
inline const std::string energy_of_time =
    " − ∫ ∂{/:Italic H}/∂{/:Italic t d}{/:Italic t}";  // follows it for H(q, p, t)
inline const std::string energy_start = "{/:Italic H}_0";

/// How the n-th of `count` runs is drawn, with its name in the legend; one alone has none.
Series series_of(const Figure& figure, std::size_t run);

/// The samples of a path: a line where chords follow it, else dots.
Series track_of(const Curve& track, Series how);
/// Whether the first steps that are drawn for a run are all of its steps.
bool is_whole_run(const FigureSamples& first_steps, const FigureData& data);
/// Lines over the first steps of runs, in place of lines over samples that lie too far apart.
struct Openings {
  bool whole_run = false;  // no sample is behind them
  bool any = false;        // whether they were drawn
};
/// Those of a figure, before any is drawn.
Openings openings_of(const Figure& figure);
/// The paths of one panel. Where no line follows any of them, but one follows the first_steps of each, these are drawn
/// over the samples as dots, and `drawn.any` becomes true: a note about the first steps holds for all paths or for
/// none.
/// @param how one for each track   @param openings one for each track, empty where unknown
std::vector<Series> tracks_of(const std::vector<Curve>& tracks, const std::vector<Curve>& openings,
                              std::vector<Series> how, Openings& drawn);
/// What is drawn in place of samples may reach further than they do.
void include_drawn(const std::vector<Series>& drawn, Extent& x, Extent& y);
/// "line: the first steps, to t = 12 of 300", of figures with first_steps; nothing where that is all of the run.
void note_opening(Page& page, const FigureData& data);
/// "lines join 3 samples": of lines over samples between which the motion is another one than their chords.
std::string joined_note(std::size_t samples);
/// Whether a curve over time turns back from sample to sample, or has a few samples alone. Turns of a tenth of its
/// range count: rounding is none.
bool is_sparse(const std::vector<double>& y);
/// Dots about a millimetre apart in print, so that the exact line shows between them.
Curve dots_on_line(const Curve& track, const Panel& panel);

/// One line over all samples, or the field that they fill where they are too many for a line; dots as well while they
/// can be told apart.
void add_over_time(Panel& panel, const std::vector<double>& t, const std::vector<double>& y, Series how);

/// H of the first sample, 0 without samples.
double start_of(const std::vector<double>& energy);
/// max(|H0|, |T0| + |V0|), 1 where it is none.
double scale_of(const FigureData& data);
/// Those that all runs of a figure share.
FigureUnits units_of(const Figure& figure);
/// "x in AU"; the label alone where there is no unit.
std::string in_unit(const std::string& label, const std::string& unit);
/// The time, with its unit.
std::string time_label(const Figure& figure);
/// The scale as a symbol; empty where it is 1.
std::string scale_name(const FigureData& data);
/// (H - H0)/scale at every sample. Where the difference overflows the quotient need not.
std::vector<double> relative_energy_error(const FigureData& data);
/// (H - H0)/|H0|, in symbols.
std::string energy_error_label(const FigureData& data);

/// "there is no sample with a finite position".
std::string no_samples(const std::string& quantity);

}  // namespace hamflow::figures
