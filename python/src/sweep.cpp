// Sweeps: one scenario for many values of some of its keys.
#include "hamflow/workflow/sweep.hpp"

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.hpp"
#include "hamflow/core/complaint.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "signals.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// Checks a sweep and creates its folder. The caller has released the interpreter's lock.
std::unique_ptr<ScenarioSweep> checked_sweep(const SweepRequest& request, const std::filesystem::path& folder,
                                             Existing existing) {
  Interrupts interrupts;
  const std::function<bool()> goes_on = [&] { return interrupts.go_on(0); };
  std::unique_ptr<ScenarioSweep> sweep;
  try {
    const StopQuestion question(goes_on);
    sweep = std::make_unique<ScenarioSweep>(request);
  } catch (const ReadingStopped&) {
    const py::gil_scoped_acquire lock;
    const Interrupts asked = std::exchange(interrupts, Interrupts());
    asked.rethrow();
  }
  if (!sweep->complaints().empty()) throw Rejection(sweep->complaints());
  if (folder.empty()) return sweep;
  auto wrong = sweep->keep_in(folder, existing);
  if (!wrong.empty()) throw Rejection(std::move(wrong));
  return sweep;
}

py::dict found_of(const ScenarioSweep& sweep, const SweepReport& report, const py::object& interrupted) {
  std::shared_ptr<Table> members;
  std::shared_ptr<Table> sections;
  {
    const py::gil_scoped_release unlocked;
    members = std::make_shared<Table>(sweep.members());
    sections = std::make_shared<Table>(sweep.sections());
  }
  py::dict found;
  found["members"] = members;
  found["section"] = sections;
  found["json"] = report.json;
  found["text"] = report.text;
  found["status"] = report.status;
  py::list failures;
  for (const MemberFailure& failure : report.summary.failures) {
    failures.append("member " + std::to_string(failure.member) + ", step " + std::to_string(failure.step) + ": " +
                    failure.message);
  }
  found["failures"] = failures;
  found["interrupted"] = interrupted;
  return found;
}

py::dict sweep_in_python(const std::string& text, const std::vector<std::string>& varied, bool zip, int threads,
                         const std::string& shard, const std::filesystem::path& folder, const std::string& existing,
                         const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const Existing what_to_do = existing_named(existing);
  const SweepShard part = shard.empty() ? SweepShard() : shard_named(shard);
  std::unique_ptr<ScenarioSweep> sweep;
  SweepReport report;
  py::object interrupted = py::none();
  std::int64_t total = 0;
  {
    const py::gil_scoped_release unlocked;
    sweep = checked_sweep(
        {.text = text, .name = "scenario", .varied = varied, .zip = zip, .threads = threads, .shard = part}, folder,
        what_to_do);
    total = sweep->total_steps();
    Interrupts asked([&](std::int64_t steps) {
      if (progress) progress(steps, total);
    });
    report = sweep->run([&](std::int64_t steps) { return asked.go_on(steps); });
    const py::gil_scoped_acquire lock;
    interrupted = asked.raised();
    asked = Interrupts();
  }
  if (progress && interrupted.is_none() && report.status == "done") progress(total, total);
  return found_of(*sweep, report, interrupted);
}

/// Writes "KEY=x1,x2,...", as the command takes a key and its values. Going through C++ avoids a Python object for each
/// value.
std::string varied_text(const std::string& key, const py::array_t<double, py::array::c_style>& values) {
  if (values.ndim() != 1) {
    throw Error(key + ": found an array with " + std::to_string(values.ndim()) + " dimensions; allowed one");
  }
  const std::span<const double> numbers(values.data(), static_cast<std::size_t>(values.size()));
  const py::gil_scoped_release unlocked;
  return key + "=" +
         joined(
             numbers, [](double x) { return shortest(x); }, ",");
}

py::bytes sweep_shard(const std::string& text, const std::vector<std::string>& varied, bool zip, std::size_t index,
                      std::size_t count) {
  std::vector<std::byte> finished;
  {
    const py::gil_scoped_release unlocked;
    const auto sweep = checked_sweep(
        {.text = text, .name = "scenario", .varied = varied, .zip = zip, .threads = 1, .shard = {index, count}}, {},
        Existing::refuse);
    (void)sweep->run();
    finished = sweep->finished_members();
  }
  return {reinterpret_cast<const char*>(finished.data()), finished.size()};
}

/// A sweep whose members are run by other processes. It gathers their results.
class GatheredSweep {
 public:
  GatheredSweep(const std::string& text, const std::vector<std::string>& varied, bool zip,
                const std::filesystem::path& folder, const std::string& existing) {
    const Existing what_to_do = existing_named(existing);
    const py::gil_scoped_release unlocked;
    sweep_ = checked_sweep({.text = text, .name = "scenario", .varied = varied, .zip = zip}, folder, what_to_do);
  }
  void take(std::string_view finished) {
    const py::gil_scoped_release unlocked;
    sweep_->take(std::as_bytes(std::span(finished)));
  }
  std::size_t members() const { return sweep_->members().rows(); }
  py::dict found() const {
    SweepReport report;
    {
      const py::gil_scoped_release unlocked;
      report = sweep_->report();
    }
    return found_of(*sweep_, report, py::none());
  }

 private:
  std::unique_ptr<ScenarioSweep> sweep_;
};

}  // namespace

void bind_sweep(py::module_& m) {
  m.def("sweep", &sweep_in_python, py::arg("text"), py::arg("varied"), py::arg("zip"), py::arg("threads"),
        py::arg("shard"), py::arg("folder"), py::arg("existing"), py::arg("progress"));
  m.def("varied_text", &varied_text, py::arg("key"), py::arg("values"));
  m.def("sweep_shard", &sweep_shard, py::arg("text"), py::arg("varied"), py::arg("zip"), py::arg("index"),
        py::arg("count"));
  py::class_<GatheredSweep>(m, "GatheredSweep")
      .def(py::init<const std::string&, const std::vector<std::string>&, bool, const std::filesystem::path&,
                    const std::string&>())
      .def("take", &GatheredSweep::take, py::arg("finished"))
      .def_property_readonly("members", &GatheredSweep::members)
      .def("found", &GatheredSweep::found);
}

}  // namespace hamflow::python
