// What the right answers are, in long double and by other means than the library's.
//
// The smooth bodies: test/reference/reference.h. The polyhedra: apart, the point nearest to the origin in the
// differences of their corners, by Wolfe's active sets; overlapping, the least overlap over every normal that
// can be the least, tried one by one. None of it shares code with the solver.
#pragma once

#include <optional>

#include "test/reference/reference.h"
#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using test::Vector3L;

/// Of two STP-BVs at one placement.
struct SmoothTruth {
  bool known = false;        ///< the cores are apart and the reference proved its answer
  long double distance = 0;  ///< signed, where known
  Vector3L normal{0, 0, 0};  ///< from a to b, where known
  long double widest = 0;  ///< else: the widest gap found over many directions, a lower bound of the distance
};

/// Of two polyhedra at one placement.
struct SharpTruth {
  bool known = false;        ///< `distance` is right; else only `overlap` is
  bool overlap = false;      ///< share a point
  long double distance = 0;  ///< signed: negative is the least translation that separates
  Vector3L normal{0, 0, 0};  ///< from a to b where apart
};

SmoothTruth smoothTruth(const Situation& situation, const Placement& at);
SharpTruth sharpTruth(const Situation& situation, const Placement& at);

/// The gap between the STP-BVs' supporting planes along a unit normal from a
/// to b: a lower bound of the distance.
long double smoothGap(const Situation& situation, const Placement& at, const Eigen::Vector3d& normal);

}  // namespace fcl_stpbv::stability
