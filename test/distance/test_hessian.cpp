// Second derivatives, and the velocities of normal and witness points, compared with central differences.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/hessian.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using Vector12 = Eigen::Matrix<double, 12, 1>;
constexpr double kStep = 4e-6;  // for a difference of the fourth order

/// An answer and its gradient at five steps along one coordinate of the two poses.
struct Steps {
  Distance d[5];
  Vector12 gradient[5];

  template <typename Value>
  auto central(const Value& value) const {
    return ((8 * (value(3) - value(1)) - (value(4) - value(0))) / (12 * kStep)).eval();
  }
};

/// Second derivatives by central differences.
struct Differences {
  DistanceHessian h;
  bool smooth = true;  ///< `isSmooth(steps)` for all 12 coordinates

  template <typename A, typename B, typename IsSmooth>
  Differences(const A& a, const Isometry3d& poseA, const B& b, const Isometry3d& poseB,
              const IsSmooth& isSmooth) {
    Eigen::Matrix<double, 12, 12> second;
    for (int k = 0; k < 12; ++k) {
      Steps at;
      for (int s = 0; s < 5; ++s) {
        const double step = (s - 2) * kStep;
        const Isometry3d pa = k < 6 ? moved(poseA, k, step) : poseA,
                         pb = k < 6 ? poseB : moved(poseB, k - 6, step);
        at.d[s] = distance(a, pa, b, pb);
        at.gradient[s] << at.d[s].gradient(0, pa.translation()), at.d[s].gradient(1, pb.translation());
      }
      second.col(k) = at.central([&](int s) { return at.gradient[s]; });
      h.normal.col(k) = at.central([&](int s) { return at.d[s].normal; });
      for (std::size_t p = 0; p < 2; ++p)
        h.point[p].col(k) = at.central([&](int s) { return at.d[s].point[p]; });
      smooth = smooth && isSmooth(at);
    }
    // The gradient is taken in the frames of the moved bodies, whose rotations do not commute. The symmetric
    // part is the second derivative along the exponential map.
    h.matrix = 0.5 * (second + second.transpose());
  }

  /// The largest difference from `other`, as a share of its size.
  double from(const DistanceHessian& other) const {
    const auto most = [](const auto& m) { return m.cwiseAbs().maxCoeff(); };
    return std::max({most(h.matrix - other.matrix), most(h.normal - other.normal),
                     most(h.point[0] - other.point[0]), most(h.point[1] - other.point[1])}) /
           (1 + most(other.matrix) + most(other.normal));
  }
};

/// The rates are the matrices times the twists, in another order of the same sums.
template <typename A, typename B>
void checkRates(const A& a, const Isometry3d& poseA, const B& b, const Isometry3d& poseB, const Distance& d,
                const DistanceHessian& h, Random& random, double rounding) {
  BodyTwists twists;
  for (Eigen::Index k = 0; k < 12; ++k) twists[k] = random.uniform(-1, 1);
  DistanceRate moves;
  REQUIRE(rate(a, poseA, b, poseB, d, twists, moves));
  const double size = 1 + h.normal.norm() + h.point[0].norm() + h.point[1].norm();
  CHECK((h.normal * twists - moves.normal).norm() < rounding * size);
  for (std::size_t p = 0; p < 2; ++p) CHECK((h.point[p] * twists - moves.point[p]).norm() < rounding * size);
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
    // Rounding of levers below 3 m divided by radii of curvature of at least a centimetre, magnified where
    // edges cross at a small angle.
    checkRates(a, poseA, b, poseB, d, h, motions, 1e-11);
    const auto noBoundary = [&](const Steps& at) {
      return std::all_of(std::begin(at.d), std::end(at.d), [&](const Distance& there) {
        return there.patch == d.patch && (there.normal - d.normal).norm() < 1e-1;
      });
    };
    const Differences central(a, poseA, b, poseB, noBoundary);
    if (!central.smooth) continue;
    worst = std::max(worst, central.from(h));
    ++compared;
    ++kinds[static_cast<int>(a.kind(d.patch[0]))][static_cast<int>(b.kind(d.patch[1]))];
  }
  CHECK(worst < 5e-9);  // the normal's rounding divided by the step, and the step to the fourth power
  CHECK(compared > 150);
  CHECK(kinds[1][1] > 0);  // two tori
  CHECK(kinds[0][2] + kinds[2][0] > 0);
}

TEST_CASE("Two simple shapes: Hessian, normal and witness points move as central differences say") {
  constexpr double kKink = 3e-8;
  std::vector<std::string> kinds = boundedShapes();
  kinds.insert(kinds.end(), {"half space", "plane"});
  int compared = 0, boundaries = 0;
  for (const std::string& first : kinds)
    for (const std::string& second : kinds) {
      Random random(23 + 10 * compared);
      for (int i = 0; i < 8; ++i) {
        TestShape a = randomShape(first, random), b = randomShape(second, random);
        if (a.shape.unbounded() && b.shape.unbounded()) continue;
        CAPTURE(first, second, i);
        if (i % 4 > 1)  // any shape may have a margin
          for (Shape* shape : {&a.shape, &b.shape})
            if (!shape->unbounded()) shape->margin += random.uniform(0.0, 0.1);
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
        checkRates(a.shape, poseA, b.shape, poseB, d, h, random, 1e-13);
        // A kink within the step shows up in the fourth difference. Smooth parts and rounding contribute
        // 1e-8.
        const auto noKink = [&](const Steps& at) {
          const Vector12* g = at.gradient;
          const Vector12 kink = (g[4] - 4 * g[3] + 6 * g[2] - 4 * g[1] + g[0]) / kStep,
                         slope = at.central([&](int s) { return g[s]; });
          return kink.norm() <= kKink * (1 + slope.norm());
        };
        const Differences central(a.shape, poseA, b.shape, poseB, noKink);
        if (!central.smooth) {
          ++boundaries;
          continue;
        }
        ++compared;
        CHECK(central.from(h) < 2 * kKink);
      }
    }
  CHECK(compared > 600);
  CHECK(boundaries < compared / 10);
}

TEST_CASE("The derivatives on a large sphere are those of two balls") {
  // The error of a witness point is its normal's rounding times R.
  const double R = GENERATE(1.0, 1e3, 1e6), rounding = 1e-13 + 16 * 2.2e-16 * R;
  constexpr double kSmall = 0.03, kSide = 0.4, kHeight = 0.1, kRounding = 0.01;
  const StpBv::Ptr ball = StpBv::build({Vector3d(0.1, 0, 0.02)}, {kSmall, 1});
  const StpBv::Ptr plate = StpBv::build(box(kSide, kSide, kHeight), {kRounding, R});
  using Real = long double;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  Random random(29);
  for (int i = 0; i < 100; ++i) {
    // The plate's axes are the world's axes in another order, so its pose is exact.
    Isometry3d posePlate = pose(Eigen::Matrix3d::Zero(), random.direction());
    for (int k = 0; k < 3; ++k) posePlate.linear()((k + i) % 3, k) = 1;
    const Vector3d above(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0.1, 0.5));
    const Isometry3d poseBall = pose(random.rotation(), posePlate * above - random.direction() * 0.01);
    const Distance d = distance(*ball, poseBall, *plate, posePlate);
    REQUIRE(plate->kind(d.patch[1]) == PatchKind::face);
    const bool swapped = i % 2 == 1;
    BodyTwists twists;
    for (Eigen::Index k = 0; k < 12; ++k) twists[k] = random.uniform(-1, 1);
    DistanceHessian h;
    DistanceRate moves;
    Vector3d normal, onBall, onPlate;
    if (swapped) {
      const Distance other = distance(*plate, posePlate, *ball, poseBall);
      BodyTwists there;
      there << twists.tail<6>(), twists.head<6>();
      REQUIRE(hessian(*plate, posePlate, *ball, poseBall, other, h));
      REQUIRE(rate(*plate, posePlate, *ball, poseBall, other, there, moves));
      normal = -moves.normal, onBall = moves.point[1], onPlate = moves.point[0];
      twists = there;
    } else {
      REQUIRE(hessian(*ball, poseBall, *plate, posePlate, d, h));
      REQUIRE(rate(*ball, poseBall, *plate, posePlate, d, twists, moves));
      normal = moves.normal, onBall = moves.point[0], onPlate = moves.point[1];
    }

    // The balls' centres, with their velocities and accelerations.
    const Real rho = R - kRounding;
    const Vector low(0, 0, Real(kHeight) / 2 - std::sqrt(rho * rho - Real(kSide) * kSide / 2));
    const auto moving = [&](const Isometry3d& at, const Vector& centre, int body, Vector velocity[3]) {
      const Vector v = twists.segment<3>(6 * body).cast<Real>(),
                   w = twists.segment<3>(6 * body + 3).cast<Real>();
      const Vector lever = at.linear().cast<Real>() * centre;
      velocity[0] = at.translation().cast<Real>() + lever;
      velocity[1] = v + w.cross(lever);
      velocity[2] = w.cross(w.cross(lever));
    };
    Vector small[3], large[3];
    moving(poseBall, Vector(Real(0.1), 0, Real(0.02)), swapped ? 1 : 0, small);
    moving(posePlate, low, swapped ? 0 : 1, large);
    const Vector way = large[0] - small[0], speed = large[1] - small[1], n = way.normalized();
    const Vector turn = (speed - n.dot(speed) * n) / way.norm();
    const Real second = speed.dot(turn) + n.dot(large[2] - small[2]);
    CAPTURE(R, i);
    CHECK((normal - turn.cast<double>()).norm() < rounding);
    CHECK((onBall - (small[1] + Real(kSmall) * turn).cast<double>()).norm() < rounding);
    CHECK((onPlate - (large[1] - Real(R) * turn).cast<double>()).norm() < rounding);
    CHECK(std::abs(twists.dot(h.matrix * twists) - static_cast<double>(second)) < 10 * rounding);
  }
}

TEST_CASE("The derivatives do not depend on the order of the bodies, whatever their radii") {
  const double R = GENERATE(1.0, 1e3, 1e6);
  Random random(31);
  for (int i = 0; i < 200; ++i) {
    const auto body = [&](double radius) {
      return StpBv::build(randomHull(2 + random.below(8), {0.2, 0.3, 0.1}, static_cast<std::uint64_t>(i)),
                          {0.01, radius});
    };
    const StpBv::Ptr a = body(R), b = body(i % 2 ? R : 1.0);
    const Isometry3d poseA = pose(random.rotation(), random.direction());
    Isometry3d poseB = pose(random.rotation(), 2 * random.direction());
    const Distance far = distance(*a, poseA, *b, poseB);
    poseB.translation() += (0.02 - far.distance) * far.normal;
    const Distance d = distance(*a, poseA, *b, poseB);
    const Distance other = d.mirrored();
    DistanceHessian h, g;
    REQUIRE(hessian(*a, poseA, *b, poseB, d, h));
    REQUIRE(hessian(*b, poseB, *a, poseA, other, g));
    Eigen::Matrix<double, 12, 12> matrix;
    matrix << g.matrix.bottomRightCorner<6, 6>(), g.matrix.bottomLeftCorner<6, 6>(),
        g.matrix.topRightCorner<6, 6>(), g.matrix.topLeftCorner<6, 6>();
    // Witness points are opposite each other up to the rounding of their normal times R.
    const double rounding = 1e-13 + 16 * 2.2e-16 * R;
    CHECK((matrix - h.matrix).cwiseAbs().maxCoeff() < rounding * h.matrix.cwiseAbs().maxCoeff());
    for (std::size_t p = 0; p < 2; ++p) {
      Eigen::Matrix<double, 3, 12> point;
      point << g.point[1 - p].rightCols<6>(), g.point[1 - p].leftCols<6>();
      CHECK((point - h.point[p]).cwiseAbs().maxCoeff() < rounding * h.point[p].cwiseAbs().maxCoeff());
    }
  }
}

TEST_CASE("There is no Hessian without an answer, and none where cores touch without curvature") {
  const StpBv::Ptr a = StpBv::build({Vector3d(0, 0, 0)}, {0.1, 1});
  DistanceHessian h;
  const Isometry3d here = Isometry3d::Identity();
  CHECK_FALSE(hessian(*a, here, *a, here, Distance(), h));
  CHECK_FALSE(hessian(*a, here, *a, here, distance(*a, here, *a, here), h));  // coincident centres
}

TEST_CASE("A point on the axis of a cone or a cylinder has no Hessian, however far from the world's origin") {
  const Shape point = Shape::sphere(0.0);
  Random random(31);
  for (const Shape& round : {Shape::coneOf(0.15, 0.3), Shape::cylinderOf(0.15, 0.9)})
    for (const double far : {0.0, 1.0, 1e3, 1e6})
      for (int i = 0; i < 200; ++i) {
        const Vector3d middle = far * random.direction();
        const Isometry3d a = pose(random.rotation(), middle), b = pose(random.rotation(), middle);
        const Distance d = distance(point, a, round, b);
        CAPTURE(far, d.distance);
        CHECK(d.status == DistanceStatus::exact);
        DistanceHessian h;
        CHECK_FALSE(hessian(point, a, round, b, d, h));
        CHECK_FALSE(hessian(round, b, point, a, distance(round, b, point, a), h));
      }
}
