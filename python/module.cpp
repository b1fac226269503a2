// The Python module: volumes, distance, robots and what is shared out of them, with NumPy arrays in and out.
#include "fcl_stpbv/error.h"
#include "parts.h"

PYBIND11_MODULE(fcl_stpbv, module) {
  module.doc() =
      "Distances with continuous gradients between sphere-torus-patch bounding volumes. Metres, radians.";
  module.attr("__version__") = FCL_STPBV_VERSION;
  pybind11::register_exception<fcl_stpbv::Error>(module, "Error", PyExc_RuntimeError);
  fcl_stpbv::addVolume(module);
  fcl_stpbv::addRobot(module);
  fcl_stpbv::addShards(module);
  fcl_stpbv::addPostures(module);
}
