// Support function of a ball hull by trying all vertices, pairs and triples of points: the definition itself,
// in long double, sharing nothing with the library.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::test {

/// h(n) = R + min over the admissible centres C of n.C (docs/theory.md, 1). The minimum rests on one, two or
/// three points' balls; every candidate that lies in all balls is tried. O(N^4).
long double bruteSupport(const std::vector<Eigen::Vector3d>& points, double r, double R,
                         const Eigen::Vector3d& n);

}  // namespace fcl_stpbv::test
