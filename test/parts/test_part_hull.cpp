// The hulls of the search for parts.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "fcl_stpbv/parts/part_hull.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
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
  CHECK(hull.volume < 1e-11);  // the hull's area times 7 nm
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

TEST_CASE("a hull holds all points of what cuts leave, and no more") {
  // Boxes from a cube to a plate a millionth as thick, with points all over their faces and inside, and one
  // corner cut off. The points of the cut are on its plane up to rounding.
  test::Random random(4);
  for (int i = 0; i < 300; ++i) {
    const Vector3d size(1, std::pow(10, random.uniform(-3, 0)), std::pow(10, random.uniform(-6, 0)));
    const Vector3d cut = Vector3d(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    const double level = cut.sum() * random.uniform(0.4, 0.9);
    std::vector<Vector3d> points;
    const auto addOrCut = [&](const Vector3d& p) {
      const double height = cut.dot(p) - level;
      points.push_back((height > 0 ? Vector3d(p * (level / (level + height))) : p).cwiseProduct(size));
    };
    for (int k = 0; k < 8; ++k) addOrCut({double(k & 1), double(k >> 1 & 1), double(k >> 2 & 1)});
    for (int k = 0; k < 150; ++k) {
      Vector3d p(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
      if (k % 5 > 0) p[k % 3] = k % 2;
      addOrCut(p);
    }
    const PartHull hull = partHull(points);
    double above = 0, volume = 0;
    Vector3d closed = Vector3d::Zero();  // sum of the faces' normals times their areas
    for (const Triangle& t : hull.surface) {
      const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
      closed += n;
      volume += t[0].dot(n) / 6;
      for (const Vector3d& p : points) above = std::max(above, n.dot(p - t[0]) / std::max(n.norm(), 1e-12));
    }
    CAPTURE(i, size);
    CHECK(above < 1e-10);  // the plane of a sliver has an error of rounding divided by its sine, which counts
                           // as at least 1e-4
    CHECK(closed.norm() < 1e-14);
    CHECK(std::abs(volume - hull.volume) <= 1e-10 * size.y() * size.x());
  }
}
