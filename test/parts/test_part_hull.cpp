// The hulls of the search for parts.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "fcl_stpbv/parts/part_hull.h"

using namespace fcl_stpbv::detail;
using Eigen::Vector3d;

TEST_CASE("a nearly flat cloud has a hull") {
  // Seven points of JVRC-1's L_ANKLE_P, 7 nm off a plane.
  const std::vector<Vector3d> points{{-0.031999979168176651, 0.0067450362257659435, -0.084174789488315582},
                                     {-0.031999971717596054, -0.0024469145573675632, -0.075162507593631744},
                                     {-0.031999979168176651, -0.0023415547329932451, -0.092878125607967377},
                                     {-0.031999971717596054, -0.019043372943997383, -0.038485251367092133},
                                     {-0.031999971717596054, -0.023986427113413811, -0.038109373301267624},
                                     {-0.031999971717596054, 0.020795570686459541, -0.041514702141284943},
                                     {-0.031999971717596054, 0.025780756026506424, -0.041893791407346725}};
  const PartHull hull = partHull(points);
  CHECK(hull.diagonal() == Approx((Vector3d(0, 0.025780756026506424, -0.038109373301267624) -
                                   Vector3d(0, -0.023986427113413811, -0.092878125607967377))
                                      .norm()));
  CHECK(hull.volume < 1e-11);  // its area times 7 nm
}

TEST_CASE("a flat cloud, a segment and a point have hulls of no volume") {
  const std::vector<Vector3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
  CHECK(partHull(square).vertices.size() == 4);
  CHECK(partHull(square).volume == 0);
  CHECK(partHull({{0, 0, 0}, {0.3, 0.1, 0.2}, {0.9, 0.3, 0.6}}).diagonal() == Approx(std::sqrt(1.26)));
  CHECK(partHull({{1, 2, 3}}).diagonal() == 0);
}

TEST_CASE("a cube's hull") {
  std::vector<Vector3d> points{{0.5, 0.5, 0.5}};
  for (int k = 0; k < 8; ++k) points.push_back(Vector3d(k & 1, k >> 1 & 1, k >> 2 & 1));
  const PartHull hull = partHull(points);
  CHECK(hull.vertices.size() == 8);
  CHECK(hull.volume == Approx(1));
  CHECK(hull.diagonal() == Approx(std::sqrt(3.0)));
}
