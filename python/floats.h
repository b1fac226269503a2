// Array arguments from Python: arrays of floats, or lists of numbers. Other types are refused, because NumPy
// would silently convert strings, booleans and complex numbers to floats, and an array of integers is usually
// a mistake.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// An argument that is a matrix or a vector.
template <class Matrix>
struct Floats {
  Matrix value;
};

/// @throws Error naming the argument.
template <class Numbers>
void requireFinite(const Numbers& numbers, const char* name) {
  if (!numbers.allFinite()) throw Error(std::string(name) + ": holds a number that is not finite");
}

/// @throws Error naming the argument, unless it has exactly `count` numbers, all finite.
inline void requireNumbers(const Eigen::VectorXd& numbers, Eigen::Index count, const char* name) {
  if (numbers.size() != count)
    throw Error(std::string(name) + ": got " + std::to_string(numbers.size()) + " numbers, expected " +
                std::to_string(count));
  requireFinite(numbers, name);
}

}  // namespace fcl_stpbv

namespace pybind11::detail {

template <class Matrix>
struct type_caster<fcl_stpbv::Floats<Matrix>> {
  PYBIND11_TYPE_CASTER(fcl_stpbv::Floats<Matrix>, make_caster<Matrix>::name);

  bool load(handle source, bool) {
    const bool given = isinstance<array>(source);
    const array numbers = given ? reinterpret_borrow<array>(source) : array::ensure(source);
    if (!numbers) {
      PyErr_Clear();
      return false;
    }
    if (given && Py_TYPE(source.ptr()) != npy_api::get().PyArray_Type_ && hasattr(source, "mask"))
      throw type_error("got a masked array; fill it, as with filled(value), so that every number counts");
    const char kind = numbers.dtype().kind();
    const bool fits = kind == 'f' && numbers.itemsize() <= static_cast<ssize_t>(sizeof(double));
    const bool listed = !given && (kind == 'i' || kind == 'u');
    if (!fits && !listed) {
      const std::string of = " of " + std::string(str(numbers.dtype()));
      if (given)
        throw type_error("got an array" + of +
                         ", expected floats; convert it with astype(float) if that is what is meant");
      throw type_error("got " + std::string(Py_TYPE(source.ptr())->tp_name) + (numbers.ndim() > 0 ? of : "") +
                       ", expected an array of floats or a list of numbers");
    }
    if constexpr (Matrix::RowsAtCompileTime == Eigen::Dynamic && Matrix::ColsAtCompileTime > 1)
      if (!given && numbers.size() == 0) {  // an empty list, whose rows have no known length
        value.value.resize(0, Matrix::ColsAtCompileTime);
        return true;
      }
    make_caster<Matrix> inner;
    if (!inner.load(numbers, true)) {
      if (Matrix::RowsAtCompileTime == Eigen::Dynamic && Matrix::ColsAtCompileTime == 1 && numbers.ndim() > 1)
        throw type_error("got an array of shape " + std::string(str(numbers.attr("shape"))) +
                         ", expected a 1-D one; distances_many, evaluate_many and collides_many take many q");
      return false;
    }
    value.value = cast_op<Matrix>(std::move(inner));
    return true;
  }
};

}  // namespace pybind11::detail
