// Pairs of polyhedra on which FCL 0.7 is known to fail, with their true distances.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

struct HardCase {
  std::string name;
  Cloud first, second;
  Eigen::Isometry3d pose1, pose2;
  double distance;   ///< signed distance of the sharp polyhedra
  double tolerance;  ///< accuracy of the distance
};

/// Separated or touching pairs for which FCL is wrong because it stops on equal norms
/// (flexible-collision-library/fcl#508).
std::vector<HardCase> equalNormCases();

/// Overlapping pairs from field reports (RobotLocomotion/drake#21673, #21234), with the distances of FCL's
/// later regression tests, read from data/hard_cases/fcl_field_cases.txt.
std::vector<HardCase> fieldCases(const std::string& path);

}  // namespace fcl_stpbv::test
