// Converts the contents of a figure to dicts and arrays, which python/hamflow/_page.py draws with matplotlib.
#pragma once

#include <pybind11/pybind11.h>

#include "hamflow/figures/page.hpp"

namespace hamflow::python {

/// Returns {"panels": [...], "columns", "legend", "notes", "title"}. Curves are arrays.
pybind11::dict dict_of(const figures::Page& page);

}  // namespace hamflow::python
