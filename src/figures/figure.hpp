// **Figures** of runs as SVG, PDF or PNG, drawn by gnuplot. figure_kinds.hpp lists their kinds.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "figure_kinds.hpp"
#include "hamflow/figures/page.hpp"

namespace hamflow {

/// Samples of a part of a run.
struct FigureSamples {
  std::vector<double> t;               // one entry for each sample
  std::vector<std::vector<double>> q;  // q[i][k]: coordinate i at sample k
  std::vector<std::vector<double>> p;
};

/// The particles of a gas, or bodies in space. There may be more of them than q and p of FigureSamples contain.
struct FigureParticles {
  std::size_t count = 0;  // 0: none
  std::size_t space = 0;  // dimension of space, 2 or 3
  bool gas = false;
  std::string container{};      // circle, box, periodic, none
  double radius = 0;            // radius of the circle or sphere
  std::vector<double> edges{};  // edges of a box whose middle is the origin
  /// Returns all positions at a sample, particle by particle, not folded into a periodic box.
  std::function<std::vector<double>(std::size_t sample)> positions{};
};

/// Units of a problem with built-in numbers, enhanced text; empty if units are those of the input.
struct FigureUnits {
  std::string t{}, q{}, p{}, energy{};
  bool operator==(const FigureUnits&) const = default;
};

struct FigureData : FigureSamples {
  std::string title;                     // for example "central-force, cg(1,5), dt = 0.1"
  std::string label{};                   // name of the run in a legend of several runs
  std::vector<std::string> coordinates;  // a name for each q; {"r", "phi"} are drawn as an orbit in the plane
  std::vector<std::string> momenta;      // a name for each p
  std::vector<std::string> angles{};     // names of those coordinates that have period 2 pi
  std::vector<double> energy;            // H at each sample
  /// H - H0 at each sample, if it was computed with more digits than `energy` has; else empty.
  std::vector<double> energy_difference{};
  /// Smallest and largest H - H0 over the steps since the previous sample, both samples included; empty if unknown.
  std::vector<double> least_difference{};
  std::vector<double> largest_difference{};
  double energy_scale = 1;      // max(|H0|, |T0| + |V0|)
  bool has_time = false;        // H depends on t; the energies are H minus the integral of dH/dt
  std::vector<double> curve_x;  // exact orbit, empty if unknown; NaN separates branches
  std::vector<double> curve_y;
  /// Dimension of space if q is [x1, y1(, z1), x2, ...] of one or several bodies; 0 otherwise.
  std::size_t space = 0;
  FigureUnits units{};
  std::vector<std::string> bodies{};  // names of the bodies; empty: body 1, body 2, ...
  FigureParticles particles{};
  /// All of the first steps of the run. They are drawn as a line if samples are too far apart for one.
  FigureSamples first_steps{};
  // time at the end of the run; NaN: the time of its last sample
  double end = std::numeric_limits<double>::quiet_NaN();
  bool every_step = false;  // every step is a sample, so nothing is known in between
  /// t and q of the samples, with the located bounces between them, where a line has corners; empty if there are no
  /// bounces.
  FigureSamples path{};
  /// Names and values, at each sample, of the diagnostics of implicit steps; empty unless the run recorded them.
  std::vector<std::pair<std::string, std::vector<double>>> diagnostics;
  std::vector<std::pair<std::string, std::vector<double>>> observables{};  // expressions of the user, at each sample
  // invariants that the problem declares, at each sample
  std::vector<std::pair<std::string, std::vector<double>>> invariants{};
  /// Points of a Poincare section in the plane of another coordinate and its momentum, and the names of both.
  std::vector<double> section_q;
  std::vector<double> section_p;
  std::string section_coordinate;
  std::string section_momentum;
  std::string section_text{};  // description of the section, enhanced text
  /// H(q, p) of a problem with one degree of freedom, for the exact level curve in the phase plane; empty otherwise.
  std::function<double(double q, double p)> hamiltonian_1d;
};

/// Options of a figure, apart from its kind.
struct FigureOptions {
  std::string x{};               // a column, for kinds that draw columns; empty: the default of the kind
  std::vector<std::string> y{};  // the same for the y-axis
  std::vector<double> at{};      // times, for kinds that draw chosen samples; empty: the default of the kind
  figures::PageOptions page{};
};

/// One run, or several runs that share a figure.
struct Figure {
  std::vector<FigureData> runs;  // at least one
  FigureOptions options{};
  std::vector<std::string> notes{};  // lines below those of the kind, enhanced text
};

/// Fills curve_x and curve_y from the exact r(phi), over the angles and radii of the data. A closed orbit is drawn
/// completely if the data cover it. Does nothing without r(phi), or if the data contain no orbit.
void sample_polar_curve(const std::function<double(double)>& r_of_phi, FigureData& data);

/// Returns notes on chosen times that are not times of samples, with the samples that are drawn instead.
std::vector<std::string> notes_on_times(const Figure& figure);

/// Returns what the data of a run allow.
FigureFacts facts_of(const FigureData& data);

/// Returns an empty text if the kind can be drawn from these data, otherwise "found ...; allowed ...".
std::string why_not(const Figure& figure, const std::string& kind);

/// Lays out a figure of a kind.   @throws Error if kind, options or data do not fit
figures::Page page_of(const Figure& figure, const std::string& kind);
/// Writes SVG, PDF or PNG, by the extension of `file`. An existing file is replaced once the new one is complete.
/// @throws Error if kind, extension, options or data do not fit   @throws FileError if gnuplot or writing fails
void write_figure(const Figure& figure, const std::string& kind, const std::filesystem::path& file);

namespace figures {

/// Returns whether q is (r, phi).
bool is_polar(const FigureData& data);
/// Returns the path in the plane for samples of (r, phi).
Curve polar_track(const FigureSamples& samples);
/// Returns the path in the plane, from cartesian or polar coordinates; empty unless there are two coordinates.
Curve orbit_track(const FigureData& data);

}  // namespace figures

}  // namespace hamflow
