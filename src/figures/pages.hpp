// One function per kind of figure: from the data of a run to a page.
#pragma once

#include "figure.hpp"
#include "page.hpp"

namespace hamflow::figures {

Page orbit_page(const FigureData& data);
Page energy_page(const FigureData& data);
Page energy_error_page(const FigureData& data);
Page phase_page(const FigureData& data);
/// Condition and determinant of the tangent, condition of M^-1 and iterations over time.   [Gross1999,
/// figures 3.27, 3.28]
Page condition_page(const FigureData& data);
/// Points of a Poincare section.
Page section_page(const FigureData& data);

constexpr std::size_t most_planes = 12;  // phase planes on one page

/// (H - H0)/scale at every sample. Where the difference overflows the quotient need not.
std::vector<double> relative_energy_error(const FigureData& data);

}  // namespace hamflow::figures
