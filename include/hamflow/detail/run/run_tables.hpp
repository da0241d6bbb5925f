// What a run has recorded, as tables. docs/reference/files.md says what each column is; the files of a run have the
// same columns.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/table.hpp"

namespace hamflow {

struct RunTables {
  /// q, p, energy, energy_error_min, energy_error_max, invariants/NAME, observables/NAME, solver/..., step and, in
  /// arithmetic beyond double, digits/q, digits/p, digits/energy, digits/t; the last column is t.
  Table samples;
  Table section;              // q, p, t of the points of a section; empty where none was asked for
  Table bounces;              // q, p, step, coordinate, side, t at hard walls; empty without any
  std::vector<Table> events;  // of the user, each with its name: q, p, step, t
};

}  // namespace hamflow
