// Orbital elements of states, and states of orbits, for arrays.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/orbits/element_table.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::dict elements(const Array& position, const Array& velocity, const Array& mu) {
  const auto count = static_cast<std::size_t>(mu.size());
  py::dict all;
  std::vector<std::pair<double*, double OrbitalElements<double>::*>> to;
  for (const ElementColumn& column : element_columns()) {
    py::array_t<double> values(static_cast<py::ssize_t>(count));
    to.emplace_back(values.mutable_data(), column.value);
    all[column.name] = values;
  }
  const double* const r = position.data();
  const double* const v = velocity.data();
  const double* const m = mu.data();
  const py::gil_scoped_release unlocked;
  for (std::size_t i = 0; i < count; ++i) {
    const OrbitalElements<double> found = elements_of(Vector<double, 3>{r[3 * i], r[3 * i + 1], r[3 * i + 2]},
                                                      Vector<double, 3>{v[3 * i], v[3 * i + 1], v[3 * i + 2]}, m[i]);
    for (const auto& [values, member] : to) values[i] = found.*member;
  }
  return all;
}

py::tuple states(const Array& mu, const std::map<std::string, Array>& given, const Array& t) {
  const auto count = static_cast<std::size_t>(mu.size());
  const std::vector<std::string> keys = orbit_keys();
  for (const auto& [key, values] : given) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    throw Error("found the argument " + key + "; allowed " + joined(keys) + suggestion(key, keys));
  }
  py::array_t<double> position({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  py::array_t<double> velocity({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  double* const r = position.mutable_data();
  double* const v = velocity.mutable_data();
  for (std::size_t i = 0; i < count; ++i) {
    Orbit<double> orbit;
    for_each_key(orbit, [&](const char* key, auto& to) {
      if (const auto found = given.find(key); found != given.end()) to = found->second.data()[i];
    });
    const std::string of = count > 1 ? " of orbit " + std::to_string(i) : "";
    if (!(mu.data()[i] > 0)) throw Error("mu: found " + shortest(mu.data()[i]) + of + "; allowed a positive number");
    if (const auto wrong = complaints_about(orbit); !wrong.empty()) {
      throw Error(wrong.front().key + of + ": " + wrong.front().message);
    }
    const auto state = state_on(orbit, mu.data()[i], t.data()[i]);
    if (!state)
      throw Error("found an orbit" + of + " whose position or velocity is not finite; allowed smaller numbers");
    for (std::size_t k = 0; k < 3; ++k) {
      r[3 * i + k] = state->position[k];
      v[3 * i + k] = state->velocity[k];
    }
  }
  return py::make_tuple(position, velocity);
}

}  // namespace

void bind_orbits(py::module_& m) {
  m.def("elements", elements);
  m.def("orbit_states", states);
}

}  // namespace hamflow::python
