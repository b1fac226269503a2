// A robot with fewer pairs, or with bodies of another number of vertices, for times against these numbers.
#pragma once

#include "tools/bench/robot/peer.h"

namespace fcl_stpbv::benchmark {

/// The robot with `count` of its pairs, evenly spaced in its list.
test::Problem withPairs(const test::Problem& robot, std::size_t count);

/// The robot with the points of an ellipsoid for each hull, within the box around the hull: 12, 42, 162, ...
/// vertices.
test::Problem withEllipsoids(const test::Problem& robot, int subdivisions);

/// Mean number of vertices of the bodies.
double meanVertices(const test::Problem& robot);

}  // namespace fcl_stpbv::benchmark
