// shape_differences [POSES]: the tables of docs/fcl_accuracy.md. A sphere is both an FCL shape and the STP-BV
// of one point, so plain FCL and this library answer about exactly the same bodies. A cube rocks over each
// shape, as a polyhedron and as an STP-BV, to show whose gradient jumps.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "test/reference/arguments.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

using Named = std::vector<std::pair<const char*, std::shared_ptr<fcl::CollisionGeometryd>>>;

std::shared_ptr<fcl::CollisionGeometryd> meshOf(const fcl::Convexd& hull) {
  auto mesh = std::make_shared<fcl::BVHModel<fcl::RSSd>>();
  std::vector<fcl::Triangle> triangles;
  const std::vector<int>& faces = hull.getFaces();
  for (std::size_t at = 0; at < faces.size(); at += static_cast<std::size_t>(faces[at]) + 1)
    for (int k = 2; k < faces[at]; ++k) {
      const auto corner = [&](int i) {
        return static_cast<std::size_t>(faces[at + 1 + static_cast<std::size_t>(i)]);
      };
      triangles.emplace_back(corner(0), corner(k - 1), corner(k));
    }
  mesh->beginModel();
  mesh->addSubModel(hull.getVertices(), triangles);
  mesh->endModel();
  return mesh;
}

Named shapesAlongX() {
  const auto hull = hullGeometry(box(0.3, 0.2, 0.1));
  return {{"sphere", std::make_shared<fcl::Sphered>(0.2)},
          {"capsule", std::make_shared<fcl::Capsuled>(0.1, 0.4)},
          {"box", std::make_shared<fcl::Boxd>(0.3, 0.2, 0.1)},
          {"cylinder", std::make_shared<fcl::Cylinderd>(0.2, 0.3)},
          {"cone", std::make_shared<fcl::Coned>(0.2, 0.3)},
          {"ellipsoid", std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3)},
          {"convex", hull},
          {"mesh (RSS)", meshOf(*hull)}};
}

// Rocks a cube by 4 degrees in both directions, 5 cm over the shape, with the shape's axis or longest side
// below one of its faces. Measures the largest change of the distance's derivative with respect to the cube's
// twist, [normal; arm x normal], in one of `steps` steps, and the angle where it occurs.
struct Jump {
  double change = 0, angle = 0;
  int failed = 0;
};

template <class Gradient>
Jump rock(int steps, const Gradient& gradient) {
  constexpr double kTilt = 4 * M_PI / 180;
  Jump jump;
  TwistGradient last = TwistGradient::Zero(), g;
  for (int i = 0; i <= steps; ++i) {
    const double angle = kTilt * (2.0 * i / steps - 1) + 1e-4;
    if (!gradient(angle, g)) {
      ++jump.failed;
      last.setZero();
      continue;
    }
    if (const double change = (g - last).norm(); !last.isZero() && change > jump.change)
      jump.change = change, jump.angle = angle;
    last = g;
  }
  return jump;
}

void jumps() {
  const StpBvGeometry cube(StpBv::build(box(0.2, 0.2, 0.2), {0.01, 10}));
  std::printf(
      "\n| shape | FCL, 1000 steps | 10,000 steps | at (rad) | failed | STP-BV, 1000 steps | 10,000 steps "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const auto& [name, shape] : shapesAlongX()) {
    const bool round = shape->getNodeType() == fcl::GEOM_CAPSULE ||
                       shape->getNodeType() == fcl::GEOM_CYLINDER || shape->getNodeType() == fcl::GEOM_CONE ||
                       shape->getNodeType() == fcl::GEOM_ELLIPSOID;
    Eigen::Isometry3d below = Eigen::Isometry3d::Identity();
    if (round) below.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
    if (shape->getNodeType() == fcl::GEOM_CONE)  // turn its generator level
      below.linear() = Eigen::AngleAxisd(-std::atan2(0.2, 0.3), Eigen::Vector3d::UnitY()) * below.linear();
    const auto at = [&](double angle) {
      return pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix(), {0, 0, 0.35});
    };
    const auto plain = [&](double angle, TwistGradient& g) {
      fcl::DistanceResultd result;
      try {
        fcl::distance(shape.get(), below, &static_cast<const fcl::Convexd&>(cube), at(angle),
                      fcl::DistanceRequestd(true), result);
      } catch (...) {
        return false;
      }
      const Eigen::Vector3d n = (result.nearest_points[1] - result.nearest_points[0]).normalized();
      g << n, (result.nearest_points[1] - at(angle).translation()).cross(n);
      return result.min_distance > 0 && g.allFinite();
    };
    const auto smooth = [&](double angle, TwistGradient& g) {
      const DistanceAnswer answer = distance(*shape, below, cube, at(angle));
      g = answer.gradient[1];
      return answer.status == DistanceStatus::exact;
    };
    const Jump few = rock(1000, plain), many = rock(10000, plain), ours = rock(1000, smooth),
               finer = rock(10000, smooth);
    std::printf("| %s | %.1e | %.1e | %.5f | %d | %.1e | %.1e |\n", name, few.change, many.change, many.angle,
                few.failed + many.failed + ours.failed + finer.failed, ours.change, finer.change);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int poses = test::Arguments(argc, argv, "[POSES]", 1).number(1, 2000);
  const fcl::Sphered ball(0.1);
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));
  std::printf(
      "| shape | tolerance | over 1e-6 m | worst (m) | throws | -1 apart | bad points | worst at |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, shape] : shapesAlongX())
    for (const double tolerance : {1e-6, 1e-10}) {
      Random random(1);
      int wrong = 0, thrown = 0, lost = 0, garbage = 0;
      double worst = 0;
      Eigen::Vector3d where(0, 0, 0);
      for (int i = 0; i < poses; ++i) {
        const Eigen::Isometry3d here = pose(random.rotation(), {0, 0, 0});
        const Eigen::Isometry3d there =
            pose(Eigen::Matrix3d::Identity(), random.uniform(0.3, 1.0) * random.direction());
        const DistanceAnswer truth = distance(*shape, here, point, there);
        if (truth.distance < 1e-3) continue;
        const fcl::DistanceRequestd request(true, false, 0.0, 0.0, tolerance, fcl::GST_LIBCCD);
        fcl::DistanceResultd result;
        try {
          fcl::distance(shape.get(), here, &ball, there, request, result);
        } catch (...) {
          ++thrown;
          continue;
        }
        if (result.min_distance < 0) {
          ++lost;
          continue;
        }
        const double error = std::abs(result.min_distance - truth.distance);
        wrong += error > 1e-6;
        if (error > worst) {
          worst = error;
          where = here.linear().transpose() * there.translation();
        }
        const double span = (result.nearest_points[0] - result.nearest_points[1]).norm();
        garbage += !(std::abs(span - result.min_distance) <= 1e-6);
      }
      std::printf("| %s | %.0e | %d | %.1e | %d | %d | %d | (%.6g, %.6g, %.6g) |\n", name, tolerance, wrong,
                  worst, thrown, lost, garbage, where.x(), where.y(), where.z());
    }
  jumps();
  return 0;
}
