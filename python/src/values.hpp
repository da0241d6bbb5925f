// Python values as the values of a scenario.
#pragma once

#include <pybind11/pybind11.h>

#include "hamflow/scenario/value.hpp"
#include "hamflow/workflow/work_folder.hpp"

namespace hamflow::python {

/// True, a whole number, a number, a text, a list (or array), a dict; Decimal and Fraction become texts, whose digits
/// every arithmetic reads. @throws Error naming the key if the value is of another type
Value value_of(const pybind11::handle& object, const std::string& key);
Value::Table table_of(const pybind11::dict& dict, const std::string& path = {});

/// What to do with a folder that exists: "error", "replace", "resume".   @throws Error naming what is allowed
/// @param can_resume whether "resume" is allowed
Existing existing_named(const std::string& name, bool can_resume = true);

}  // namespace hamflow::python
