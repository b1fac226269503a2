// Support function of a ball hull by trying all vertices, pairs and triples of points: directly from the
// definition, in long double, with no code of the library.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::test {

/// h(n) = R + min over the admissible centres C of n.C (docs/theory.md, 1). The minimum is determined by one,
/// two or three points' balls. Every candidate that lies in all balls is tried. O(N^4).
long double bruteSupport(const std::vector<Eigen::Vector3d>& points, double r, double R,
                         const Eigen::Vector3d& n);

}  // namespace fcl_stpbv::test
