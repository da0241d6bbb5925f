// The records of a run as tables. The files of a run have the same columns; docs/reference/files.md describes them.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/table.hpp"

namespace hamflow {

struct RunTables {
  /// q, p, energy, energy_error_min, energy_error_max, invariants/NAME, observables/NAME, solver/..., step and, in
  /// arithmetic beyond double, digits/q, digits/p, digits/energy, digits/t; the last column is t.
  Table samples;
  Table section;              // q, p, t of the points of a section; empty if none was requested
  Table bounces;              // q, p, step, coordinate, side, t at hard walls; empty without hard walls
  std::vector<Table> events;  // events of the user, each with its name: q, p, step, t
};

}  // namespace hamflow
