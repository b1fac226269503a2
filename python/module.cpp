// The Python module: volumes, distances, robots and batch work, with NumPy arrays as inputs and outputs.
#include <algorithm>
#include <exception>

#include "fcl_stpbv/error.h"
#include "loading.h"
#include "parts.h"

namespace {

namespace py = pybind11;

// Translates Error. Messages may name files that are not UTF-8; pybind11's own translation would drop the
// message.
void addError(py::module_& module) {
  static const py::handle error =
      py::exception<fcl_stpbv::Error>(module, "Error", PyExc_RuntimeError).release();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const fcl_stpbv::Error& e) {
      PyErr_SetObject(error.ptr(), fcl_stpbv::decoded(e.what()).ptr());
    }
  });
}

// Refuses protocols below 2: with them Python's pickle makes an object without pybind11, which ends the
// interpreter.
void addPickling(py::module_& module) {
  const py::object reduce = py::module_::import("builtins").attr("object").attr("__reduce_ex__");
  const py::type ours = py::type::of(module.attr("StpBv"));
  for (const auto& [name, member] : py::dict(module.attr("__dict__")))
    if (py::type::handle_of(member).is(ours))
      member.attr("__reduce_ex__") = py::cpp_function(
          [reduce](const py::object& self, int protocol) { return reduce(self, std::max(protocol, 2)); },
          py::name("__reduce_ex__"), py::is_method(member));
}

ternaryfunc callOfClass;  // the function of pybind11, shared by all modules made with it

// Refuses to make an object of the base class of all classes, because pybind11 would throw through Python's C
// code, which ends the interpreter. object.__reduce__() calls it too.
PyObject* callOfMade(PyObject* type, PyObject* arguments, PyObject* names) {
  if (!py::detail::all_type_info(reinterpret_cast<PyTypeObject*>(type)).empty())
    return callOfClass(type, arguments, names);
  PyErr_Format(PyExc_TypeError, "%s: No constructor defined!",
               reinterpret_cast<PyTypeObject*>(type)->tp_name);
  return nullptr;
}

void guardBase(py::module_& module) {
  PyTypeObject* classes = Py_TYPE(module.attr("StpBv").ptr());
  if (classes->tp_call == callOfMade) return;
  callOfClass = classes->tp_call;
  classes->tp_call = callOfMade;
}

}  // namespace

PYBIND11_MODULE(fcl_stpbv, module) {
  module.doc() =
      "Distances with continuous gradients between sphere-torus-patch bounding volumes. Metres, radians.";
  module.attr("__version__") = FCL_STPBV_VERSION;
  addError(module);
  fcl_stpbv::addVolume(module);
  fcl_stpbv::addRobot(module);
  fcl_stpbv::addShards(module);
  fcl_stpbv::addPostures(module);
  addPickling(module);
  guardBase(module);
}
