// Motions proven free, and first contacts at their time: closed forms, and samples of FCL's own motions.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/spline_motion.h>
#include <fcl/math/motion/translation_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "test/adapter/element_kinds.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

fcl::ContinuousCollisionRequestd requestOf(fcl::CCDMotionType type, double tolerance = 1e-9) {
  return fcl::ContinuousCollisionRequestd(10, tolerance, type);
}

/// A motion of FCL, to be sampled. Shared, not unique: deleting one through its base frees what `new` made.
std::shared_ptr<fcl::MotionBased> fclMotion(const Isometry3d& begin, const Isometry3d& end,
                                            fcl::CCDMotionType type) {
  if (type == fcl::CCDM_TRANS) return std::make_shared<fcl::TranslationMotion<double>>(begin, end);
  if (type == fcl::CCDM_SCREW) return std::make_shared<fcl::ScrewMotion<double>>(begin, end);
  const Eigen::Matrix3d r1 = begin.linear(), r2 = end.linear();
  return std::make_shared<fcl::InterpMotion<double>>(r1, begin.translation(), r2, end.translation(),
                                                     Vector3d(0, 0, 0));
}

Isometry3d posed(const fcl::MotionBased& motion, double t) {
  Isometry3d result;
  motion.integrate(t);
  motion.getCurrentTransform(result);
  return result;
}

}  // namespace

TEST_CASE("a ball that flies at a ball, a half space or past them meets them at the closed form's time") {
  const fcl::Sphered ball(0.1);
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));  // a ball too
  const fcl::Halfspaced ground(Vector3d::UnitZ(), 0.0);
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d from = random.direction(), to = -from + 0.4 * random.direction();
    for (const fcl::CollisionGeometryd* first : {static_cast<const fcl::CollisionGeometryd*>(&ball),
                                                 static_cast<const fcl::CollisionGeometryd*>(&point)}) {
      fcl::ContinuousCollisionResultd result;
      const double t =
          fcl_stpbv::continuousCollide(first, pose(random.rotation(), from), pose(random.rotation(), to),
                                       &ball, at(0, 0, 0), at(0, 0, 0), requestOf(fcl::CCDM_LINEAR), result);
      // |from + t way| = 0.2
      const Vector3d way = to - from;
      const double a = way.squaredNorm(), b = from.dot(way), c = from.squaredNorm() - 0.04,
                   root = b * b - a * c;
      CAPTURE(i, t, root);
      CHECK(result.is_collide == (root >= 0));
      hits += root >= 0;
      if (root < 0) {
        CHECK(t == 1);
        continue;
      }
      const double truth = (-b - std::sqrt(root)) / a;
      CHECK(t >= truth - 1e-12 / std::sqrt(root));
      CHECK(t <= truth + 1.1e-9);
      CHECK((result.contact_tf1.translation() - (from + t * way)).norm() <= 1e-14);
    }
    fcl::ContinuousCollisionResultd result;
    const Vector3d high(0, 0, random.uniform(0.2, 1));
    const double t =
        fcl_stpbv::continuousCollide(&ground, at(0, 0, 0), at(0, 0, 0), &ball, pose(random.rotation(), high),
                                     at(1, 0, 0), requestOf(fcl::CCDM_SCREW), result);
    CHECK(result.is_collide);
    CHECK(t > 0);
  }
  CHECK(hits > 200);
}

TEST_CASE(
    "half spaces and planes that turn meet a ball where dense samples see it first, or are proven free") {
  const fcl::Sphered ball(0.1);
  const fcl::Halfspaced ground(Vector3d::UnitZ(), -0.3);
  const fcl::Planed sheet(Vector3d::UnitZ(), -0.3);
  Random random(3);
  int free = 0, hits = 0;
  for (int i = 0; i < 60; ++i)
    for (const fcl::CollisionGeometryd* flat : {static_cast<const fcl::CollisionGeometryd*>(&ground),
                                                static_cast<const fcl::CollisionGeometryd*>(&sheet)}) {
      const Isometry3d from = pose(random.rotation(0.5), 0.1 * random.direction()),
                       to = pose(random.rotation(0.5), 0.1 * random.direction());
      SteadyMotion turn, still;
      REQUIRE(steadyMotion(from, to, fcl::CCDM_SCREW, turn));
      const Isometry3d place = pose(random.rotation(), random.uniform(0, 0.3) * random.direction());
      REQUIRE(steadyMotion(place, place, fcl::CCDM_SCREW, still));
      const MotionAnswer found = firstContact(*flat, turn, ball, still, {0, 1e-6});
      REQUIRE(found.verdict != MotionVerdict::undecided);
      const bool isFree = found.verdict == MotionVerdict::free;
      ++(isFree ? free : hits);
      for (int k = 0; k <= 500; ++k) {
        const double t = k / 500.0;
        if (!isFree && t >= found.from) break;
        const Isometry3d at = turn.at(t);
        const Vector3d n = at.linear().col(2);
        const double height = n.dot(place.translation() - at.translation()) + 0.3;
        REQUIRE((flat == &ground ? height : std::abs(height)) > 0.1 - 1e-15);
      }
    }
  CHECK((free > 20 && hits > 5));
}

TEST_CASE("a turning arm meets a ball at the closed form's angle, and one just out of reach is free") {
  // A segment along x, as a volume of two points: its tip is a ball of radius r, 1 m out.
  const StpBvGeometry arm(StpBv::build({{0, 0, 0}, {1, 0, 0}}, {0.05, 10}));
  const fcl::Sphered ball(0.05);
  const Eigen::Matrix3d half = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()).toRotationMatrix();
  const auto ask = [&](const Vector3d& where, double tolerance) {
    SteadyMotion turn, still;
    REQUIRE(steadyMotion(at(0, 0, 0), pose(half, {0, 0, 0}), fcl::CCDM_SCREW, turn));
    REQUIRE(steadyMotion(at(where.x(), where.y(), where.z()), at(where.x(), where.y(), where.z()),
                         fcl::CCDM_TRANS, still));
    return firstContact(arm, turn, ball, still, {0, tolerance});
  };
  for (const double angle : {0.3, 0.7, 1.2}) {
    const double reach = 1.02;  // the tip's ball passes within 0.02 m of it
    const MotionAnswer found = ask({reach * std::cos(angle), reach * std::sin(angle), 0}, 1e-9);
    // The tip at angle u is 0.1 m from the ball: 1 + reach^2 - 2 reach cos(angle - u) = 0.01.
    const double truth = (angle - std::acos((1 + reach * reach - 0.01) / (2 * reach))) / (0.5 * M_PI);
    CHECK(found.verdict == MotionVerdict::contact);
    CHECK(found.from <= truth + 1e-14);
    CHECK(found.until >= truth - 1e-14);
    CHECK(found.until - found.from <= 1e-9);
  }
  const MotionAnswer free = ask({1.1 + 1e-6, 1e-3, 0}, 1e-9);
  CHECK(free.verdict == MotionVerdict::free);
  CHECK(free.queries < 200);
}

TEST_CASE(
    "no contact that dense samples of FCL's motions see is missed, and none is made up, for all kinds") {
  std::vector<ElementKind> kinds = elementKinds();
  const auto volume =
      std::make_shared<StpBvGeometry>(StpBv::build(randomHull(30, {0.2, 0.15, 0.1}, 3), {0.02, 10}));
  kinds.push_back({"volume", volume, {}, false});
  Random random(2);
  int free = 0, hits = 0;
  long queries = 0;
  for (const ElementKind& first : kinds)
    for (const ElementKind& second : kinds)
      for (const fcl::CCDMotionType type : {fcl::CCDM_TRANS, fcl::CCDM_LINEAR, fcl::CCDM_SCREW}) {
        if (second.surface && random.below(4) > 0) continue;  // to save time
        CAPTURE(first.name, second.name, type);
        Isometry3d ends[4];
        for (Isometry3d& end : ends) end = pose(random.rotation(), 0.7 * random.direction());
        const auto a = fclMotion(ends[0], ends[1], type), b = fclMotion(ends[2], ends[3], type);
        fcl::ContinuousCollisionResultd result;
        const double t = fcl_stpbv::continuousCollide(first.geometry.get(), a.get(), second.geometry.get(),
                                                      b.get(), requestOf(type, 1e-4), result);
        REQUIRE(t >= 0);
        const auto apart = [&](double time) {
          return distance(*first.geometry, posed(*a, time), *second.geometry, posed(*b, time)).distance;
        };
        constexpr int kSamples = trials(200);
        for (int i = 0; i <= kSamples; ++i) {
          const double time = static_cast<double>(i) / kSamples;
          if (time >= t - 1e-4) break;
          REQUIRE(apart(time) > -1e-12);
        }
        if (result.is_collide) {
          ++hits;
          CHECK(apart(t) <= 1e-9);
        } else {
          ++free;
          CHECK(apart(1) > -1e-12);
        }
        SteadyMotion sa, sb;
        REQUIRE((steadyMotion(*a, sa) && steadyMotion(*b, sb)));
        queries += firstContact(*first.geometry, sa, *second.geometry, sb).queries;
        for (const double time : {0.0, 0.3, 1.0})
          CHECK((sa.at(time).matrix() - posed(*a, time).matrix()).norm() <= 1e-13);
      }
  CAPTURE(queries, free, hits);
  CHECK((free > 40 && hits > 40));
  CHECK(queries <= 100 * (free + hits));
}

TEST_CASE("touching, starting in contact, a thin wall, splines and broken poses") {
  const fcl::Boxd crate(0.2, 0.2, 0.2), wall(1e-3, 2, 2);
  fcl::ContinuousCollisionResultd result;
  const auto ask = [&](const fcl::CollisionGeometryd& a, const Isometry3d& from, const Isometry3d& to,
                       const fcl::CollisionGeometryd& b, const Isometry3d& still, fcl::CCDMotionType type) {
    return fcl_stpbv::continuousCollide(&a, from, to, &b, still, still, requestOf(type, 1e-6), result);
  };
  // FCL's naive checker takes ten samples and flies through.
  const double t = ask(crate, at(-1, 0, 0), at(3, 0, 0), wall, at(0.0, 0, 0), fcl::CCDM_LINEAR);
  CHECK(result.is_collide);
  CHECK(std::abs(t - (1 - 0.1 - 5e-4) / 4) <= 1e-6);
  CHECK(ask(crate, at(0.05, 0, 0), at(3, 0, 0), wall, at(0, 0, 0), fcl::CCDM_TRANS) == 0);
  CHECK(result.is_collide);
  // Away from a near wall: the normal decides at once.
  CHECK(ask(crate, at(0.11, 0, 0), at(3, 0, 0), wall, at(0, 0, 0), fcl::CCDM_LINEAR) == 1);
  CHECK_FALSE(result.is_collide);
  // Along the wall at a distance of a micrometre.
  CHECK(ask(crate, at(0.1005 + 1e-6, -1, 0), at(0.1005 + 1e-6, 1, 0), wall, at(0, 0, 0), fcl::CCDM_LINEAR) ==
        1);
  CHECK_FALSE(result.is_collide);
  CHECK(ask(crate, at(-1, 0, 0), at(1, 0, 0), wall, at(0, 0, 0), fcl::CCDM_SPLINE) == -1);
  CHECK(result.is_collide);
  Isometry3d broken = at(0, 0, 0);
  broken.linear() *= 2;
  CHECK(ask(crate, broken, at(1, 0, 0), wall, at(5, 0, 0), fcl::CCDM_LINEAR) == -1);
  CHECK(result.is_collide);
  CHECK(ask(crate, at(std::nan(""), 0, 0), at(1, 0, 0), wall, at(5, 0, 0), fcl::CCDM_LINEAR) == -1);
  const fcl::BVHModel<fcl::OBBRSSd> nothing;
  CHECK(ask(nothing, at(0, 0, 0), at(1, 0, 0), wall, at(5, 0, 0), fcl::CCDM_LINEAR) == -1);
  const Vector3d o(0, 0, 0), x(1, 0, 0);
  const fcl::SplineMotion<double> spline(o, x, x, x, o, o, o, o);
  const fcl::TranslationMotion<double> still(at(5, 0, 0), at(5, 0, 0));
  CHECK(fcl_stpbv::continuousCollide(&crate, &spline, &wall, &still, requestOf(fcl::CCDM_SPLINE), result) ==
        -1);
}

TEST_CASE("objects that carry their motion, and a screw without a turn, go where they are told") {
  const auto crate = std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2);
  const auto far = std::make_shared<fcl::ScrewMotion<double>>(at(0, 0, 0), at(0.5, 0, 0));
  const auto still = std::make_shared<fcl::TranslationMotion<double>>(at(0.65, 0, 0), at(0.65, 0, 0));
  const fcl::ContinuousCollisionObjectd a(crate, far), b(crate, still);
  fcl::ContinuousCollisionResultd result;
  // FCL's own screw moves only 0.25 m, the way times its length.
  CHECK(std::abs(fcl_stpbv::collide(&a, &b, requestOf(fcl::CCDM_SCREW, 1e-6), result) - 0.9) <= 1e-6);
  CHECK(result.is_collide);
}

TEST_CASE("a motion object is only read: it stays at the time to which its owner has moved it") {
  const fcl::Boxd crate(0.2, 0.2, 0.2);
  const fcl::TranslationMotion<double> slide(at(0, 0, 0), at(1, 0, 0));
  const fcl::ScrewMotion<double> screw(at(2, 0, 0), at(3, 0, 0));
  const fcl::InterpMotion<double> interpolation(at(4, 0, 0), at(5, 0, 0));
  for (const fcl::MotionBased* motion :
       std::initializer_list<const fcl::MotionBased*>{&slide, &screw, &interpolation}) {
    motion->integrate(0.5);
    Isometry3d before, after;
    motion->getCurrentTransform(before);
    fcl::ContinuousCollisionResultd result;
    continuousCollide(&crate, motion, &crate, motion, requestOf(fcl::CCDM_TRANS, 1e-6), result);
    motion->getCurrentTransform(after);
    CHECK(after.matrix() == before.matrix());
  }
}

TEST_CASE(
    "no motion meets cells that FCL's marks call free, and the poses of the result are those of the end") {
  const fcl::Sphered ball(0.1);
  fcl::Sphered mark(0.1);
  for (const double density : {1.0, 0.5}) {
    mark.cost_density = density;
    fcl::ContinuousCollisionResultd result, mirrored;
    const double met = fcl_stpbv::continuousCollide(&mark, at(0, 0, 0), at(0, 0, 0), &ball, at(-1, 0, 0),
                                                    at(1, 0, 0), requestOf(fcl::CCDM_TRANS), result);
    CHECK(result.is_collide == (density == 1));
    CHECK(std::abs(met - (density == 1 ? 0.4 : 1)) <= 1e-9);
    CHECK(result.time_of_contact == met);
    CHECK((result.contact_tf2.translation() - Vector3d(2 * met - 1, 0, 0)).norm() <= 1e-15);
    CHECK(fcl_stpbv::continuousCollide(&ball, at(-1, 0, 0), at(1, 0, 0), &mark, at(0, 0, 0), at(0, 0, 0),
                                       requestOf(fcl::CCDM_TRANS), mirrored) == met);
  }
}

#if FCL_HAVE_OCTOMAP
TEST_CASE("a tree whose cells are all free is met by no motion") {
  const fcl::Sphered ball(0.1);
  for (const bool wall : {false, true}) {
    const auto cells = std::make_shared<octomap::OcTree>(0.1);
    for (int i = 0; i < 10; ++i)
      cells->updateNode(octomap::point3d(0.05F, 0.1F * static_cast<float>(i), 0), false);
    if (wall) cells->updateNode(octomap::point3d(0.05F, 0.45F, 0), true);
    const fcl::OcTreed tree(cells);
    fcl::ContinuousCollisionResultd result;
    const double met = fcl_stpbv::continuousCollide(&tree, at(0, 0, 0), at(0, 0, 0), &ball, at(-1, 0.45, 0),
                                                    at(1, 0.45, 0), requestOf(fcl::CCDM_TRANS), result);
    CHECK(result.is_collide == wall);
    CHECK(std::abs(met - (wall ? 0.45 : 1)) <= 1e-7);
    CHECK(fcl_stpbv::continuousCollide(&ball, at(-1, 0.45, 0), at(1, 0.45, 0), &tree, at(0, 0, 0),
                                       at(0, 0, 0), requestOf(fcl::CCDM_TRANS), result) == met);
    if (!wall) {
      SteadyMotion still;
      const MotionAnswer free = firstContact(tree, still, ball, still);
      CHECK(free.verdict == MotionVerdict::free);
      CHECK(free.answer.status == DistanceStatus::exact);
      CHECK(free.answer.distance == std::numeric_limits<double>::max());
    }
    // No motion is clear of an invalid body, and an invalid body's motion is not clear.
    const fcl::Sphered none(-1.0);
    for (const auto& [body, end] : {std::pair<const fcl::Sphered*, double>{&none, 1.0}, {&ball, NAN}}) {
      CHECK(fcl_stpbv::continuousCollide(&tree, at(0, 0, 0), at(0, 0, 0), body, at(-1, 0.45, 0),
                                         at(end, 0.45, 0), requestOf(fcl::CCDM_TRANS), result) == -1);
      CHECK(result.is_collide);
    }
  }
}
#endif

TEST_CASE("a motion derived from FCL's, which may go another way, has no answer") {
  /// A motion that makes a detour in y between its ends.
  struct Detour : fcl::InterpMotion<double> {
    Detour(const Isometry3d& begin, const Isometry3d& end)
        : fcl::InterpMotion<double>(Eigen::Matrix3d(begin.linear()), begin.translation(),
                                    Eigen::Matrix3d(end.linear()), end.translation(), Vector3d(0, 0, 0)) {}
    bool integrate(double t) const override {
      fcl::InterpMotion<double>::integrate(t);
      tf.translation().y() += 4 * t * (1 - t);
      return true;
    }
  };
  const fcl::Sphered ball(0.1);
  const Detour detour(at(-1, 0, 0), at(1, 0, 0));
  const fcl::TranslationMotion<double> still(at(0, 1, 0), at(0, 1, 0));
  SteadyMotion motion;
  CHECK_FALSE(steadyMotion(detour, motion));
  fcl::ContinuousCollisionResultd result;
  CHECK(fcl_stpbv::continuousCollide(&ball, &detour, &ball, &still, {}, result) == -1);
  CHECK(result.is_collide);
}

TEST_CASE(
    "an interpolation of two transforms about a point is followed, though FCL leaves its velocities unset") {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Isometry3d begin = pose(random.rotation(), random.direction()),
                     end = pose(random.rotation(), random.direction());
    const Vector3d point = random.direction();
    const fcl::InterpMotion<double> unset(begin, end, point),
        right(Eigen::Matrix3d(begin.linear()), begin.translation(), Eigen::Matrix3d(end.linear()),
              end.translation(), point);
    SteadyMotion motion, same;
    REQUIRE(steadyMotion(unset, motion));
    REQUIRE(steadyMotion(right, same));
    for (const double t : {0.0, 0.3, 1.0}) {
      CHECK(motion.at(t).matrix() == same.at(t).matrix());
      CHECK((motion.at(t).matrix() - posed(right, t).matrix()).norm() <= 1e-12);
    }
  }
}

TEST_CASE("a motion ends at its end pose, by whatever turn the two poses differ") {
  Random random(7);
  for (const double angle :
       {0.0, 1e-300, 1e-16, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3, 1.0, 3.0, M_PI - 1e-9, M_PI})
    for (int i = 0; i < 50; ++i)
      for (const fcl::CCDMotionType type : {fcl::CCDM_LINEAR, fcl::CCDM_SCREW}) {
        CAPTURE(angle, i, type);
        const Isometry3d begin = pose(random.rotation(), random.direction());
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
        const Isometry3d end = pose(turn * begin.linear(), begin.translation() + 2 * random.direction());
        SteadyMotion motion;
        REQUIRE(steadyMotion(begin, end, type, motion));
        CHECK(motion.at(0).matrix() == begin.matrix());
        CHECK((motion.at(1).matrix() - end.matrix()).norm() <= 1e-14);
        // The velocity is the derivative of the pose, even if the axis is 1e10 m away.
        const double t = random.uniform(0.1, 0.9), h = 1e-5;
        Vector3d velocity;
        motion.at(t, &velocity);
        const Vector3d slope = (motion.at(t + h).translation() - motion.at(t - h).translation()) / (2 * h);
        CHECK((velocity - slope).norm() <= 1e-8);
      }
  // Computed by hand: three times around the z axis, 1 m away, and up.
  const SteadyMotion spiral{at(1, 0, 0), {0, 0, 2}, {0, 6 * M_PI, 0}, {0, 0, 6 * M_PI}};
  CHECK((spiral.at(0.25).translation() - Vector3d(0, -1, 0.5)).norm() <= 1e-15);
  CHECK((spiral.at(1).translation() - Vector3d(1, 0, 2)).norm() <= 1e-14);
}

TEST_CASE("half a turn goes the way round that FCL's does, also between poses of few digits") {
  Random random(17);
  // A number as a float keeps it, as seven digits keep it, and in full.
  const auto kept = [](double x, int how) {
    return how == 0 ? static_cast<double>(static_cast<float>(x)) : how == 1 ? 1e-7 * std::round(1e7 * x) : x;
  };
  for (int i = 0; i < 6000; ++i) {
    Isometry3d begin = pose(random.rotation(), random.direction()), end = begin;
    end.linear() = Eigen::AngleAxisd(M_PI, random.direction()) * begin.linear();
    end.translation() += random.direction();
    for (Isometry3d* one : {&begin, &end})
      one->linear() = one->linear().unaryExpr([&](double x) { return kept(x, i % 3); });
    for (const auto type : {fcl::CCDM_LINEAR, fcl::CCDM_SCREW}) {
      const auto fclObject = fclMotion(begin, end, type);
      SteadyMotion object, poses;
      REQUIRE(steadyMotion(*fclObject, object));
      REQUIRE(steadyMotion(begin, end, type, poses));
      const double digits = i % 3 == 2 ? 1e-12 : 1e-6;  // precision of the poses
      for (const SteadyMotion* motion : {&object, &poses}) {
        INFO(i << " " << type);
        // At a quarter of a turn.
        CHECK((motion->at(0.5).matrix() - posed(*fclObject, 0.5).matrix()).norm() < 10 * digits);
        CHECK((motion->at(1).matrix() - end.matrix()).norm() < 10 * digits);
      }
    }
  }
}

TEST_CASE("a screw by next to no turn is as free, and meets as soon, as the straight motion") {
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));
  const fcl::Sphered ball(0.1);
  for (const double angle : {1e-12, 9e-11, 1.1e-10, 2e-10, 1e-9, 1e-8, 1e-7}) {
    CAPTURE(angle);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    const auto ask = [&](double y, fcl::ContinuousCollisionResultd& result) {
      return fcl_stpbv::continuousCollide(&point, at(-1, y, 0), pose(turn, {1, y, 0}), &ball, at(0, 0, 0),
                                          at(0, 0, 0), requestOf(fcl::CCDM_SCREW, 1e-10), result);
    };
    // Its path bends by angle / 4 m. It passes the ball with 1e-6 m to spare, or meets it head on at 0.4.
    fcl::ContinuousCollisionResultd past, met;
    CHECK(ask(0.2 + 1e-6, past) == 1);
    CHECK_FALSE(past.is_collide);
    CHECK((past.contact_tf1.translation() - Vector3d(1, 0.2 + 1e-6, 0)).norm() <= 1e-15);
    CHECK(std::abs(ask(0, met) - 0.4) <= 1.1e-10 + angle);
    CHECK(met.is_collide);
    CHECK(distance(point, met.contact_tf1, ball, met.contact_tf2).distance <= 0);
  }
}

TEST_CASE("an undecided motion is a collision at the time until which it is proven free") {
  // A point that moves through a plane is in the plane at a time that is no double.
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0, 1}));
  const fcl::Planed plane(Vector3d::UnitZ(), 0.0);
  const Isometry3d from = at(0, 0, 0.3), to = at(0.1, 0, -std::sqrt(0.5));
  SteadyMotion motion, still;
  REQUIRE(steadyMotion(from, to, fcl::CCDM_LINEAR, motion));
  REQUIRE(steadyMotion(at(0, 0, 0), at(0, 0, 0), fcl::CCDM_TRANS, still));
  const MotionAnswer found = firstContact(point, motion, plane, still, {0, 1e-6});
  REQUIRE(found.verdict == MotionVerdict::undecided);
  fcl::ContinuousCollisionResultd result;
  const double t = fcl_stpbv::continuousCollide(&point, from, to, &plane, at(0, 0, 0), at(0, 0, 0),
                                                requestOf(fcl::CCDM_LINEAR, 1e-6), result);
  CHECK(result.is_collide);
  CHECK((t == found.from && result.time_of_contact == t));
  CHECK(result.contact_tf1.matrix() == motion.at(t).matrix());
  const double truth = 0.3 / (0.3 + std::sqrt(0.5));
  CHECK((t <= truth && t > truth - 1e-11));
}

TEST_CASE("two meshes never come within a margin below 0") {
  fcl::BVHModel<fcl::OBBRSSd> mesh;
  fcl::generateBVHModel(mesh, fcl::Boxd(1, 1, 1), Isometry3d::Identity());
  SteadyMotion still, through;
  through.begin.translation() = Vector3d(-2, 0.1, 0.2);
  through.linear = {4, 0, 0};
  const MotionAnswer answer = firstContact(mesh, still, mesh, through, {-1e-7});
  CHECK(answer.verdict == MotionVerdict::free);
  CHECK(answer.queries < 10);
  CHECK(firstContact(mesh, still, mesh, through, {0}).verdict == MotionVerdict::contact);
}
