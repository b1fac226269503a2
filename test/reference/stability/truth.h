// The right answers, in long double and by other methods than the library's.
//
// The smooth bodies: test/reference/reference.h. The polyhedra, if apart: the point nearest to the origin in
// the differences of their corners, by Wolfe's active sets. If overlapping: the least overlap over every
// normal that can be the least, tried one by one. None of this shares code with the solver.
#pragma once

#include <optional>

#include "test/reference/reference.h"
#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using test::Vector3L;

/// The truth about two STP-BVs at one placement.
struct SmoothTruth {
  bool known = false;        ///< the cores are apart and the reference proved its answer
  long double distance = 0;  ///< signed; set if `known`
  Vector3L normal{0, 0, 0};  ///< from a to b; set if `known`
  long double widest = 0;  ///< otherwise: the widest gap over many directions, a lower bound on the distance
};

/// The truth about two polyhedra at one placement.
struct SharpTruth {
  bool known = false;        ///< whether `distance` is right; otherwise only `overlap` is
  bool overlap = false;      ///< whether they share a point
  long double distance = 0;  ///< signed; a negative value is the least translation that separates them
  Vector3L normal{0, 0, 0};  ///< from a to b, if they are apart
};

SmoothTruth smoothTruth(const Situation& situation, const Placement& at);
SharpTruth sharpTruth(const Situation& situation, const Placement& at);

/// The gap between the STP-BVs' supporting planes along a unit normal from a
/// to b: a lower bound of the distance.
long double smoothGap(const Situation& situation, const Placement& at, const Eigen::Vector3d& normal);

}  // namespace fcl_stpbv::stability
