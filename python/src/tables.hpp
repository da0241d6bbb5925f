// Columns as arrays of NumPy that share their memory.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "hamflow/core/table.hpp"

namespace hamflow::python {

/// A read-only view of shape (rows,) or (rows, width), float64 or int64; of texts a list, or a list of lists.
/// @param owner keeps the memory of the column alive
pybind11::object array_of(const Column& column, const pybind11::handle& owner);

/// A copy of shape (n,).
pybind11::array_t<double> array_of(const std::vector<double>& numbers);

/// A table for pickle, and back.
pybind11::tuple state_of(const Table& table);
Table table_of_state(const pybind11::tuple& state);

}  // namespace hamflow::python
