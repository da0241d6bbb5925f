// The class Problem: a Hamiltonian without a start.
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "hamflow/run/state_names.hpp"
#include "tables.hpp"
#include "values.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The rows of an array: one for the shape (d,), n for the shape (n, d).
struct Rows {
  const double* data;
  std::size_t count;
  std::size_t width;
  std::vector<double> row(std::size_t k) const { return {data + k * width, data + (k + 1) * width}; }
};

Rows rows_of(const Array& array, const char* name) {
  if (array.ndim() == 1) return {array.data(), 1, static_cast<std::size_t>(array.shape(0))};
  if (array.ndim() == 2) {
    return {array.data(), static_cast<std::size_t>(array.shape(0)), static_cast<std::size_t>(array.shape(1))};
  }
  throw Error(std::string(name) + ": found an array with " + std::to_string(array.ndim()) +
              " dimensions; allowed shapes (d,) and (n, d)");
}

/// Checks that q and p have the same shape, and that the problem has this number of coordinates.
std::pair<Rows, Rows> states_of(const ChosenProblem& problem, const Array& q, const Array& p) {
  const std::pair<Rows, Rows> rows{rows_of(q, "q"), rows_of(p, "p")};
  if (q.ndim() != p.ndim() || rows.first.count != rows.second.count || rows.first.width != rows.second.width) {
    throw Error("q and p: found arrays of different shapes; allowed the same shape, (d,) or (n, d)");
  }
  const std::size_t d = problem.entry->dimension;
  if (d != 0 && rows.first.width != d) {
    throw Error("q: found " + std::to_string(rows.first.width) + " coordinates; allowed " + std::to_string(d));
  }
  if (d == 0 && problem.entry->refused_size) {
    const std::string wrong = problem.entry->refused_size(problem.parameters, rows.first.width);
    if (!wrong.empty()) throw Error("q: " + wrong);
  }
  if (!problem.entry->energy) {
    throw Error(problem.entry->info.name + ": energy and gradient are not available outside a run, because a client " +
                "computes them");
  }
  return rows;
}

std::vector<py::ssize_t> shape_of(const Array& array) { return {array.shape(), array.shape() + array.ndim()}; }

py::object energies(const ChosenProblem& problem, const Array& q, const Array& p) {
  const auto [qs, ps] = states_of(problem, q, p);
  if (q.ndim() == 1) return py::float_(problem.entry->energy(problem.parameters, qs.row(0), ps.row(0)));
  py::array_t<double> all(static_cast<py::ssize_t>(qs.count));
  double* const to = all.mutable_data();
  const py::gil_scoped_release unlocked;
  for (std::size_t k = 0; k < qs.count; ++k) to[k] = problem.entry->energy(problem.parameters, qs.row(k), ps.row(k));
  return all;
}

py::tuple gradients(const ChosenProblem& problem, const Array& q, const Array& p) {
  const auto [qs, ps] = states_of(problem, q, p);
  py::array_t<double> by_q(shape_of(q));
  py::array_t<double> by_p(shape_of(p));
  double* const to_q = by_q.mutable_data();
  double* const to_p = by_p.mutable_data();
  {
    const py::gil_scoped_release unlocked;
    for (std::size_t k = 0; k < qs.count; ++k) {
      const EnergyGradient found = problem.entry->gradient(problem.parameters, qs.row(k), ps.row(k));
      std::copy(found.by_q.begin(), found.by_q.end(), to_q + k * qs.width);
      std::copy(found.by_p.begin(), found.by_p.end(), to_p + k * qs.width);
    }
  }
  return py::make_tuple(by_q, by_p);
}

}  // namespace

void bind_problem(py::module_& m) {
  py::class_<ChosenProblem>(m, "Problem")
      .def(py::init([](const py::dict& table) { return read_problem_tree(table_of(table, "problem")); }))
      .def_property_readonly("name", [](const ChosenProblem& p) { return p.entry->info.name; })
      .def_property_readonly("formula", [](const ChosenProblem& p) { return p.entry->info.formula; })
      .def_property_readonly("parameters", [](const ChosenProblem& p) { return p.parameters; })
      .def_property_readonly("dimension", [](const ChosenProblem& p) { return p.entry->dimension; })
      .def_property_readonly("coordinates",
                             [](const ChosenProblem& p) {
                               if (p.entry->dimension == 0) return std::vector<std::string>();
                               return state_names(*p.entry, p.parameters, p.entry->dimension).q;
                             })
      .def_property_readonly("momenta",
                             [](const ChosenProblem& p) {
                               if (p.entry->dimension == 0) return std::vector<std::string>();
                               return state_names(*p.entry, p.parameters, p.entry->dimension).p;
                             })
      .def_property_readonly("structure",
                             [](const ChosenProblem& p) {
                               py::dict found;
                               const auto& s = p.entry->structure;
                               const auto takes = [&](const char* method) {
                                 return p.entry->accepts(parse_method(method));
                               };
                               found["separable"] = s ? s->separable : takes("verlet");
                               found["quadratic_kinetic"] = s ? s->quadratic_kinetic : takes("rkn8-s19");
                               found["time"] = s ? s->time : false;
                               return found;
                             })
      .def("accepts",
           [](const ChosenProblem& p, const std::string& method) { return p.entry->accepts(parse_method(method)); })
      .def("energy", &energies)
      .def("gradient", &gradients);
}

}  // namespace hamflow::python
