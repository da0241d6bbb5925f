// Figures as data: what a page of panels shows, for matplotlib.
#pragma once

#include <pybind11/pybind11.h>

#include "hamflow/figures/page.hpp"

namespace hamflow::python {

/// {"panels": [...], "columns", "legend", "notes", "title"}; curves are arrays.
pybind11::dict dict_of(const figures::Page& page);

}  // namespace hamflow::python
