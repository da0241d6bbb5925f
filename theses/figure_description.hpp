// Describes a figure in words, for readers who cannot see it: axes, kinds of lines, and the course of the curves.
#pragma once

#include <string>

#include "hamflow/figures/page.hpp"

namespace hamflow::reproduction {

/// Describes the curves, one sentence each: "cg(1,5) reaches from 1 to 3 in y, and ends where it begins."
std::string describe_curves(const figures::Page& page);
/// Describes panels, axes and kinds of lines, then the curves as describe_curves() does: "2 panels. 1: E over t, x from
/// 0 to 25, y from -1 to 1; exact: a line, element: dots. ..."
std::string words_of(const figures::Page& page);

}  // namespace hamflow::reproduction
