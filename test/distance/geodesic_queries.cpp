// Queries of two turning geodesic spheres of 162 vertices, and of simple shapes that move in the same way,
// whose instructions are counted: geodesic_queries QUERIES. Without a cache ("cold") the step does not
// matter, only which distances occur.
#include <fcl/geometry/shape/cylinder.h>

#include <cstdio>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/arguments.h"
#include "test/reference/counted.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using benchmark::GeodesicMotion;
using benchmark::Poses;

namespace {

constexpr double kDeepest = 0.3, kDeep = 0.36;  // m between the centres

Poses posesOf(const benchmark::Step& step, double nearest) {
  Poses poses;
  GeodesicMotion(step, 1, nearest).next(poses, GeodesicMotion::kCycle);
  return poses;
}

/// Only bodies that overlap by more than their margins: by 4 to 10 cm.
Poses deepPoses() {
  Poses all, deep;
  GeodesicMotion(benchmark::smallStep(), 1, kDeepest).next(all, 12 * GeodesicMotion::kCycle);
  for (std::size_t i = 0; i < all.a.size(); ++i) {
    if ((all.b[i].translation() - all.a[i].translation()).norm() > kDeep) continue;
    deep.a.push_back(all.a[i]);
    deep.b.push_back(all.b[i]);
  }
  return deep;
}

class Queries {
 public:
  explicit Queries(std::size_t count) : count_(count) {}

  /// A number that depends on the answers.
  double sum() const { return sum_; }

  template <class Ask>
  void count(const char* name, const Poses& poses, Ask ask) {
    cache_ = {};
    test::counted(name, [&] {
      for (std::size_t i = 0; i < count_; ++i)
        sum_ += ask(poses.a[i % poses.a.size()], poses.b[i % poses.a.size()]);
    });
  }

  void all() {
    const StpBv::Ptr a = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10}),
                     b = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10});
    const StpBvGeometry first(a), second(b);
    const Poses small = posesOf(benchmark::smallStep(), GeodesicMotion::kNearest),
                large = posesOf(benchmark::largeStep(), GeodesicMotion::kNearest),
                mixed = posesOf(benchmark::smallStep(), kDeepest), deep = deepPoses();
    const auto warm = [&](const auto& poseA, const auto& poseB) {
      return distance(*a, poseA, *b, poseB, &cache_).distance;
    };
    const auto cold = [&](const auto& poseA, const auto& poseB) {
      return distance(first, poseA, second, poseB).distance;
    };
    const auto verdict = [&](const auto& poseA, const auto& poseB) {
      return collides(first, poseA, second, poseB) ? 1.0 : 0.0;
    };
    const auto contact = [&](const fcl::CollisionGeometryd& one, const fcl::CollisionGeometryd& other) {
      return [&](const auto& poseA, const auto& poseB) {
        fcl::CollisionResultd result;
        collide(&one, poseA, &other, poseB, fcl::CollisionRequestd(1, true), result, {&cache_});
        return result.isCollision() ? result.getContact(0).penetration_depth : 0.0;
      };
    };
    count("small", small, warm);
    count("large", large, warm);
    count("deep", deep, warm);
    count("adapter_cold", large, cold);
    count("verdict_cold", large, verdict);
    count("deep_verdict_cold", deep, verdict);
    count("contact", mixed, contact(first, second));

    const StpBvGeometry smoothBox(StpBv::build(test::box(0.2, 0.3, 0.4), {0.01, 10}));
    const fcl::Cylinderd cylinder(0.1, 0.4);
    const auto ball = detail::hullGeometry(test::geodesicSphere(0.15, 2)),
               box = detail::hullGeometry(test::box(0.2, 0.3, 0.4));
    const Poses touching = posesOf(benchmark::smallStep(), 0.15);
    count("shapes", large, [&](const auto& poseA, const auto& poseB) {
      return distance(cylinder, poseA, *ball, poseB).distance;
    });
    count("shapes_contact", touching, contact(cylinder, *ball));
    count("shape_contact", touching, contact(smoothBox, *box));
    count("fine_shape_contact", touching, contact(first, cylinder));
  }

 private:
  std::size_t count_;
  PairCache cache_;
  double sum_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  Queries queries(static_cast<std::size_t>(test::Arguments(argc, argv, "[QUERIES]", 1).number(1, 840)));
  queries.all();
  std::printf("%.17g\n", queries.sum());
  return 0;
}
