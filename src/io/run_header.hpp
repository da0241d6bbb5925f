// Description of a run in run.h5, without its tables.
#pragma once

#include <string>
#include <vector>

#include "h5md.hpp"

namespace hamflow {

/// Name and meaning of a dataset of numbers.
struct NamedColumn {
  const char* name;
  const char* meaning;
};

/// Datasets in /solver that `method.diagnostics` adds.
inline constexpr NamedColumn diagnostic_columns[] = {
    {"solver/iterations", "iterations of the last step; NaN at the start"},
    {"solver/residual", "residual of the last step"},
    {"solver/condition_tangent", "condition number of the Jacobian of the last step"},
    {"solver/determinant_tangent", "determinant of the Jacobian of the last step"},
    {"solver/condition_inverse_mass", "condition number of the inverse mass matrix at the last step"}};

/// Datasets of whole numbers that every run has.
inline constexpr NamedColumn count_columns[] = {{"step", "steps since the start"},
                                                {"solver/force", "force evaluations since the start"},
                                                {"solver/gradient", "evaluations of the gradient of H since the start"},
                                                {"solver/hessian", "evaluations of second derivatives since the start"},
                                                {"solver/linear_solves", "linear systems solved since the start"},
                                                {"events/halved", "steps replaced by two half steps since the start"}};

/// Range of H - H0 over the steps from one sample to the next, both included.
inline constexpr NamedColumn energy_range_columns[] = {
    {"energy_error_min", "smallest H - H0 of the steps since the previous sample, both samples included"},
    {"energy_error_max", "largest H - H0 of the steps since the previous sample, both samples included"}};

/// An invariant as a dataset.
struct InvariantColumn {
  std::string name;
  std::size_t size = 1;  // numbers in each row
  std::string meaning{};
  std::string unit{};
};

/// Units of the columns; empty if none is declared.
struct ColumnUnits {
  std::string t{};
  std::string q{};
  std::string p{};
  std::string energy{};
};

/// Everything but the rows.
struct RunDescription {
  std::string scenario;
  std::string version;
  std::string host;
  std::string problem;
  std::string method;
  std::string arithmetic;
  std::size_t dimension = 0;
  std::vector<InvariantColumn> invariants;
  std::vector<InvariantColumn> observables{};  // expressions of the user; the meaning is their text
  bool diagnostics = false;                    // diagnostics of implicit steps are written
  bool energy_range = false;                   // energy range of the steps between samples is written
  bool section = false;                        // points of a section are written
  bool walls = false;                          // bounces are written
  std::vector<std::string> events{};           // names of the user's events
  std::size_t samples = 0;                     // expected number, so that a short run has a small file; 0: unknown
  std::string created;                         // empty: now
  double dt = 0;
  std::string dt_text{};                   // dt as it was given
  std::vector<std::string> coordinates{};  // a name for each number of q; empty: no names are written
  std::vector<std::string> momenta{};
  std::vector<double> masses{};  // masses of the bodies; empty: not written
  // particles of a gas, whose positions and momenta are at the paths of H5MD instead of /q and /p
  H5mdParticles particles{};
  ColumnUnits units{};
  std::size_t digits_length = 0;  // characters of a number beyond double; 0: numbers are doubles
  // the attribute `run`; empty: there is none, and the run cannot be resumed with this file
  std::string identity{};
};

}  // namespace hamflow
