// Rocks a box past parallel faces over a plate and prints, at each angle, the gradient of the distance
// with respect to the rocking: from FCL on the polyhedra, and from this library on the STP-BVs over
// them. CSV on standard output. jump_sweep [STEPS]
#include <fcl/narrowphase/distance.h>

#include <cstdio>
#include <memory>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using Eigen::Vector3d;

namespace {

std::shared_ptr<StpBvGeometry> boxGeometry(const Vector3d& side) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(0.5 * side.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return std::make_shared<StpBvGeometry>(StpBv::build(points, {0.01, 10.0}));
}

int sweep(int steps) {
  const double range = 2 * 3.14159265358979323846 / 180;  // rad, on either side of the parallel position
  const auto plate = boxGeometry({0.3, 0.3, 0.1}), box = boxGeometry({0.2, 0.2, 0.2});
  fcl::DistanceRequestd request(true);
  request.distance_tolerance = 1e-10;
  std::printf("angle_deg,fcl_distance,fcl_gradient,stpbv_distance,stpbv_gradient\n");
  for (int k = 0; k <= steps; ++k) {
    const double angle = range * (2.0 * k / steps - 1);
    fcl::Transform3d below = fcl::Transform3d::Identity(), above = below;
    above.translation() = Vector3d(0, 0, 0.2);
    above.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
    fcl::DistanceResultd result;
    const double plain = fcl::distance(plate.get(), below, box.get(), above, request, result);
    // d(distance)/d(angle) = n . (y x (x - o)), as a user of FCL computes it from the witness points.
    const Vector3d normal = (result.nearest_points[1] - result.nearest_points[0]).normalized();
    const double gradient =
        normal.dot(Vector3d::UnitY().cross(result.nearest_points[1] - above.translation()));
    const DistanceAnswer smooth = distance(*plate, below, *box, above);
    std::printf("%.9g,%.12g,%.12g,%.12g,%.12g\n", angle * 180 / 3.14159265358979323846, plain, gradient,
                smooth.distance, smooth.gradient[1][4]);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int steps = 2000;
  fcl_stpbv::tools::Program app(
      "Rocks a 20 cm box over a plate from -2 to 2 degrees and prints CSV: the angle, then distance (m) and "
      "its "
      "derivative with the angle (m/rad) between the polyhedra by FCL and between the STP-BVs.",
      "jump_sweep");
  app.option("STEPS", steps, "Angles, less one").whole(1).shown();
  return app.run(argc, argv, [&] { return sweep(steps); });
}
