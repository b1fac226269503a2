// FCL with its broadphase used as intended: objects are registered once, then moved and updated at each
// configuration; a callback looks pairs up in a table.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "fcl_stpbv/numbers.h"
#include "tools/bench/robot/peer.h"

namespace fcl_stpbv::benchmark {
namespace {

using detail::at;

class Fcl : public Peer {
 public:
  explicit Fcl(const test::Problem& robot)
      : Peer("FCL, broadphase"), robot_(robot), state_(robot.kinematics->makeState()) {
    const std::vector<Body>& bodies = robot.geometry->bodies;
    isChecked_.assign(bodies.size(), std::vector<char>(bodies.size(), 0));
    for (const CheckedPair& pair : robot.pairs)
      isChecked_[at(pair.body)][at(pair.other)] = isChecked_[at(pair.other)][at(pair.body)] = 1;
    for (const Body& body : bodies) {
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(body.geometry));
      objects_.back()->setUserData(reinterpret_cast<void*>(objects_.size() - 1));
      manager_.registerObject(objects_.back().get());
    }
    place(robot.kinematics->neutral());
    manager_.setup();
  }

  long hits(const Eigen::Ref<const Eigen::VectorXd>& q, bool first) override {
    place(q);
    manager_.update();
    Query query{&isChecked_, first, 0};
    manager_.collide(&query, &Fcl::callback);
    return query.hits;
  }

  long distances(const Eigen::Ref<const Eigen::VectorXd>& q) override {
    place(q);
    const fcl::DistanceRequestd request;
    long meet = 0;
    for (const CheckedPair& pair : robot_.pairs) {
      fcl::DistanceResultd result;
      meet +=
          fcl::distance(objects_[at(pair.body)].get(), objects_[at(pair.other)].get(), request, result) <= 0;
    }
    return meet;
  }

  double leastDistance(const Eigen::Ref<const Eigen::VectorXd>& q) override {
    place(q);
    manager_.update();
    LeastDistance query{&isChecked_, {}};
    manager_.distance(&query, &Fcl::nearer);
    return query.result.min_distance;
  }

 private:
  struct Query {
    const std::vector<std::vector<char>>* isChecked;
    bool first;
    long hits;
  };
  struct LeastDistance {
    const std::vector<std::vector<char>>* isChecked;
    fcl::DistanceResultd result;
  };

  static std::size_t indexOf(const fcl::CollisionObjectd* object) {
    return reinterpret_cast<std::size_t>(object->getUserData());
  }

  // As FCL's own callback: stops at the first pair that meets.
  static bool nearer(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
    LeastDistance& query = *static_cast<LeastDistance*>(data);
    if ((*query.isChecked)[indexOf(a)][indexOf(b)])
      fcl::distance(a, b, fcl::DistanceRequestd(), query.result);
    least = query.result.min_distance;
    return least <= 0;
  }

  static bool callback(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    Query& query = *static_cast<Query*>(data);
    if (!(*query.isChecked)[indexOf(a)][indexOf(b)]) return false;
    fcl::CollisionResultd result;
    query.hits += fcl::collide(a, b, fcl::CollisionRequestd(), result) > 0;
    return query.first && query.hits > 0;
  }

  void place(const Eigen::Ref<const Eigen::VectorXd>& q) {
    robot_.kinematics->forwardPoses(q, state_);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      const Body& body = robot_.geometry->bodies[i];
      objects_[i]->setTransform(state_.link[at(body.link)] * body.pose);
      objects_[i]->computeAABB();
    }
  }

  const test::Problem& robot_;
  Kinematics::State state_;
  std::vector<std::vector<char>> isChecked_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

}  // namespace

std::unique_ptr<Peer> fclPeer(const test::Problem& robot) { return std::make_unique<Fcl>(robot); }

}  // namespace fcl_stpbv::benchmark
