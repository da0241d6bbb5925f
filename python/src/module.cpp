#include "bindings.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "The compiled half of hamflow; import hamflow instead.";
  m.attr("version") = HAMFLOW_VERSION;
  hamflow::python::bind_errors(m);
  hamflow::python::bind_tables(m);
  hamflow::python::bind_lists(m);
  hamflow::python::bind_problem(m);
  hamflow::python::bind_scenario(m);
  hamflow::python::bind_run(m);
  hamflow::python::bind_simulation(m);
  hamflow::python::bind_sweep(m);
  hamflow::python::bind_certify(m);
}
