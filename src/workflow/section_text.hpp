// Texts on a Poincare section for figures and summaries.
#pragma once

#include <fmt/format.h>

#include <string>

#include "hamflow/core/number.hpp"
#include "hamflow/run/section.hpp"
#include "hamflow/run/state_names.hpp"
#include "text.hpp"

namespace hamflow {

/// Returns the coordinate that is drawn with its momentum: the one after the coordinate of the section; the first one
/// if the section is defined by time.
inline std::size_t coordinate_shown(const Section& section, std::size_t size) {
  return section.is_stroboscopic ? 0 : (section.coordinate + 1) % size;
}

/// Returns "section x = 0, x increasing" as enhanced text.
inline std::string section_text(const Section& section, const StateNames& names) {
  if (section.every_step) return "every step of the map";
  const std::string x = section.expression
                            ? figures::escaped(section.expression->text())
                            : figures::symbol((section.momentum ? names.p : names.q)[section.coordinate]);
  const std::string way =
      section.direction == 0 ? "in both directions" : x + (section.direction > 0 ? " increasing" : " decreasing");
  return fmt::format("section {} = {}, {}", x, figures::escaped(shortest(section.value)), way);
}

}  // namespace hamflow
