// A figure in words, for those who do not see it: its axes, its kinds of lines, and what the curves do.
#pragma once

#include <string>

#include "hamflow/figures/page.hpp"

namespace hamflow::reproduction {

/// "cg(1,5) reaches from 1 to 3 in y, and ends where it begins.", a sentence for each line and each kind of dots.
std::string seen_in(const figures::Page& page);
/// "2 panels. 1: E over t, x from 0 to 25, y from -1 to 1; exact: a line, element: dots.", and what seen_in() says.
std::string words_of(const figures::Page& page);

}  // namespace hamflow::reproduction
