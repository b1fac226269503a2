// Normals and witness points of shapes that touch, lie on one axis or have no thickness, in closed form.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/hessian.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

double besideEachOther(const Distance& d) { return (d.point[1] - d.point[0] - d.distance * d.normal).norm(); }

}  // namespace

TEST_CASE("a pin without thickness 2 mm deep in a needle leaves it across the needle") {
  const Vector3d sides(1, 0.01, 0.01);
  const Cloud corners = box(1, 0.01, 0.01);
  for (const Shape& needle : {Shape::boxOf(sides), Shape::polytopeOf(corners.data(), 8)})
    for (const Shape& pin : {Shape::cylinderOf(0, 0.06), Shape::coneOf(0, 0.06), Shape::capsule(0, 0.06),
                             Shape::cylinderOf(1e-12, 0.06), Shape::coneOf(1e-12, 0.06)}) {
      const Distance d = distance(needle, at(0, 0, 0), pin, at(0.1, 0, 0.005 + 0.03 - 0.002));
      CAPTURE(static_cast<int>(needle.kind), static_cast<int>(pin.kind), pin.radius);
      CHECK(std::abs(d.distance + 0.002) <= 1e-15);
      CHECK((d.normal - Vector3d(0, 0, 1)).norm() <= 1e-15);
      CHECK((d.lower <= -0.002 && d.upper >= -0.002));
      CHECK((d.point[0] - Vector3d(0.1, 0, 0.005)).norm() <= 1e-12);
      CHECK((d.point[1] - Vector3d(0.1, 0, 0.003)).norm() <= 1e-12);
    }
}

TEST_CASE("capsules on one line overlap where both have their axes, in either order") {
  const Isometry3d origin = at(0, 0, 0);
  for (const double shift : {-0.25, -0.1, 0.1, 0.25, 0.299}) {
    const Shape capsule = Shape::capsule(0.05, 0.3);
    const Distance d = distance(capsule, origin, capsule, at(0, 0, shift));
    CAPTURE(shift);
    CHECK(std::abs(d.distance + 0.1) <= 1e-15);
    CHECK(std::abs(d.point[0].z() - shift / 2) <= (0.3 - std::abs(shift)) / 2 + 1e-15);
    CHECK(besideEachOther(d) <= 1e-15);
  }
  const Shape wide = Shape::capsule(0.08, 0.05), slim = Shape::capsule(0.003, 0.68);
  for (const double overlap : {1e-6, 1e-3, 0.0182, 0.05}) {
    const Isometry3d below = at(0, 0, -(0.025 + 0.34 - overlap));
    for (const bool first : {true, false}) {
      const Distance d = first ? distance(wide, origin, slim, below) : distance(slim, below, wide, origin);
      CAPTURE(overlap, first);
      CHECK(std::abs(d.distance + 0.083) <= 1e-15);
      CHECK(std::abs(d.point[0].z() + 0.025 - overlap / 2) <= overlap / 2 + 1e-15);
      CHECK(besideEachOther(d) <= 1e-15);
    }
  }
}

TEST_CASE("bodies of revolution on one axis overlap where both have their sides") {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Isometry3d one = pose(random.rotation(), random.direction());
    const double r = random.uniform(0.1, 0.3), shift = random.uniform(-0.5, 0.5) * r;
    const Isometry3d other = one * at(0, 0, shift);
    const Shape cylinder = Shape::cylinderOf(r, 2.0 * r), capsule = Shape::capsule(r, 4.0 * r),
                cone = Shape::coneOf(r, 0.1 * r);
    CAPTURE(i, shift, r);
    for (const Shape& shape : {cylinder, cone}) {
      const Distance d = distance(shape, one, capsule, other);
      const Vector3d p = one.inverse() * d.point[0];
      CHECK(d.status == DistanceStatus::exact);
      CHECK(std::abs(d.distance + 2.0 * r) <= 2e-15);
      CHECK(besideEachOther(d) <= 4e-15);
      CHECK(std::abs(p.head<2>().norm() - r) <= 4e-15);
      CHECK(std::abs(p.z()) <= shape.half + 4e-15);
    }
  }
}

TEST_CASE("the normal from a box's corner to a rim is that of the two points") {
  Random random(3);
  const Shape crate = Shape::boxOf({0.2, 0.12, 0.3});
  int corners = 0;
  for (int i = 0; i < 40000; ++i) {
    const double radius = random.uniform(0.05, 0.5), length = random.uniform(0.1, 1);
    const Shape round = i % 2 ? Shape::cylinderOf(radius, length) : Shape::coneOf(radius, length);
    const Isometry3d placed =
        pose(random.rotation(), {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)});
    const Distance d = distance(crate, at(0, 0, 0), round, placed);
    if (d.status != DistanceStatus::exact || !(d.distance > 0.01)) continue;
    if ((d.point[0].cwiseAbs() - crate.size).norm() > 1e-9) continue;
    const Vector3d corner = d.point[0].array().sign() * crate.size.array(), x = placed.inverse() * corner;
    const double across = x.head<2>().norm(), end = std::copysign(round.half, x.z());
    // Beyond the rim's torus of normals, a side, a disc or an apex is nearest.
    const Vector3d rim(radius * x.x() / across, radius * x.y() / across,
                       round.kind == ShapeKind::cone ? -round.half : end);
    if ((placed * rim - d.point[1]).norm() > 1e-6) continue;
    ++corners;
    CAPTURE(i);
    CHECK(((placed * rim - corner).normalized() - d.normal).norm() <= 1e-12);
  }
  CHECK(corners > 5000);
}

TEST_CASE("an upright cylinder or capsule beside an upright box: as far, to rounding, as in the plane") {
  Random random(7);
  int edges = 0, faces = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d half(random.uniform(0.02, 0.5), random.uniform(0.02, 0.5), random.uniform(0.02, 0.5));
    const Cloud corners = box(half.x() * 2, half.y() * 2, half.z() * 2);
    const double radius = random.uniform(0.05, 1), length = random.uniform(0.05, 1);
    // Past the box's edge along y, or in front of its face. In front of its middle, GJK's points are not
    // symmetric.
    const double beyond = i % 2 ? random.uniform(0.001, 1) : i % 4 ? -half.y() : random.uniform(-half.y(), 0);
    const Vector3d shift(half.x() + 1.1 * radius + random.uniform(0, 1), half.y() + beyond,
                         random.uniform(-0.9, 0.9) * (half.z() + length / 2));
    const double truth = std::hypot(shift.x() - half.x(), std::max(beyond, 0.0)) - radius;
    const Isometry3d one = pose(random.rotation(), random.direction()),
                     other = one * at(shift.x(), shift.y(), shift.z());
    const Shape round = i % 3 ? Shape::cylinderOf(radius, length) : Shape::capsule(radius, length);
    for (const Shape& flat : {Shape::boxOf(2.0 * half), Shape::polytopeOf(corners.data(), 8)}) {
      CAPTURE(i, truth, static_cast<int>(flat.kind), static_cast<int>(round.kind));
      const Distance d = distance(flat, one, round, other);
      ++(i % 2 ? edges : faces);
      CHECK(d.status == DistanceStatus::exact);
      CHECK(std::abs(d.distance - truth) <= 1e-14);
      CHECK((d.lower <= truth && d.upper >= truth));
      CHECK(besideEachOther(d) <= 1e-14);
      const Vector3d n = one.linear().transpose() * d.normal;
      CHECK(std::abs(n.z()) <= 1e-13);
      CHECK((n.head<2>() * (truth + radius) - Eigen::Vector2d(shift.x() - half.x(), std::max(beyond, 0.0)))
                .norm() <= 1e-13);
    }
  }
  CHECK((edges > 1000 && faces > 1000));
}

TEST_CASE(
    "a polytope's corner over a cone's side, steep or as flat as a sheet: exact, on the generator below it") {
  Random random(11);
  const Cloud spike{{0, 0, 0}, {0.1, 0.02, 0.3}, {-0.1, 0.05, 0.3}, {0.03, -0.2, 0.3}};
  const Shape corner = Shape::polytopeOf(spike.data(), 4);
  for (int i = 0; i < 2000; ++i) {
    const double radius = 0.3, half = std::pow(10.0, random.uniform(-5, -1));
    const Vector3d side = Vector3d(half * 2, 0, radius).normalized(), along(-side.z(), 0, side.x());
    const double gap = random.uniform(0.001, 0.1), angle = random.uniform(-3, 3);
    // Above a point of the generator, turned around the axis.
    const Vector3d foot =
        Vector3d(0, 0, half) - random.uniform(0.1, 0.9) * std::hypot(radius, 2 * half) * along;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d tip = turn * (foot + gap * side);
    const Distance d =
        distance(Shape::coneOf(radius, 2.0 * half), at(0, 0, 0), corner, at(tip.x(), tip.y(), tip.z()));
    CAPTURE(i, half, gap);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - gap) <= 1e-15);
    CHECK((d.normal - turn * side).norm() <= 1e-15 / gap);
    CHECK((d.point[0] - turn * foot).norm() <= 2e-15);
    CHECK(besideEachOther(d) <= 1e-15);
  }
}

TEST_CASE("all but touching an STP-BV of a huge R, a point's true gap is below the upper bound") {
  const Cloud cloud{{-0.142, -0.211, 0.286},
                    {-0.045, -0.203, -0.392},
                    {0.162, -0.229, 0.084},
                    {-0.229, -0.113, 0.490},
                    {0.089, -0.058, -0.651}};
  for (const double R : {10.0, 1e3, 1e4, 1e6}) {
    const double r = 0.05;
    const StpBv::Ptr volume = StpBv::build(cloud, {r, R});
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
      const Vector3d m = random.direction(), on = volume->surfacePoint(m) - r * m;
      const Vector3d centre = on + std::pow(10.0, random.uniform(-13, -6)) * m;
      const Distance d =
          distance(*volume, at(0, 0, 0), Shape::sphere(0.1), at(centre[0], centre[1], centre[2]));
      const Vector3L n = m.cast<long double>().normalized();
      const ReferenceBody body = referenceBody(cloud, r, R);
      const long double gap = n.dot(centre.cast<long double>()) - referenceSupport(body, n) - 0.1L;
      CAPTURE(R, i, d.upper - d.lower);
      CHECK(gap - static_cast<long double>(d.upper) <= 0);
    }
  }
}

TEST_CASE("where an STP-BV touches a flat or long shape both witness points are opposite each other") {
  const Cloud corners{{0.1, 0, 0}, {-0.1, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}, {0, 0, 0.1}, {0, 0, -0.1}};
  const Vector3d triangle[] = {{0, -1, -1}, {0, 2, -1}, {0, 0, 3}};
  const Cloud crate = box(1, 1, 1);
  struct Side {
    Shape shape;
    double half;  // distance from its origin to the side at -x
    double wide;  // how far the side reaches along y
  };
  const Side sides[] = {{Shape::boxOf({1, 1, 1}), 0.5, 0.4},
                        {Shape::polytopeOf(crate.data(), 8), 0.5, 0.4},
                        {Shape::triangleOf(triangle[0], triangle[1], triangle[2]), 0.0, 0.1},
                        {Shape::capsule(0.05, 1), 0.0, 0.0},
                        {Shape::cylinderOf(0.2, 1), 0.2, 0.0},
                        {Shape::ellipsoidOf({0, 1, 1}), 0.0, 0.1}};
  for (const double r : {0.0, 0.01}) {
    const StpBv::Ptr volume = StpBv::build(corners, {r, 10});
    const Distance d = distance(*volume, at(0, 0, 0), Shape::capsule(0.05, 1), at(0.1, 0, 0.3));
    CHECK((d.point[1] - Vector3d(0.05, 0, 0)).norm() <= 1e-15);
    for (const Side& side : sides) {
      Random random(3);
      int exact = 0;
      for (int i = 0; i < 1000; ++i) {
        Isometry3d placed = pose(random.rotation(), {0, 0, 0});
        const Vector3d m = placed.linear().col(0), core = volume->surfacePoint(m) - r * m;
        placed.translation() =
            core + placed.linear() *
                       Vector3d(side.half, random.uniform(-side.wide, side.wide), random.uniform(-0.1, 0.4));
        const Distance touch = distance(*volume, at(0, 0, 0), side.shape, placed);
        if (touch.status != DistanceStatus::exact) continue;  // deep because of rounding
        ++exact;
        CAPTURE(r, static_cast<int>(side.shape.kind), i);
        // An ulp of the normal moves a face's point by 10 m times that.
        CHECK(besideEachOther(touch) <= 2e-14);
      }
      CHECK(exact > 100);
    }
  }
}

TEST_CASE("no second derivative where all radii of curvature and the distance cancel") {
  Random random(1);
  DistanceHessian h;
  DistanceRate rate_;
  const BodyTwists twists = BodyTwists::Ones();
  for (int i = 0; i < 300; ++i) {
    const Isometry3d one = pose(random.rotation(), random.direction());
    const Isometry3d other = one * at(0, 0, random.uniform(-0.05, 0.05));
    const Shape cylinder = Shape::cylinderOf(random.uniform(0.02, 0.06), 0.4),
                ball = Shape::sphere(random.uniform(0.05, 0.2));
    const Distance d = distance(cylinder, one, ball, other);
    CAPTURE(i);
    CHECK_FALSE(hessian(cylinder, one, ball, other, d, h));
    CHECK_FALSE(rate(cylinder, one, ball, other, d, twists, rate_));

    const Shape a = Shape::boxOf({0.2, 0.3, 0.4}), b = Shape::boxOf({0.3, 0.2, 0.1});
    Isometry3d touching = pose(random.rotation(), {0, 0, 0});
    const Vector3d n = one.linear() * Vector3d(1, 1, 1).normalized();
    touching.translation() = one * a.support(one.linear().transpose() * n) -
                             touching.linear() * b.support(touching.linear().transpose() * -n);
    if (hessian(a, one, b, touching, distance(a, one, b, touching), h))
      CHECK(h.matrix.cwiseAbs().maxCoeff() < 1e4);  // for two edges that cross there
  }
  // A volume's centre at another's, deep: the normal may be any.
  const StpBv::Ptr ball = StpBv::build({{0, 0, 0}}, {0.1, 1});
  const Distance d = distance(*ball, at(0, 0, 0), *ball, at(0, 0, 0));
  CHECK_FALSE(hessian(*ball, at(0, 0, 0), *ball, at(0, 0, 0), d, h));
  // A pair that almost touches has a Hessian.
  const Shape point = Shape::sphere(0);
  for (const double gap : {1e-3, 1e-6, 1e-9}) {
    const Distance near = distance(*ball, at(0, 0, 0), point, at(0.1 + gap, 0, 0));
    CHECK(hessian(*ball, at(0, 0, 0), point, at(0.1 + gap, 0, 0), near, h));
    const Distance points = distance(point, at(0, 0, 0), point, at(gap, 0, 0));
    REQUIRE(hessian(point, at(0, 0, 0), point, at(gap, 0, 0), points, h));
    CHECK(std::abs(h.matrix(1, 1) * gap - 1) <= 1e-5);
  }
}

TEST_CASE("farther than a threshold just below the distance, for round shapes as for the others") {
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const double r = random.uniform(0.05, 0.5);
    const Shape shapes[] = {Shape::cylinderOf(r, 0.4), Shape::coneOf(r, 0.4),
                            Shape::ellipsoidOf({r, 0.2, 0.7}), Shape::boxOf({r, 0.2, 0.7})};
    const Shape &a = shapes[random.below(4)], &b = shapes[random.below(4)];
    const Isometry3d one = pose(random.rotation(), {0, 0, 0}),
                     other = pose(random.rotation(), random.uniform(0.6, 1.5) * random.direction());
    const Distance d = distance(a, one, b, other);
    if (d.status != DistanceStatus::exact || !(d.distance > 0)) continue;
    CAPTURE(i, static_cast<int>(a.kind), static_cast<int>(b.kind));
    CHECK(isFartherThan(d.distance - 1e-12, a, one, b, other));
    CHECK_FALSE(isFartherThan(d.upper, a, one, b, other));
  }
}

TEST_CASE("where Newton's method goes to and fro between a needle's corners the normal is still exact") {
  const Cloud needle{{-0.0013916191057474483, 0.030376258278758696, -4.4348601268053001},
                     {0.0013540108854690727, 0.0175705739211005, 9.4207327606053752},
                     {-0.0011152431122478477, -0.034577229245053687, 5.9146256835397031},
                     {0.0011354722451111928, -0.021981348937437441, 10.239074849448686},
                     {-0.001094148629131263, 0.021710113110745423, 10.57294269121765},
                     {-0.00039830981825632913, 0.046710218851419086, 1.3930071763351493}};
  const Shape hull = Shape::polytopeOf(needle.data(), static_cast<int>(needle.size())),
              ellipsoid = Shape::ellipsoidOf({1.8585705707949101, 1.4089412746871455, 2.5876373024355148});
  Isometry3d poseA = Isometry3d::Identity(), poseB = Isometry3d::Identity();
  poseA.translation() = Vector3d(31.805786046408794, 16.18345741489863, -3.9167469425325354);
  poseB.matrix().topRows<3>() << -0.32510812735545752, -0.22789464096240725, -0.91780648186207703,
      33.008970400170682, 0.94194410038680965, 0.0081092864931814161, -0.33567179091942656,
      12.935722063495188, 0.083940557979509584, -0.97365202823862429, 0.21202761761832251,
      -5.9360943396652619;
  const Distance d = distance(hull, poseA, ellipsoid, poseB);
  REQUIRE(d.status == DistanceStatus::exact);
  constexpr double kDistance = 1.622114215970088141;  // by GJK in float128
  CHECK(std::abs(d.distance - kDistance) < 2e-14);    // for coordinates of 36 m
  // The ellipsoid's point is where its normal is the answer's, up to rounding of the coordinates divided by
  // the radii.
  const Vector3d axes = ellipsoid.size, n = poseB.linear().transpose() * -d.normal,
                 onSurface = axes.cwiseAbs2().cwiseProduct(n) / axes.cwiseProduct(n).norm();
  CHECK((poseB * onSurface - d.point[1]).norm() < 1e-12);
  CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() < 1e-13);
}

TEST_CASE("faces all but parallel, deep in each other: both witness points are on their surfaces") {
  const Cloud cube = box(0.2, 0.2, 0.2), plate = box(0.4, 0.1, 0.01);
  const std::vector<Shape> shapes{Shape::boxOf({0.2, 0.2, 0.2}), Shape::polytopeOf(cube.data(), 8),
                                  Shape::polytopeOf(plate.data(), 8), Shape::cylinderOf(0.1, 0.2)};
  Random random(12);
  int deep = 0;
  for (int i = 0; i < 4000; ++i) {
    const Shape &a = shapes[static_cast<std::size_t>(i % 4)],
                &b = shapes[static_cast<std::size_t>(i / 4 % 4)];
    const Vector3d shift(random.below(5) - 2, random.below(5) - 2, random.below(5) - 2);
    const Isometry3d there = pose(random.rotation(i % 3 ? 1e-7 : 1e-8), 0.05 * shift);
    const Distance d = distance(a, at(0, 0, 0), b, there);
    if (d.status != DistanceStatus::exact || d.distance >= 0) continue;
    ++deep;
    CAPTURE(i, d.distance);
    const Vector3d turned = there.linear().transpose() * d.normal;
    CHECK(std::abs(d.normal.dot(a.support(d.normal) - d.point[0])) <= 1e-14);
    CHECK(std::abs(turned.dot(b.support(-turned) - there.inverse() * d.point[1])) <= 1e-14);
  }
  CHECK(deep > 2000);
}

TEST_CASE("shapes that the distance proves apart are farther than 0, however near they are") {
  const Cloud corners = box(0.2, 0.2, 0.2), thread = box(0.2, 1e-7, 1e-7);
  const Vector3d triangle[] = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
  Isometry3d beside = at(-0.17648421873796241, -0.010000000000000004, -0.10000000000308093);
  beside.linear() << 0.76484218728448838, -0.64421768723769113, 0, 0.64421768723769113, 0.76484218728448838,
      0, 0, 0, 1;
  const Shape cube = Shape::polytopeOf(corners.data(), 8);
  const Shape flat = Shape::triangleOf(triangle[0], triangle[1], triangle[2]);
  CHECK(distance(cube, at(0, 0, 0), flat, beside).lower > 9e-12);
  CHECK(isFartherThan(0, cube, at(0, 0, 0), flat, beside));
  const std::vector<Shape> shapes{cube,
                                  flat,
                                  Shape::polytopeOf(thread.data(), 8),
                                  Shape::boxOf({0.1, 0.2, 0.3}),
                                  Shape::cylinderOf(0.1, 0.2),
                                  Shape::coneOf(0.1, 0.2)};
  Random random(13);
  int apart = 0;
  for (int i = 0; i < 6000; ++i) {
    const Shape &a = shapes[static_cast<std::size_t>(i % 6)],
                &b = shapes[static_cast<std::size_t>(i / 6 % 6)];
    Isometry3d there = pose(random.rotation(), random.direction());
    const Distance before = distance(a, at(0, 0, 0), b, there);
    const double gap = std::pow(10.0, -8 - random.below(6));
    there.translation() += (gap - before.distance) * before.normal;
    const Distance d = distance(a, at(0, 0, 0), b, there);
    if (d.lower < 1e-14) continue;  // for such sizes, a smaller distance may be rounding
    ++apart;
    CAPTURE(i, d.lower);
    CHECK(isFartherThan(0, a, at(0, 0, 0), b, there));
  }
  CHECK(apart > 3000);
}
