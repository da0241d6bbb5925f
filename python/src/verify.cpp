// Measures the claims of methods.
#include <pybind11/stl.h>

#include <optional>

#include "bindings.hpp"
#include "hamflow/verify/verification.hpp"
#include "signals.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

py::dict verify_in_python(const std::vector<std::string>& methods, bool all, const std::string& problem) {
  Interrupts interrupts;
  std::vector<PropertyRow> rows;
  {
    const py::gil_scoped_release unlocked;
    Verification verification({.methods = methods, .all = all, .problem = problem});
    verification.wait([&] { return interrupts.go_on(0); });
    rows = verification.rows();
  }
  py::dict found;
  found["json"] = verification_json(rows, interrupts.was_interrupted());
  found["text"] = rows.empty() ? std::string() : property_table(rows);
  found["interrupted"] = interrupts.raised();
  return found;
}

}  // namespace

void bind_verify(py::module_& m) {
  m.def("verify", &verify_in_python, py::arg("methods"), py::arg("all"), py::arg("problem"));
}

}  // namespace hamflow::python
