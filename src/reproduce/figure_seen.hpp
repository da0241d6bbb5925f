// What the curves of a figure do, for those who do not see it: kinds of lines and ranges are figure_text's.
#pragma once

#include <string>

#include "page.hpp"

namespace hamflow::reproduction {

/// "cg(1,5) reaches from 1 to 3 in y, and ends where it begins.", a sentence for each line and each kind of dots.
std::string seen_in(const figures::Page& page);

}  // namespace hamflow::reproduction
