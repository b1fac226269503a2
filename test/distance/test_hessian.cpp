// Second derivatives and the velocities of normal and witness points against central differences.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/hessian.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using Vector12 = Eigen::Matrix<double, 12, 1>;

Vector12 gradient(const Distance& d, const Isometry3d& poseA, const Isometry3d& poseB) {
  Vector12 g;
  g << d.gradient(0, poseA.translation()), d.gradient(1, poseB.translation());
  return g;
}

}  // namespace

TEST_CASE("The Hessian and the velocities of normal and witness points are what central differences say") {
  const double R = GENERATE(0.6, 2.0, 10.0);
  const double gap = GENERATE(0.1, -0.01, -0.05);  // separated, slightly penetrating, deep
  const std::vector<StpBv::Ptr> pool{StpBv::build(box(0.3, 0.2, 0.5), {0.01, R}),
                                     StpBv::build(cylinder(0.15, 0.4, 12), {0.02, R}),
                                     StpBv::build(randomHull(40, {0.2, 0.3, 0.1}, 4), {0.015, R}),
                                     StpBv::build({Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)}, {0.01, R}),
                                     StpBv::build({Vector3d(0.1, 0, 0)}, {0.05, R})};
  Random random(17), motions(18);
  constexpr double kStep = 4e-6;  // of a difference of the fourth order
  int compared = 0, kinds[3][3] = {};
  double worst = 0;
  for (int i = 0; i < 400; ++i) {
    const StpBv& a = *pool[static_cast<std::size_t>(random.below(5))];
    const StpBv& b = *pool[static_cast<std::size_t>(random.below(5))];
    const Isometry3d poseA = pose(random.rotation(), 0.5 * random.direction());
    Isometry3d poseB = pose(random.rotation(), 2.0 * random.direction());
    const Distance far = distance(a, poseA, b, poseB);
    poseB.translation() += (gap - far.distance) * far.normal;
    const Distance d = distance(a, poseA, b, poseB);
    DistanceHessian h;
    if (!hessian(a, poseA, b, poseB, d, h)) continue;
    CHECK(h.matrix == h.matrix.transpose());
    // The rates are the matrices times the twists, by another order of the same sums:
    // rounding of levers below 3 m over radii of curvature of at least a centimetre,
    // magnified where edges cross at a small angle.
    BodyTwists twists;
    for (Eigen::Index k = 0; k < 12; ++k) twists[k] = motions.uniform(-1, 1);
    DistanceRate moves;
    REQUIRE(rate(a, poseA, b, poseB, d, twists, moves));
    const double size = 1 + h.normal.norm() + h.point[0].norm() + h.point[1].norm();
    CHECK((h.normal * twists - moves.normal).norm() < 1e-11 * size);
    for (std::size_t p = 0; p < 2; ++p) CHECK((h.point[p] * twists - moves.point[p]).norm() < 1e-11 * size);

    Eigen::Matrix<double, 12, 12> second;
    Eigen::Matrix<double, 3, 12> normal, point[2];
    bool smooth = true;  // no boundary within the step
    for (int k = 0; k < 12; ++k) {
      constexpr double kAt[4] = {-2, -1, 1, 2};
      Distance side[4];
      Vector12 g[4];
      for (int s = 0; s < 4; ++s) {
        const double step = kAt[s] * kStep;
        const Isometry3d pa = k < 6 ? moved(poseA, k, step) : poseA,
                         pb = k < 6 ? poseB : moved(poseB, k - 6, step);
        side[s] = distance(a, pa, b, pb);
        g[s] = gradient(side[s], pa, pb);
        smooth = smooth && side[s].patch == d.patch && (side[s].normal - d.normal).norm() < 1e-1;
      }
      const auto central = [&](const auto& value) {
        return ((8 * (value(2) - value(1)) - (value(3) - value(0))) / (12 * kStep)).eval();
      };
      second.col(k) = central([&](int s) { return g[s]; });
      normal.col(k) = central([&](int s) { return side[s].normal; });
      for (std::size_t p = 0; p < 2; ++p) point[p].col(k) = central([&](int s) { return side[s].point[p]; });
    }
    if (!smooth) continue;
    // The gradient is taken in the moved bodies' frames, whose rotations do not commute; the symmetric part
    // is the second derivative along the exponential.
    const Eigen::Matrix<double, 12, 12> symmetric = 0.5 * (second + second.transpose());
    const double scale = 1 + h.matrix.cwiseAbs().maxCoeff() + h.normal.cwiseAbs().maxCoeff();
    worst = std::max(worst, (symmetric - h.matrix).cwiseAbs().maxCoeff() / scale);
    worst = std::max(worst, (normal - h.normal).cwiseAbs().maxCoeff() / scale);
    for (std::size_t p = 0; p < 2; ++p)
      worst = std::max(worst, (point[p] - h.point[p]).cwiseAbs().maxCoeff() / scale);
    ++compared;
    ++kinds[static_cast<int>(a.kind(d.patch[0]))][static_cast<int>(b.kind(d.patch[1]))];
  }
  CHECK(worst < 5e-9);  // rounding of the normal over the step, and the step to the fourth
  CHECK(compared > 150);
  CHECK(kinds[1][1] > 0);  // two tori
  CHECK(kinds[0][2] + kinds[2][0] > 0);
}

TEST_CASE("Two simple shapes: Hessian, normal and witness points move as central differences say") {
  constexpr double kStep = 4e-6, kKink = 3e-8;
  std::vector<std::string> kinds = boundedShapes();
  kinds.insert(kinds.end(), {"half space", "plane"});
  int compared = 0, boundaries = 0;
  for (const std::string& first : kinds)
    for (const std::string& second : kinds) {
      Random random(23 + 10 * compared);
      for (int i = 0; i < 8; ++i) {
        const TestShape a = randomShape(first, random), b = randomShape(second, random);
        if (a.shape.unbounded() && b.shape.unbounded()) continue;
        CAPTURE(first, second, i);
        const Isometry3d poseA = pose(random.rotation(), 0.5 * random.direction());
        Isometry3d poseB = pose(random.rotation(), 2.0 * random.direction());
        for (int k = 0; k < 3; ++k) {  // balls overlap a little
          const Distance far = distance(a.shape, poseA, b.shape, poseB);
          const double gap = i % 2 ? 0.1 : 0.05 - 0.5 * (a.shape.margin + b.shape.margin);
          poseB.translation() += (gap - far.distance) * far.normal;
        }
        const Distance d = distance(a.shape, poseA, b.shape, poseB);
        DistanceHessian h;
        REQUIRE(hessian(a.shape, poseA, b.shape, poseB, d, h));
        CHECK((h.matrix - h.matrix.transpose()).cwiseAbs().maxCoeff() == 0);
        BodyTwists twists;
        for (Eigen::Index k = 0; k < 12; ++k) twists[k] = random.uniform(-1, 1);
        DistanceRate moves;
        REQUIRE(rate(a.shape, poseA, b.shape, poseB, d, twists, moves));
        const double size = 1 + h.normal.norm() + h.point[0].norm() + h.point[1].norm();
        CHECK((h.normal * twists - moves.normal).norm() < 1e-13 * size);
        for (std::size_t p = 0; p < 2; ++p)
          CHECK((h.point[p] * twists - moves.point[p]).norm() < 1e-13 * size);

        Eigen::Matrix<double, 12, 12> second12;
        Eigen::Matrix<double, 3, 12> normal, point[2];
        bool smooth = true;  // no other feature within the step
        for (int k = 0; k < 12; ++k) {
          Distance side[5];
          Vector12 g[5];
          for (int s = 0; s < 5; ++s) {
            const double step = (s - 2) * kStep;
            const Isometry3d pa = k < 6 ? moved(poseA, k, step) : poseA,
                             pb = k < 6 ? poseB : moved(poseB, k - 6, step);
            side[s] = distance(a.shape, pa, b.shape, pb);
            g[s] = gradient(side[s], pa, pb);
          }
          const auto central = [&](const auto& value) {
            return ((8 * (value(3) - value(1)) - (value(4) - value(0))) / (12 * kStep)).eval();
          };
          second12.col(k) = central([&](int s) { return g[s]; });
          normal.col(k) = central([&](int s) { return side[s].normal; });
          for (std::size_t p = 0; p < 2; ++p)
            point[p].col(k) = central([&](int s) { return side[s].point[p]; });
          // A kink within the step shows in the fourth difference; smooth parts and rounding add 1e-8.
          const Vector12 kink = (g[4] - 4 * g[3] + 6 * g[2] - 4 * g[1] + g[0]) / kStep;
          smooth = smooth && kink.norm() <= kKink * (1 + second12.col(k).norm());
        }
        if (!smooth) {
          ++boundaries;
          continue;
        }
        ++compared;
        const double scale = 1 + h.matrix.cwiseAbs().maxCoeff() + h.normal.cwiseAbs().maxCoeff();
        const Eigen::Matrix<double, 12, 12> symmetric = 0.5 * (second12 + second12.transpose());
        CHECK((symmetric - h.matrix).cwiseAbs().maxCoeff() < 2 * kKink * scale);
        CHECK((normal - h.normal).cwiseAbs().maxCoeff() < 2 * kKink * scale);
        for (std::size_t p = 0; p < 2; ++p)
          CHECK((point[p] - h.point[p]).cwiseAbs().maxCoeff() < 2 * kKink * scale);
      }
    }
  CHECK(compared > 600);
  CHECK(boundaries < compared / 10);
}

TEST_CASE("There is no Hessian without an answer, and none where cores touch without curvature") {
  const StpBv::Ptr a = StpBv::build({Vector3d(0, 0, 0)}, {0.1, 1});
  DistanceHessian h;
  const Isometry3d here = Isometry3d::Identity();
  CHECK_FALSE(hessian(*a, here, *a, here, Distance(), h));
  CHECK_FALSE(hessian(*a, here, *a, here, distance(*a, here, *a, here), h));  // coincident centres
}
