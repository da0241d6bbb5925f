// Measures a recipe that is not in the catalogue as `hamflow verify` measures one that is.
#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "engine/step_map_of.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow::mutants {

template <class Recipe>
PropertyRow examine(const Recipe& recipe) {
  const StepMapOf<Pendulum, Recipe> pendulum([]<class R>() { return Pendulum<R>(); }, recipe);
  const StepMapOf<HenonHeiles, Recipe> henon_heiles([]<class R>() { return HenonHeiles<R>(); }, recipe);
  std::vector<Measurement> on{measure(pendulum, region_of("pendulum")),
                              measure(henon_heiles, region_of("henon-heiles"))};
  return judge(pendulum.claims(), std::move(on));
}

/// The sound one among the mutants: nothing differs.
inline void expect_sound(const PropertyRow& row) {
  const std::vector<PropertyRow> rows{row};
  EXPECT_TRUE(row.agrees()) << row.differing() << '\n' << property_table(rows);
}

/// The row differs, and at least in `property`. Prints everything that caught it.
inline void expect_caught(const PropertyRow& row, const std::string& property) {
  const std::vector<PropertyRow> rows{row};
  std::cout << "mutant \"" << row.claims.name << "\" caught by:";
  for (const PropertyCell& cell : row.cells) {
    if (cell.agrees != Finding::yes) {
      std::cout << ' ' << cell.property << " (claimed " << cell.claimed << ", measured " << cell.measured << ");";
    }
  }
  std::cout << '\n';
  EXPECT_FALSE(row.agrees()) << property_table(rows);
  EXPECT_NE(row[property].agrees, Finding::yes) << property_table(rows);
}

}  // namespace hamflow::mutants
