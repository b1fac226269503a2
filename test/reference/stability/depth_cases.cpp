// Bodies deep in each other: containment, coincident centres, identical bodies in one pose.
#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Random;

void addDepths(std::vector<Situation>& all, std::uint64_t seed) {
  Random random(seed + 2);
  const StpBvOptions usual{0.01, 10.0};
  struct Shape {
    const char* name;
    Cloud cloud;
  };
  const std::vector<Shape> shapes{{"box", test::box(0.3, 0.2, 0.5)},
                                  {"cube", test::box(0.2, 0.2, 0.2)},
                                  {"plate", test::plate(0.3, 0.2)},
                                  {"needle", test::needle(0.5)},
                                  {"icosahedron", test::geodesicSphere(0.15, 0)},
                                  {"random hull", test::randomHull(14, {0.2, 0.15, 0.1}, seed)}};
  const auto pair = [&](const char* group, const std::string& name, const Shape& a, const Shape& b,
                        std::vector<Placement> placements) {
    Situation s;
    s.group = group;
    s.name = name;
    s.a = makeBody(a.cloud, usual);
    s.b = makeBody(b.cloud, usual);
    s.placements = std::move(placements);
    all.push_back(std::move(s));
  };
  const Matrix3d one = Matrix3d::Identity();
  const Vector3d origin(0, 0, 0);
  for (const Shape& shape : shapes) {
    const Matrix3d turned = random.rotation();
    const auto same = test::pose(turned, 0.3 * random.direction());
    pair("identical bodies in one pose", shape.name, shape, shape,
         {{test::pose(one, origin), test::pose(one, origin)}, {same, same}});
    pair("coincident centres", shape.name + std::string(" in itself, turned"), shape, shape,
         {{test::pose(one, origin), test::pose(turned, origin)},
          {test::pose(one, origin), test::pose(random.rotation(), origin)}});
    const Shape small{shape.name, [&] {
                        Cloud cloud = shape.cloud;
                        for (Vector3d& p : cloud) p *= 0.2;
                        return cloud;
                      }()};
    pair("containment", std::string("a small ") + shape.name + " in the cube", shapes[1], small,
         {{test::pose(one, origin), test::pose(turned, {0.01, 0.02, 0.005})},
          {test::pose(turned, origin), test::pose(one, {0.03, -0.01, 0.02})}});
    pair("deep overlap", std::string(shape.name) + " in the cube", shapes[1], shape,
         {{test::pose(turned, origin), test::pose(random.rotation(), 0.06 * random.direction())},
          {test::pose(one, origin), test::pose(random.rotation(), 0.09 * random.direction())}});
  }
}

}  // namespace fcl_stpbv::stability
