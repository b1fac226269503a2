// The bound on which proofs are based, compared with samples: random pairs of robots, random boxes of joint
// values.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/pair_proof.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

struct BoundTrials {
  long samples = 0, violations = 0;
  double tightest = 1e300;  ///< least difference of a sample's distance and its box's bound (m)
  double useful = 0;        ///< share of the boxes whose bound is above half the distance at their middle
};

/// The scene of a robot given as a URDF's text.
ProofScene proofSceneOf(const std::string& urdf, std::vector<Obstacle> obstacles = {});

/// A robot of primitives with turning, sliding and mimic joints, among obstacles of its own.
ProofScene primitiveScene();

/// Tests boxes of all sizes up to the joints' ranges: the middle of each, corners and points in between.
BoundTrials tryBounds(const ProofScene& scene, const std::vector<LinkPair>& pairs, int boxes, Random& random);

/// All pairs of a scene whose distance some joint can change.
std::vector<LinkPair> movingPairs(const ProofScene& scene);

}  // namespace fcl_stpbv::test
