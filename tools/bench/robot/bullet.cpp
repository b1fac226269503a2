// Bullet's collision world: hulls without margins. Pairs are filtered before the narrowphase, which keeps
// manifolds from one configuration to the next. Bullet is optional; without it, this file reports that it is
// missing.
#include <algorithm>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "tools/bench/robot/peer.h"

#ifdef FCL_STPBV_BULLET
#include <btBulletCollisionCommon.h>

#include "tools/bench/bullet_hulls.h"
#endif

namespace fcl_stpbv::benchmark {

#ifdef FCL_STPBV_BULLET

namespace {

using detail::at;

class Bullet : public Peer, private btOverlapFilterCallback {
 public:
  explicit Bullet(const test::Problem& robot)
      : Peer("Bullet, collision world"), robot_(robot), state_(robot.kinematics->makeState()) {
    const std::vector<Body>& bodies = robot.geometry->bodies;
    isChecked_.assign(bodies.size(), std::vector<char>(bodies.size(), 0));
    for (const CheckedPair& pair : robot.pairs)
      isChecked_[at(pair.body)][at(pair.other)] = isChecked_[at(pair.other)][at(pair.body)] = 1;
    world_.getPairCache()->setOverlapFilterCallback(this);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      shapes_.push_back(std::make_unique<btConvexHullShape>());
      fill(*shapes_.back(), asStpBv(bodies[i].geometry.get())->hull());
      objects_.push_back(std::make_unique<btCollisionObject>());
      objects_.back()->setCollisionShape(shapes_.back().get());
      objects_.back()->setUserIndex(static_cast<int>(i));
      world_.addCollisionObject(objects_.back().get());
    }
  }
  ~Bullet() override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }

  // The world checks all pairs at once, so it cannot stop at a first hit.
  long hits(const Eigen::Ref<const Eigen::VectorXd>& q, bool first) override {
    place(q);
    world_.performDiscreteCollisionDetection();
    long meet = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
      bool deep = false;
      for (int k = 0; k < manifold.getNumContacts(); ++k)
        deep = deep || manifold.getContactPoint(k).getDistance() <= 0;
      meet += deep;
    }
    return first ? std::min(meet, 1L) : meet;
  }

  long distances(const Eigen::Ref<const Eigen::VectorXd>& q) override {
    place(q);
    long meet = 0;
    for (const CheckedPair& pair : robot_.pairs) {
      const std::size_t a = at(pair.body), b = at(pair.other);
      meet += !nearestPoints(*shapes_[a], objects_[a]->getWorldTransform(), *shapes_[b],
                             objects_[b]->getWorldTransform(), simplex_)
                   .m_hasResult;
    }
    return meet;
  }

 private:
  void place(const Eigen::Ref<const Eigen::VectorXd>& q) {
    robot_.kinematics->forwardPoses(q, state_);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const Body& body = robot_.geometry->bodies[i];
      const Eigen::Isometry3d pose = state_.link[at(body.link)] * body.pose;
      objects_[i]->setWorldTransform(toBullet(pose));
    }
  }

  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const auto indexOf = [](btBroadphaseProxy* proxy) {
      return at(static_cast<btCollisionObject*>(proxy->m_clientObject)->getUserIndex());
    };
    return isChecked_[indexOf(a)][indexOf(b)] != 0;
  }

  const test::Problem& robot_;
  Kinematics::State state_;
  std::vector<std::vector<char>> isChecked_;
  std::vector<std::unique_ptr<btConvexHullShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  btVoronoiSimplexSolver simplex_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace

// Supports only hulls: a robot with other bodies is not compared.
std::unique_ptr<Peer> bulletPeer(const test::Problem& robot) {
  for (const Body& body : robot.geometry->bodies)
    if (!asStpBv(body.geometry.get())) return nullptr;
  return std::make_unique<Bullet>(robot);
}

#else

std::unique_ptr<Peer> bulletPeer(const test::Problem&) { return nullptr; }

#endif

}  // namespace fcl_stpbv::benchmark
