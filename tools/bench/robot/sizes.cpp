// Ellipsoids have exactly as many vertices as points, and come as near to each other as the links do.
#include "tools/bench/robot/sizes.h"

#include <Eigen/Geometry>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/convex/hull_graph.h"
#include "test/reference/robots.h"

namespace fcl_stpbv::benchmark {

namespace {

/// A body with an ellipsoid's points. Bodies that are no STP-BVs stay.
Body ellipsoidOf(const Body& body, int subdivisions) {
  const StpBvGeometry* geometry = asStpBv(body.geometry.get());
  if (!geometry) return body;
  const detail::HullGraph& hull = geometry->hull();
  Eigen::AlignedBox3d box;
  for (int v = 0; v < hull.vertexCount(); ++v) box.extend(hull.point(v) + hull.centre());
  test::Cloud points = test::geodesicSphere(1, subdivisions);
  for (Eigen::Vector3d& p : points) p = box.center() + 0.5 * box.sizes().cwiseProduct(p);
  const Radii radii = geometry->volume().radii();
  return test::smoothBody(body.link, body.name, StpBv::build(points, {radii.r, radii.R}), body.pose);
}

}  // namespace

test::Problem withPairs(const test::Problem& robot, std::size_t count) {
  test::Problem result = robot;
  result.pairs.clear();
  for (std::size_t i = 0; i < count; ++i) result.pairs.push_back(robot.pairs[i * robot.pairs.size() / count]);
  return result;
}

test::Problem withEllipsoids(const test::Problem& robot, int subdivisions) {
  test::Problem result = robot;
  RobotGeometry bodies = *robot.geometry;
  for (Body& body : bodies.bodies) body = ellipsoidOf(body, subdivisions);
  result.geometry = std::make_shared<const RobotGeometry>(std::move(bodies));
  return result;
}

double meanVertices(const test::Problem& robot) {
  double sum = 0;
  for (const Body& body : robot.geometry->bodies)
    if (const StpBvGeometry* geometry = asStpBv(body.geometry.get())) sum += geometry->hull().vertexCount();
  return sum / static_cast<double>(robot.geometry->bodies.size());
}

}  // namespace fcl_stpbv::benchmark
