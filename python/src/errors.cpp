// Translates C++ exceptions to the classes of hamflow/_errors.py.
#include <filesystem>

#include "bindings.hpp"
#include "hamflow/core/complaint.hpp"
#include "hamflow/core/error.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// Raises an exception of the named class of hamflow._errors.
template <class... Args>
void raise(const char* name, Args&&... args) {
  try {
    const py::object type = py::module_::import("hamflow._errors").attr(name);
    const py::object error = type(std::forward<Args>(args)...);
    PyErr_SetObject(type.ptr(), error.ptr());
  } catch (py::error_already_set& trouble) {
    trouble.restore();
  }
}

}  // namespace

void bind_errors(py::module_& /*m*/) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Rejection& rejection) {
      py::list all;
      for (const Complaint& complaint : rejection.complaints)
        all.append(py::make_tuple(complaint.key, complaint.message));
      raise("Rejection", all);
    } catch (const FileError& error) {
      raise("FileError", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      raise("FileError", error.path1().string() + ": " + error.code().message());
    } catch (const Error& error) {
      raise("Error", error.what());
    }
  });
}

}  // namespace hamflow::python
