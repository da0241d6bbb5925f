// Certificates for the energies and the integrators of other programs.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>

#include "bindings.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/scenario/value.hpp"
#include "hamflow/verify/certify_step.hpp"
#include "hamflow/verify/log_certificate.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> numbers_of(const Numbers& array) { return {array.data(), array.data() + array.size()}; }

py::array_t<double> array_with(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

std::string type_of(const py::handle& object) { return py::type::of(object).attr("__name__").cast<std::string>(); }

/// Converts what a step returned for q or p.   @throws Error if it has another shape or type
std::vector<double> returned_numbers(const py::handle& object, const char* name, std::size_t size) {
  const std::string allowed =
      "; allowed an array of " + std::to_string(size) + " numbers, of shape (" + std::to_string(size) + ",)";
  const py::array array = py::array::ensure(object);
  if (!array || std::string("fiub").find(array.dtype().kind()) == std::string::npos) {
    PyErr_Clear();
    throw Error(std::string("the step returned ") + type_of(object) + " for " + name + allowed);
  }
  if (array.ndim() != 1 || static_cast<std::size_t>(array.size()) != size) {
    throw Error(std::string("the step returned ") + name + " of shape " +
                py::str(array.attr("shape")).cast<std::string>() + allowed);
  }
  return numbers_of(Numbers(array));
}

/// Wraps a Python function (q, p, h), which returns the new (q, p) or changes its arguments in place.
ForeignStep step_of(const py::function& function) {
  return [function](std::vector<double>& q, std::vector<double>& p, double h) {
    const py::array_t<double> q_given = array_with(q);
    const py::array_t<double> p_given = array_with(p);
    py::object found;
    try {
      found = function(q_given, p_given, h);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_Exception)) throw;  // KeyboardInterrupt is no subclass of Exception
      throw Error("the step raised " + error.type().attr("__name__").cast<std::string>() + ": " +
                  py::str(error.value()).cast<std::string>() + " (h = " + py::str(py::float_(h)).cast<std::string>() +
                  ")");
    }
    if (found.is_none()) {
      const bool same = std::memcmp(q_given.data(), q.data(), q.size() * sizeof(double)) == 0 &&
                        std::memcmp(p_given.data(), p.data(), p.size() * sizeof(double)) == 0;
      if (same) {
        throw Error(
            "the step returned None and left q and p as they were; allowed a step that returns (q, p), or changes the "
            "arrays q and p in place, as q += h*p or q[:] = ... do");
      }
      q = numbers_of(q_given);
      p = numbers_of(p_given);
      return;
    }
    const bool is_pair = py::isinstance<py::sequence>(found) && !py::isinstance<py::str>(found) && py::len(found) == 2;
    if (!is_pair)
      throw Error("the step returned " + type_of(found) + "; allowed (q, p), or None after a change in place");
    const py::sequence pair = found;
    std::vector<double> q_new = returned_numbers(py::object(pair[0]), "q", q.size());
    p = returned_numbers(py::object(pair[1]), "p", p.size());
    q = std::move(q_new);
  };
}

py::dict certified_log(const Numbers& t, const Numbers& energy, const std::optional<double>& scale) {
  const LogCertificate found = certify_log(numbers_of(t), numbers_of(energy), scale);
  py::dict all;
  all["drift"] = std::string(found.drift.drift ? name(*found.drift.drift) : "undecided");
  all["energy_level"] = found.energy_level;
  all["growth_exponent"] = found.growth_exponent();
  all["reason"] = found.drift.reason;
  all["samples"] = found.samples;
  all["periods"] = found.drift.periods;
  all["scale"] = found.scale;
  return all;
}

py::dict certified_step(const py::function& function, const StepProblem& problem, const std::optional<int>& order,
                        const std::optional<bool>& symplectic, const std::optional<bool>& symmetric,
                        const std::vector<std::string>& preserves) {
  const StepCertificate found = certify_step(step_of(function), problem, {order, symplectic, symmetric, preserves});
  py::dict kept;
  for (const auto& [name, holds] : found.preserves) kept[py::str(name)] = holds;
  py::dict all;
  all["order"] = found.order;
  all["symplectic"] = found.symplectic;
  all["symmetric"] = found.symmetric;
  all["preserves"] = kept;
  all["agrees"] = found.agrees;
  all["reason"] = found.reason;
  return all;
}

}  // namespace

void bind_certify(py::module_& m) {
  m.def("certify_log", &certified_log);
  m.def("certify_step", [](const py::function& step, const ChosenProblem& problem, const std::optional<int>& order,
                           const std::optional<bool>& symplectic, const std::optional<bool>& symmetric,
                           const std::vector<std::string>& preserves) {
    return certified_step(step, StepProblem{problem.entry, problem.variant, problem.parameters}, order, symplectic,
                          symmetric, preserves);
  });
  m.def("certify_step", [](const py::function& step, const Scenario& scenario, const std::optional<int>& order,
                           const std::optional<bool>& symplectic, const std::optional<bool>& symmetric,
                           const std::vector<std::string>& preserves) {
    const Texts parameters = complete(scenario.problem->info, scenario.request.parameters);
    return certified_step(
        step, StepProblem{scenario.problem, scenario.request.variant, parameters, scenario.start_q, scenario.start_p},
        order, symplectic, symmetric, preserves);
  });
}

}  // namespace hamflow::python
