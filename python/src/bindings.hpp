// One function for each file of this folder, which adds its classes and functions to the module.
#pragma once

#include <pybind11/pybind11.h>

namespace hamflow::python {

void bind_errors(pybind11::module_& m);
void bind_tables(pybind11::module_& m);
void bind_lists(pybind11::module_& m);
void bind_problem(pybind11::module_& m);
void bind_scenario(pybind11::module_& m);
void bind_run(pybind11::module_& m);
void bind_compare(pybind11::module_& m);
void bind_verify(pybind11::module_& m);
void bind_simulation(pybind11::module_& m);
void bind_sweep(pybind11::module_& m);
void bind_certify(pybind11::module_& m);
void bind_orbits(pybind11::module_& m);

}  // namespace hamflow::python
