#include <fathom/client.hpp>

#include "python/core.hpp"
#include "python/values.hpp"

namespace fathom::python {
namespace {

/// Sets the exception as the interpreter's and has it told by sys.unraisablehook.
void report(const py::object& exception, const py::object& where) {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
  PyErr_WriteUnraisable(where.ptr());
}

py::object judgement(py::handle state, py::handle age_s, py::handle limits) {
  std::optional<NavState> judged;
  if (!state.is_none()) {
    if (!py::isinstance<NavState>(state)) wrong_type("judge: state", "a fathom.NavState or None", state);
    judged = state.cast<const NavState&>();
  }
  HealthLimits held_against;
  if (!limits.is_none()) {
    if (!py::isinstance<HealthLimits>(limits))
      wrong_type("judge: limits", "a fathom.HealthLimits or None", limits);
    held_against = limits.cast<HealthLimits>();
  }
  return py::cast(judge(judged, number_from(age_s, "judge: age_s"), held_against));
}

}  // namespace
}  // namespace fathom::python

PYBIND11_MODULE(_native, module) {
  using namespace fathom::python;
  py::options options;
  options.disable_function_signatures();
  module.doc() = "The compiled part of the package fathom; not for use by itself.";
  module.attr("__version__") = FATHOM_VERSION;
  add_values(module, make_kit(module));
  add_core(module);
  module.def("judge", &judgement, py::arg("state"), py::arg("age_s"), py::arg("limits") = py::none(),
             "Judges a state by the limits; `age_s` is seconds since its arrival, NaN when there is none.\n\n"
             "What Client.health() says, as a pure function.");
  module.def("report", &report);
}
