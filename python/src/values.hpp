// Converts Python values to values of a scenario.
#pragma once

#include <pybind11/pybind11.h>

#include "hamflow/scenario/value.hpp"
#include "hamflow/workflow/work_folder.hpp"

namespace hamflow::python {

/// Converts a bool, int, float, str, list, array or dict. Decimal and Fraction become texts, so that every arithmetic
/// can read all their digits.   @throws Error that names the key, if the value has another type
Value value_of(const pybind11::handle& object, const std::string& key);
Value::Table table_of(const pybind11::dict& dict, const std::string& path = {});

/// Converts "error", "replace" or "resume": what to do if the output directory exists.
/// @param can_resume whether "resume" is allowed   @throws Error that lists the allowed names
Existing existing_named(const std::string& name, bool can_resume = true);

}  // namespace hamflow::python
