// A figure for the page: the same picture in a fraction of the bytes.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// The SVG of gnuplot with what the eye cannot see left out: of a line the points that are nearer than a twentieth of a
/// unit to what stays, dots as one path rather than an element each, those that cover each other once, symbols that are
/// nowhere used. Elements of a form that it does not know stay as they are.
std::string slim_svg(const std::string& svg);

}  // namespace hamflow::reproduction
