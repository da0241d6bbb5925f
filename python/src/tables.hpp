// Shows columns of tables as NumPy arrays, without a copy.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "hamflow/core/table.hpp"

namespace hamflow::python {

/// Returns a read-only view of shape (rows,) or (rows, width), float64 or int64. A column of texts becomes a list, or a
/// list of lists.   @param owner keeps the memory of the column alive
pybind11::object array_of(const Column& column, const pybind11::handle& owner);

/// Returns a copy of shape (n,).
pybind11::array_t<double> array_of(const std::vector<double>& numbers);

/// Converts a table to a tuple for pickle, and back.
pybind11::tuple state_of(const Table& table);
Table table_of_state(const pybind11::tuple& state);

}  // namespace hamflow::python
