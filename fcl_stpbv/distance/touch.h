// Two bodies at an answer: what a small motion of both does to the normal between their features.
#pragma once

#include <Eigen/Geometry>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/turning.h"

namespace fcl_stpbv::detail {

/// Two bodies at an answer. The normal is carried by body 2 and turns in it by `tau`, the maximum of s over
/// the ways it may:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
struct Touch {
  Turning meeting;
  Eigen::Vector3d armA, fromB;  // body 1's witness point from both origins
};

/// The touch of two bodies, each an STP-BV or a shape, at the answer `d`; rotations are mended as they were
/// for it. False where second derivatives do not exist.
template <typename A, typename B>
bool touchOf(const A& a, const Eigen::Isometry3d& poseA, const B& b, const Eigen::Isometry3d& poseB,
             const Distance& d, Touch& touch);

}  // namespace fcl_stpbv::detail
