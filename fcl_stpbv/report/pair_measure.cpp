// A pair in one configuration.
// 1. Distance, normal and gradient of its bodies.
// 2. The over-cover of each body along that normal: the difference of two support functions.
// 3. The distance of the shapes that the bodies cover, hulls and primitives, if these are apart.
#include "fcl_stpbv/report/pair_measure.h"

#include <algorithm>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// A body or an obstacle at its pose, and the shape that it covers: a primitive, or the hull of all points of
// the mesh as a polyhedron. It is the same hull for a reduced volume.
struct Placed {
  const fcl::CollisionGeometryd* body;
  std::shared_ptr<const fcl::CollisionGeometryd> hull;
  Eigen::Isometry3d pose;

  double cover(const Eigen::Vector3d& normal) const {
    const StpBvGeometry* smooth = asStpBv(body);
    if (normal.isZero() || !smooth) return 0;
    const Eigen::Vector3d n = pose.linear().transpose() * normal;
    Shape covered;
    if (!shapeOf(*hull, covered)) return 0;
    return std::max(0.0, smooth->volume().support(n) - n.dot(covered.support(n)) - covered.margin);
  }
};

template <typename Placeable>  // a Body or an Obstacle
Placed placed(const Placeable& body, const std::shared_ptr<const fcl::CollisionGeometryd>& geometry,
              const Eigen::Isometry3d& pose) {
  std::shared_ptr<const fcl::CollisionGeometryd> hull = geometry;
  if (body.primitive) hull = body.primitive;
  if (body.full) hull = body.full;
  return {geometry.get(), hull, pose};
}

Placed placed(const Body& body, const Kinematics::State& state) {
  return placed(body, body.geometry, state.link[at(body.link)] * body.pose);
}

Placed placed(const Obstacle& obstacle) { return placed(obstacle, obstacle.geometry(), obstacle.pose()); }

void covers(const CollisionReport& report, const CheckedPair& both, const Kinematics::State& state,
            PairReport& pair) {
  const Placed first = placed(report.geometry->bodies[at(both.body)], state);
  const Placed second = both.obstacle ? placed(report.obstacles[at(both.other)])
                                      : placed(report.geometry->bodies[at(both.other)], state);
  pair.overCover1 = first.cover(pair.answer.normal);
  pair.overCover2 = second.cover(-pair.answer.normal);
  const auto margin = [](const Placed& body) {
    const StpBvGeometry* smooth = asStpBv(body.body);
    return smooth ? smooth->volume().radii().r : 0.0;
  };
  pair.lipschitz = 1 / (margin(first) + margin(second));
  pair.hullDistance = std::numeric_limits<double>::quiet_NaN();
  Shape a, b;
  if (!shapeOf(*first.hull, a) || !shapeOf(*second.hull, b)) return;
  if (isFartherThan(0.0, a, first.pose, b, second.pose))  // the depth would take long and is not needed
    pair.hullDistance = distance(a, first.pose, b, second.pose).distance;
}

}  // namespace

void measurePair(const CollisionReport& report, const std::vector<CheckedPair>& bodies, PairReport& pair) {
  ConstraintOptions options;
  options.obstacles = report.obstacles;
  CollisionConstraints constraints(report.kinematics, report.geometry, bodies, options);
  Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros());
  constraints.evaluateValues(pair.configuration, d, values);
  Eigen::Index row;
  d.minCoeff(&row);
  pair.answer = constraints.answer(static_cast<int>(row));
  const CheckedPair& closest = bodies[static_cast<std::size_t>(row)];
  pair.body1 = closest.body;
  pair.body2 = closest.other + (closest.obstacle ? static_cast<int>(report.geometry->bodies.size()) : 0);
  for (int k = constraints.rowStart()[static_cast<std::size_t>(row)];
       k < constraints.rowStart()[static_cast<std::size_t>(row) + 1]; ++k)
    pair.gradient[report.kinematics->names()[at(constraints.columnIndices()[at(k)])]] = values[k];
  covers(report, closest, constraints.state(), pair);
}

}  // namespace fcl_stpbv::report
