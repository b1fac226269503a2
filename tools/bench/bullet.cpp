// Bullet's GJK. Bullet is optional; without it, this file reports that it is missing.
#include "fcl_stpbv/convex/hull_graph.h"
#include "tools/bench/method.h"

#ifdef FCL_STPBV_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#endif

namespace fcl_stpbv::benchmark {

#ifdef FCL_STPBV_BULLET

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

btVector3 toBullet(const Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btTransform toBullet(const Isometry3d& pose) {
  const auto row = [&](int i) { return toBullet(Vector3d(pose.linear().row(i))); };
  btMatrix3x3 rotation;
  for (int i = 0; i < 3; ++i) rotation[i] = row(i);
  return btTransform(rotation, toBullet(Vector3d(pose.translation())));
}

/// Without margins: the same polyhedra that FCL gets.
void fill(btConvexHullShape& shape, const detail::HullGraph& hull) {
  for (int v = 0; v < hull.vertexCount(); ++v) shape.addPoint(toBullet(hull.point(v) + hull.centre()), false);
  shape.recalcLocalAabb();
  shape.setMargin(0);
}

class Bullet : public Method {
 public:
  explicit Bullet(const Bodies& bodies)
      : Method("Bullet GJK", sizeof(btScalar) == 8 ? "double precision" : "single precision", false) {
    fill(a_, bodies.a->hull());
    fill(b_, bodies.b->hull());
  }

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    btGjkPairDetector detector(&a_, &b_, &simplex_, nullptr);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = toBullet(a);
    input.m_transformB = toBullet(b);
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    answer.outcome = !result.m_hasResult ? Outcome::overlap : Outcome::apart;
    answer.distance = result.m_distance;
    const auto back = [](const btVector3& v) { return Vector3d(v.x(), v.y(), v.z()); };
    answer.normal = -back(result.m_normalOnBInWorld);
    answer.point[1] = back(result.m_pointInWorld);
    answer.point[0] = answer.point[1] - answer.distance * answer.normal;
  }

 private:
  btConvexHullShape a_, b_;
  btVoronoiSimplexSolver simplex_;
};

}  // namespace

MethodPtr bulletGjk(const Bodies& bodies) { return std::make_unique<Bullet>(bodies); }

#else

MethodPtr bulletGjk(const Bodies&) { return nullptr; }

#endif

}  // namespace fcl_stpbv::benchmark
