// **Figures** of runs, of the kinds in figure_kinds.hpp, as SVG, PDF or PNG, drawn by gnuplot.
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

/// A stretch of a run.
struct FigureSamples {
  std::vector<double> t;               // one entry per sample
  std::vector<std::vector<double>> q;  // q[i][k]: coordinate i at sample k
  std::vector<std::vector<double>> p;
};

/// The particles of a gas, or bodies in space, of which there may be more than q and p of FigureSamples hold.
struct FigureParticles {
  std::size_t count = 0;  // 0: none
  std::size_t space = 0;  // 2 or 3
  bool gas = false;
  std::string container{};      // circle, box, periodic, none
  double radius = 0;            // of the circle, or sphere
  std::vector<double> edges{};  // of a box, whose middle is the origin
  /// All positions at a sample, particle by particle, not folded into a periodic box.
  std::function<std::vector<double>(std::size_t sample)> positions{};
};

/// Of a problem that brings its numbers along, enhanced text; empty where units are those of the input.
struct FigureUnits {
  std::string t{}, q{}, p{}, energy{};
  bool operator==(const FigureUnits&) const = default;
};

struct FigureData : FigureSamples {
  std::string title;                     // e.g. "central-force, cg(1,5), dt = 0.1"
  std::string label{};                   // of a run among several, in the legend
  std::vector<std::string> coordinates;  // a name for each q; {"r", "phi"} are drawn as an orbit in the plane
  std::vector<std::string> momenta;      // a name for each p
  std::vector<std::string> angles{};     // of the coordinates, those with period 2 pi
  std::vector<double> energy;            // H at each sample
  /// H - H0 at each sample, where it was formed with more digits than those of `energy`; else empty.
  std::vector<double> energy_difference{};
  /// The least and the largest H - H0 over the steps since the sample before, both included; empty where unknown.
  std::vector<double> least_difference{};
  std::vector<double> largest_difference{};
  double energy_scale = 1;      // max(|H0|, |T0| + |V0|)
  bool has_time = false;        // of H(q, p, t): the energies are H less the integral of dH/dt
  std::vector<double> curve_x;  // exact orbit, empty if unknown; NaN separates branches
  std::vector<double> curve_y;
  /// Dimension of space where q is [x1, y1(, z1), x2, ...] of several bodies, or the place of one; 0 otherwise.
  std::size_t space = 0;
  FigureUnits units{};
  std::vector<std::string> bodies{};  // their names, where they have some; empty: body 1, body 2, ...
  FigureParticles particles{};
  /// The first steps of the run, every one of them: what is drawn as a line where samples lie too far apart for one.
  FigureSamples first_steps{};
  double end = std::numeric_limits<double>::quiet_NaN();  // time at which the run ends; NaN: at its last sample
  bool every_step = false;                                // is a sample: nothing is known between them
  /// t and q of the samples with the located bounces between them, where a line has its corners; empty without any.
  FigureSamples path{};
  /// Of the steps of an implicit method, names and values at each sample; empty unless the run recorded them.
  std::vector<std::pair<std::string, std::vector<double>>> diagnostics;
  std::vector<std::pair<std::string, std::vector<double>>> observables{};  // expressions of the user, at each sample
  std::vector<std::pair<std::string, std::vector<double>>> invariants{};   // that the problem declares, likewise
  /// The points of a Poincare section in the plane of another coordinate and its momentum, and their names.
  std::vector<double> section_q;
  std::vector<double> section_p;
  std::string section_coordinate;
  std::string section_momentum;
  std::string section_text{};  // what section it is, enhanced text
  /// H(q, p) of one degree of freedom, for the exact level curve in the phase plane; empty otherwise.
  std::function<double(double q, double p)> hamiltonian_1d;
};

/// What is asked of a figure beside its kind.
struct FigureOptions {
  std::string x{};               // a column, of kinds that draw columns; empty: as is usual for the kind
  std::vector<std::string> y{};  // the same
  std::vector<double> at{};      // times, of kinds that draw some of them; empty: as is usual for the kind
  figures::PageOptions page{};
};

/// One run or several, drawn into one figure.
struct Figure {
  std::vector<FigureData> runs;  // at least one
  FigureOptions options{};
  std::vector<std::string> notes{};  // lines below the kind's own, enhanced text
};

/// Fills curve_x, curve_y from the exact r(phi) over the angles and radii that the data cover. A closed orbit is drawn
/// whole if the data go round it. Does nothing without r(phi) or without an orbit in the data.
void sample_polar_curve(const std::function<double(double)>& r_of_phi, FigureData& data);

/// Of times that are asked for: at which no sample is, and which one is drawn instead.
std::vector<std::string> notes_on_times(const Figure& figure);

/// What the data of a run allow.
FigureFacts facts_of(const FigureData& data);

/// Empty if the kind can be drawn of these data, else "found ...; allowed ...".
std::string why_not(const Figure& figure, const std::string& kind);

/// A figure of that kind, laid out.   @throws Error when kind, options or data do not fit
figures::Page page_of(const Figure& figure, const std::string& kind);
/// Writes svg, pdf or png by the extension of `file`; an existing file is replaced, and only by a complete one.
/// @throws Error when kind, extension, options or data do not fit   @throws FileError when gnuplot or the file fails
void write_figure(const Figure& figure, const std::string& kind, const std::filesystem::path& file);

namespace figures {

/// Whether q is (r, phi).
bool is_polar(const FigureData& data);
/// The path in the plane of samples of (r, phi).
Curve polar_track(const FigureSamples& samples);
/// The path in the plane, from cartesian or from polar coordinates; empty unless there are two.
Curve orbit_track(const FigureData& data);

}  // namespace figures

}  // namespace hamflow
