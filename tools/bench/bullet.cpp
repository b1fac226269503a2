// Bullet's GJK. Bullet is optional; without it, this file reports that it is missing.
#include "tools/bench/method.h"

#ifdef FCL_STPBV_BULLET
#include "tools/bench/bullet_hulls.h"
#endif

namespace fcl_stpbv::benchmark {

#ifdef FCL_STPBV_BULLET

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class Bullet : public Method {
 public:
  explicit Bullet(const Bodies& bodies)
      : Method("Bullet GJK", sizeof(btScalar) == 8 ? "double precision" : "single precision", false) {
    fill(a_, bodies.a->hull());
    fill(b_, bodies.b->hull());
  }

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    const btPointCollector result = nearestPoints(a_, toBullet(a), b_, toBullet(b), simplex_);
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
