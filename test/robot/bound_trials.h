// The bound that proofs rest on, held against samples: random pairs of robots, random boxes of joint values.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/pair_proof.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

struct BoundTrials {
  long samples = 0, violations = 0;
  double tightest = 1e300;  ///< least of a sample's distance less its box's bound (m)
  double useful = 0;        ///< part of the boxes whose bound is above half the distance in their middle
};

/// The scene of a robot given as a URDF's text.
ProofScene proofSceneOf(const std::string& urdf, std::vector<Obstacle> obstacles = {});

/// A robot of primitives with turning, sliding and mimic joints, among obstacles of its own.
ProofScene primitiveScene();

/// Boxes of all sizes up to the joints' ranges; of each, its middle, corners and points in between.
BoundTrials tryBounds(const ProofScene& scene, const std::vector<LinkPair>& pairs, int boxes, Random& random);

/// All pairs of a scene that some joint can change.
std::vector<LinkPair> movingPairs(const ProofScene& scene);

}  // namespace fcl_stpbv::test
