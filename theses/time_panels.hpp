// Panels that most figures of both theses use: a quantity over time, and a phase plane.
#pragma once

#include <string>
#include <vector>

#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::reproduction {

/// @param label enhanced text   @param exact the exact values at the same times, drawn as a line; may be empty
figures::Panel over_time(const std::string& label, const std::vector<double>& t, const std::vector<double>& x,
                         const std::vector<double>& exact = {});
/// @param exact_x, exact_y the exact curve, drawn as a line; may be empty
figures::Panel phase_plane(const std::string& x_label, const std::string& y_label, const std::vector<double>& x,
                           const std::vector<double>& y, const std::vector<double>& exact_x,
                           const std::vector<double>& exact_y);

}  // namespace hamflow::reproduction
