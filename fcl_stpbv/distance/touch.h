// Two bodies at an answer: how a small motion of both turns the normal between their features.
#pragma once

#include <Eigen/Geometry>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/turning.h"

namespace fcl_stpbv::detail {

/// Two bodies at an answer. The normal moves with body 2 and turns relative to it by `tau`, which maximises s
/// over the possible turns:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
struct Touch {
  Turning meeting;
  Eigen::Vector3d armA, fromB;  // body 1's witness point relative to both origins
};

/// The touch of two bodies, each an STP-BV or a shape, at the answer `d`. Rotations are corrected as in the
/// query. False if second derivatives do not exist.
template <typename A, typename B>
bool touchOf(const A& a, const Eigen::Isometry3d& poseA, const B& b, const Eigen::Isometry3d& poseB,
             const Distance& d, Touch& touch);

}  // namespace fcl_stpbv::detail
