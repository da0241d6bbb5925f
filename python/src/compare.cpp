// Work-precision comparisons of methods.
#include "hamflow/workflow/compare.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

#include "bindings.hpp"
#include "pages.hpp"
#include "signals.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// @param progress called with the number of finished runs and of all runs; may be empty
py::dict compare_in_python(const ComparisonInput& input, const std::filesystem::path& folder,
                           const std::string& existing,
                           const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const Existing what_to_do = existing_named(existing, false);
  std::int64_t runs = 0;
  Interrupts interrupts([&](std::int64_t done) {
    if (progress) progress(done, runs);
  });
  auto report = std::make_shared<ComparisonReport>();
  ComparisonReading reading;
  {
    const py::gil_scoped_release unlocked;
    reading = read_comparison(input);
    if (!reading.complaints.empty()) throw Rejection(reading.complaints);
    std::optional<WorkFolder> kept;
    if (!folder.empty()) {
      kept.emplace(folder, comparison_folder(), what_to_do);
      kept->prepare();
    }
    *report = compare_methods(reading.request, [&](const ComparisonProgress& now) {
      runs = static_cast<std::int64_t>(now.runs);
      return interrupts.go_on(static_cast<std::int64_t>(now.done));
    });
    if (kept) write_comparison(*report, *kept);
  }
  py::dict found;
  found["report"] = report;
  found["notes"] = reading.notes;
  found["interrupted"] = interrupts.raised();
  return found;
}

}  // namespace

void bind_compare(py::module_& m) {
  py::class_<ComparisonReport, std::shared_ptr<ComparisonReport>>(m, "Comparison")
      .def_readonly("status", &ComparisonReport::status)
      .def_readonly("message", &ComparisonReport::message)
      .def_readonly("hint", &ComparisonReport::hint)
      .def_readonly("json", &ComparisonReport::json)
      .def_readonly("text", &ComparisonReport::text)
      .def_readonly("warnings", &ComparisonReport::warnings)
      .def("page", [](const ComparisonReport& report) { return dict_of(comparison_page(report.comparison)); })
      .def("draw", [](const ComparisonReport& report, const std::filesystem::path& file) {
        const py::gil_scoped_release unlocked;
        const std::string why_not = refused_comparison_figure(file);
        if (!why_not.empty()) throw Rejection("file", why_not);
        draw_comparison(report.comparison, file);
      });
  m.def(
      "compare",
      [](const std::string& text, const std::string& name, const std::vector<std::string>& methods,
         const std::vector<std::string>& dts, const std::filesystem::path& folder, const std::string& existing,
         const std::function<void(std::int64_t, std::int64_t)>& progress) {
        return compare_in_python({.text = text, .name = name, .methods = methods, .dts = dts}, folder, existing,
                                 progress);
      },
      py::arg("text"), py::arg("name"), py::arg("methods"), py::arg("dts"), py::arg("folder"), py::arg("existing"),
      py::arg("progress"));
}

}  // namespace hamflow::python
