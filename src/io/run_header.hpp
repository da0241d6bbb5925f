// What a run.h5 says of its run beside the tables.
#pragma once

#include <string>
#include <vector>

#include "h5md.hpp"

namespace hamflow {

/// A dataset of numbers, and what it means.
struct NamedColumn {
  const char* name;
  const char* meaning;
};

/// Those of /solver that `method.diagnostics` adds.
inline constexpr NamedColumn diagnostic_columns[] = {
    {"solver/iterations", "of the last step; NaN at the start"},
    {"solver/residual", "of the last step"},
    {"solver/condition_tangent", "of the tangent matrix of the last step"},
    {"solver/determinant_tangent", "of the tangent matrix of the last step"},
    {"solver/condition_inverse_mass", "of the inverse mass matrix at the last step"}};

/// Of every run: whole numbers.
inline constexpr NamedColumn count_columns[] = {{"step", "steps since the start"},
                                                {"solver/force", "force evaluations since the start"},
                                                {"solver/gradient", "evaluations of the gradient of H since the start"},
                                                {"solver/hessian", "evaluations of second derivatives since the start"},
                                                {"solver/linear_solves", "linear systems solved since the start"},
                                                {"events/halved", "steps replaced by two half steps since the start"}};

/// H - H0 over the steps from one sample to the next, both included.
inline constexpr NamedColumn energy_range_columns[] = {
    {"energy_error_min", "least H - H0 at the end of a step since the sample before, both samples included"},
    {"energy_error_max", "largest H - H0 at the end of a step since the sample before, both samples included"}};

/// An invariant as a dataset.
struct InvariantColumn {
  std::string name;
  std::size_t size = 1;  // numbers a row
  std::string meaning{};
  std::string unit{};
};

/// Of the columns; empty where nothing is declared.
struct ColumnUnits {
  std::string t{};
  std::string q{};
  std::string p{};
  std::string energy{};
};

/// All but the rows.
struct RunDescription {
  std::string scenario;
  std::string version;
  std::string host;
  std::string problem;
  std::string method;
  std::string arithmetic;
  std::size_t dimension = 0;
  std::vector<InvariantColumn> invariants;
  std::vector<InvariantColumn> observables{};  // expressions of the user, whose text is the meaning
  bool diagnostics = false;                    // of implicit steps
  bool energy_range = false;                   // of the steps between samples
  bool section = false;                        // points of one are written
  bool walls = false;                          // bounces are
  std::vector<std::string> events{};           // those of the user, by name
  std::size_t samples = 0;                     // expected, so that a short run leaves a small file; 0: unknown
  std::string created;                         // empty: now
  double dt = 0;
  std::string dt_text{};                   // as it was given
  std::vector<std::string> coordinates{};  // a name for each number of q; none: they are not written
  std::vector<std::string> momenta{};
  std::vector<double> masses{};  // of the bodies; none: not written
  H5mdParticles particles{};     // of a gas: positions and momenta as H5MD wants them, instead of /q and /p
  ColumnUnits units{};
  std::size_t digits_length = 0;  // characters of a number beyond double; 0: numbers are doubles
  std::string identity{};         // of the run, the attribute `run`; empty: none, nothing can go on in the file
};

}  // namespace hamflow
