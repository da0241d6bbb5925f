// A scenario for many values of some of its keys.
#include "hamflow/workflow/sweep.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "hamflow/core/complaint.hpp"
#include "signals.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

py::dict sweep_in_python(const std::string& text, const std::vector<std::string>& varied, bool zip, int threads,
                         const std::filesystem::path& folder, const std::string& existing,
                         const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const Existing what_to_do = existing_named(existing);
  Interrupts interrupts;
  SweepReport report;
  std::shared_ptr<Table> members;
  std::shared_ptr<Table> sections;
  {
    const py::gil_scoped_release unlocked;
    ScenarioSweep sweep({.text = text, .name = "scenario", .varied = varied, .zip = zip, .threads = threads});
    if (!sweep.complaints().empty()) throw Rejection(sweep.complaints());
    if (!folder.empty()) {
      auto wrong = sweep.keep_in(folder, what_to_do);
      if (!wrong.empty()) throw Rejection(std::move(wrong));
    }
    const std::int64_t total = sweep.total_steps();
    Interrupts asked([&](std::int64_t steps) {
      if (progress) progress(steps, total);
    });
    report = sweep.run([&](std::int64_t steps) { return asked.go_on(steps); });
    members = std::make_shared<Table>(sweep.members());
    sections = std::make_shared<Table>(sweep.sections());
    const py::gil_scoped_acquire lock;
    interrupts = asked;
  }
  py::dict found;
  found["members"] = members;
  found["section"] = sections;
  found["json"] = report.json;
  found["text"] = report.text;
  found["status"] = report.status;
  found["failures"] = report.failures;
  found["interrupted"] = interrupts.was_interrupted();
  return found;
}

}  // namespace

void bind_sweep(py::module_& m) {
  m.def("sweep", &sweep_in_python, py::arg("text"), py::arg("varied"), py::arg("zip"), py::arg("threads"),
        py::arg("folder"), py::arg("existing"), py::arg("progress"));
}

}  // namespace hamflow::python
