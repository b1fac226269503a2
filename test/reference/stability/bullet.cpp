// Bullet's GJK with its EPA for overlaps. Bullet is optional; without it, this file reports that it is
// missing.
#include "test/reference/stability/contestant.h"

#ifdef FCL_STPBV_BULLET
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace fcl_stpbv::stability {

using Eigen::Vector3d;

namespace {

btVector3 toBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btTransform toBullet(const Eigen::Isometry3d& pose) {
  btMatrix3x3 rotation;
  for (int i = 0; i < 3; ++i) rotation[i] = toBullet(Vector3d(pose.linear().row(i)));
  return btTransform(rotation, toBullet(Vector3d(pose.translation())));
}

class Bullet : public Contestant {
 public:
  explicit Bullet(const Situation& s) {
    for (const Vector3d& p : s.a->corners) a_.addPoint(toBullet(p), false);
    for (const Vector3d& p : s.b->corners) b_.addPoint(toBullet(p), false);
    for (btConvexHullShape* shape : {&a_, &b_}) {
      shape->recalcLocalAabb();
      shape->setMargin(0);
    }
  }

  Answer query(const Placement& at) override {
    btGjkPairDetector detector(&a_, &b_, &simplex_, &depth_);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA = toBullet(at.a);
    input.m_transformB = toBullet(at.b);
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    Answer answer;
    if (!result.m_hasResult) {
      answer.kind = Answer::Kind::refusal;
      return answer;
    }
    const auto back = [](const btVector3& v) { return Vector3d(v.x(), v.y(), v.z()); };
    answer.kind = Answer::Kind::distance;
    answer.distance = result.m_distance;
    const Vector3d n = -back(result.m_normalOnBInWorld), q = back(result.m_pointInWorld);
    put(n, answer.normal);
    put(q - result.m_distance * n, answer.point[0]);
    put(q, answer.point[1]);
    answer.hasPoints = true;
    return answer;
  }

 private:
  btConvexHullShape a_, b_;
  btVoronoiSimplexSolver simplex_;
  btGjkEpaPenetrationDepthSolver depth_;
};

}  // namespace

std::unique_ptr<Contestant> bullet(const Situation& s) { return std::make_unique<Bullet>(s); }

}  // namespace fcl_stpbv::stability

#else

std::unique_ptr<fcl_stpbv::stability::Contestant> fcl_stpbv::stability::bullet(const Situation&) {
  return nullptr;
}

#endif
