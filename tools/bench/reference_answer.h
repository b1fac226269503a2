// Reference answers in long double, with proofs of their own, to which the answers of the methods are
// compared.
#pragma once

#include "test/reference/reference.h"
#include "tools/bench/method.h"

namespace fcl_stpbv::benchmark {

/// The right answer to one query, if it could be proven.
struct Truth {
  bool proven = false;  ///< whether the bodies (of STP-BVs: their cores) are apart, and the two bounds agree
                        ///< to rounding
  long double distance = 0;
  test::Vector3L normal{0, 0, 0};
};

/// For the STP-BVs, by test/reference/reference.h, which shares no code with the library.
Truth smoothTruth(const Bodies& bodies, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

/// For the polyhedra: the nearest points of the spans of two features, solved in long double. The plane
/// between them, which no vertex of either body crosses, proves the result.
Truth polyhedralTruth(const Bodies& bodies, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

/// One answer's errors.
struct Errors {
  double distance;  ///< m
  double normal;    ///< chord between the unit normals; rad for the small angles that occur
};

Errors errorsOf(const Answer& answer, const Truth& truth);

}  // namespace fcl_stpbv::benchmark
