// Refuses arguments whose constructor has not run. `Robot.__new__(Robot)` makes such an object, and pybind11
// would pass a pointer to uninitialised memory.
#pragma once

#include <pybind11/pybind11.h>

namespace fcl_stpbv {

/// A class of the module specialises pybind11's caster by this one, before its first use.
template <class Type, bool mayBeNone = false>
struct MadeCaster : pybind11::detail::type_caster_base<Type> {
  bool load(pybind11::handle source, bool convert) {
    using namespace pybind11::detail;
    if (source.is_none() && !mayBeNone) return false;
    if (pybind11::isinstance<Type>(source))
      for (const value_and_holder& part : values_and_holders(reinterpret_cast<instance*>(source.ptr())))
        if (!part.value_ptr()) return false;
    return type_caster_base<Type>::load(source, convert);
  }
};

}  // namespace fcl_stpbv
