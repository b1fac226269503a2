// What the answers are measured against: long double, with a proof of its own.
#pragma once

#include "test/reference/reference.h"
#include "tools/bench/method.h"

namespace fcl_stpbv::benchmark {

/// The right answer to one query, where it could be proven.
struct Truth {
  bool proven = false;  ///< bodies (of STP-BVs: their cores) apart, and the two bounds agree to rounding
  long double distance = 0;
  test::Vector3L normal{0, 0, 0};
};

/// Of the STP-BVs: test/reference/reference.h, which shares nothing with the library.
Truth smoothTruth(const Bodies& bodies, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

/// Of the polyhedra: the nearest points of the spans of two features, solved in long double; proven by the
/// plane between them, which no vertex of either body crosses.
Truth polyhedralTruth(const Bodies& bodies, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

/// One answer's errors.
struct Errors {
  double distance;  ///< m
  double normal;    ///< chord between the unit normals, rad for the small angles that occur
};

Errors errorsOf(const Answer& answer, const Truth& truth);

}  // namespace fcl_stpbv::benchmark
