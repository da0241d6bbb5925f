#include "hamflow/scenario/scenario.hpp"

#include <pybind11/stl.h>

#include "bindings.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

void bind_scenario(py::module_& m) {
  py::class_<Scenario, std::shared_ptr<Scenario>>(m, "Scenario")
      .def_static(
          "read",
          [](const std::string& text, const std::string& name, const std::vector<std::string>& sets) {
            return std::make_shared<Scenario>(accepted(read_scenario_text(text, name, sets)));
          },
          py::arg("text"), py::arg("name"), py::arg("sets") = std::vector<std::string>())
      .def_readonly("text", &Scenario::text)
      .def_readonly("steps", &Scenario::steps)
      .def_readonly("dt", &Scenario::dt)
      .def_readonly("notes", &Scenario::notes)
      .def_readonly("figures", &Scenario::figures)
      .def_property_readonly("problem", [](const Scenario& s) { return s.request.problem; })
      .def_property_readonly("method", [](const Scenario& s) { return describe(s.request.method).name; })
      .def_property_readonly("arithmetic", [](const Scenario& s) { return s.request.arithmetic; })
      .def_property_readonly(
          "coordinates",
          [](const Scenario& s) {
            return state_names(*s.problem, complete(s.problem->info, s.request.parameters), s.start_q.size()).q;
          })
      .def_property_readonly("momenta", [](const Scenario& s) {
        return state_names(*s.problem, complete(s.problem->info, s.request.parameters), s.start_q.size()).p;
      });
  m.def("scenario_text", [](const py::dict& tree) { return scenario_text(table_of(tree)); });
  m.def("value_text", [](const py::handle& value) {
    // Inside a list TOML writes a table on one line, which is the form needed here.
    const bool is_table = py::isinstance<py::dict>(value);
    Value written = value_of(value, "value");
    if (is_table) written = Value::List{std::move(written)};
    const std::string text = scenario_text(Value::Table{{"value", std::move(written)}});
    const std::size_t first = text.find('=') + 2;
    const std::size_t last = text.find_last_not_of('\n');
    return is_table ? text.substr(first + 1, last - first - 1) : text.substr(first, last - first + 1);
  });
  m.def("read_file", [](const std::string& file) { return scenario_text(file); });
}

}  // namespace hamflow::python
