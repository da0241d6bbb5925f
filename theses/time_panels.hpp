// Panels of most figures of both theses: a quantity over time, and a phase plane.
#pragma once

#include <string>
#include <vector>

#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::reproduction {

/// @param label enhanced text   @param exact a line behind, at the same times; none: empty
figures::Panel over_time(const std::string& label, const std::vector<double>& t, const std::vector<double>& x,
                         const std::vector<double>& exact = {});
/// @param exact_x, exact_y a line behind; none: empty
figures::Panel phase_plane(const std::string& x_label, const std::string& y_label, const std::vector<double>& x,
                           const std::vector<double>& y, const std::vector<double>& exact_x,
                           const std::vector<double>& exact_y);

}  // namespace hamflow::reproduction
