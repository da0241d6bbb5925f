// Elements that several kinds of figures share: tracks, curves over time, axes with one scale, names of energies.
#pragma once

#include <string>
#include <vector>

#include "draw_style.hpp"
#include "figure.hpp"
#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/curves.hpp"
#include "hamflow/figures/page.hpp"
#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::figures {

constexpr std::size_t most_separate_dots = 40;  // dots on a line over a page; more would overlap
inline const std::string energy_name = "{/:Italic H}";
inline const std::string energy_of_time =
    " − ∫ ∂{/:Italic H}/∂{/:Italic t d}{/:Italic t}";  // follows energy_name if H depends on t
inline const std::string energy_start = "{/:Italic H}_0";

/// Returns how run number `run` is drawn, with its name in the legend. A single run has no name.
Series series_of(const Figure& figure, std::size_t run);

/// Returns the samples of a path, as a line if chords follow the path, otherwise as dots.
Series track_of(const Curve& track, Series how);
/// Returns whether the stored first steps of a run are all of its steps.
bool is_whole_run(const FigureSamples& first_steps, const FigureData& data);
/// Whether lines show the first steps of runs, in place of lines over samples that are too far apart.
struct FirstStepLines {
  bool whole_run = false;  // the first steps are the whole run
  bool any = false;        // such lines were drawn
};
/// Returns the state for a figure before any path is drawn.
FirstStepLines first_step_lines_of(const Figure& figure);
/// Draws the paths of one panel. If lines follow none of them, but follow the first_steps of each, these lines are
/// drawn over dots at the samples, and `drawn.any` becomes true. All paths are treated alike, so that a note about the
/// first steps holds for all of them.
/// @param how one for each track   @param openings first steps for each track, empty if unknown
std::vector<Series> tracks_of(const std::vector<Curve>& tracks, const std::vector<Curve>& openings,
                              std::vector<Series> how, FirstStepLines& drawn);
/// Extends x and y to the drawn series, which may reach further than the samples.
void include_drawn(const std::vector<Series>& drawn, Extent& x, Extent& y);
/// Adds a note such as "line: the first steps, to t = 12 of 300" to a figure with first_steps, unless these are the
/// whole run.
void note_first_steps(Page& page, const FigureData& data);
/// Returns a note such as "lines join 3 samples", for lines between samples that the motion does not follow.
std::string joined_note(std::size_t samples);
/// Returns whether a curve over time turns from sample to sample, or has only a few samples. Only turns of at least a
/// tenth of its range count, so rounding does not.
bool is_sparse(const std::vector<double>& y);
/// Returns dots about a millimetre apart in print, so that the exact line is visible between them.
Curve dots_on_line(const Curve& track, const Panel& panel);

/// Draws one line over all samples, or the area that they fill if there are too many for a line, and dots as long as
/// they can be distinguished.
void add_over_time(Panel& panel, const std::vector<double>& t, const std::vector<double>& y, Series how);

/// Returns H of the first sample; 0 without samples.
double start_of(const std::vector<double>& energy);
/// Returns max(|H0|, |T0| + |V0|); 1 if that is not a positive number.
double scale_of(const FigureData& data);
/// Returns the units if all runs of a figure have the same ones.
FigureUnits units_of(const Figure& figure);
/// Returns a label such as "x in AU"; only the label if there is no unit.
std::string in_unit(const std::string& label, const std::string& unit);
/// Returns the label of time with its unit.
std::string time_label(const Figure& figure);
/// Returns the symbol of the scale; empty if the scale is 1.
std::string scale_name(const FigureData& data);
/// Returns (H - H0)/scale at every sample. It is computed without overflow of the difference.
std::vector<double> relative_energy_error(const FigureData& data);
/// Returns (H - H0)/|H0| in symbols.
std::string energy_error_label(const FigureData& data);

/// Returns a text such as "there is no sample with a finite position".
std::string no_samples(const std::string& quantity);

}  // namespace hamflow::figures
