// FCL's GJK with the duality gap as its stopping criterion, for each pair from its last answer.
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "tools/bench/robot/peer.h"

namespace fcl_stpbv::benchmark {
namespace {

using namespace detail;

class GapStop : public Peer {
 public:
  explicit GapStop(const test::Problem& robot)
      : Peer("FCL's GJK, duality-gap stop, no J"),
        robot_(robot),
        state_(robot.kinematics->makeState()),
        start_(robot.pairs.size()) {}

  long distances(const Eigen::Ref<const Eigen::VectorXd>& q) override {
    robot_.kinematics->forwardPoses(q, state_);
    const auto bodyAt = [&](int i) -> const Body& { return robot_.geometry->bodies[at(i)]; };
    const auto poseOf = [&](const Body& body) { return state_.link[at(body.link)] * body.pose; };
    long meet = 0;
    for (std::size_t i = 0; i < robot_.pairs.size(); ++i) {
      const Body &a = bodyAt(robot_.pairs[i].body), &b = bodyAt(robot_.pairs[i].other);
      const PolyhedralWitness w = polyhedralWitness(asStpBv(a.geometry.get())->hull(), poseOf(a),
                                                    asStpBv(b.geometry.get())->hull(), poseOf(b), start_[i]);
      start_[i] = w.start();
      meet += w.verdict == PolyhedralWitness::Verdict::overlapping;
    }
    return meet;
  }

 private:
  const test::Problem& robot_;
  Kinematics::State state_;
  std::vector<WitnessStart> start_;
};

}  // namespace

// Supports only hulls: a robot with other bodies is not compared.
std::unique_ptr<Peer> gapStopPeer(const test::Problem& robot) {
  for (const Body& body : robot.geometry->bodies)
    if (!asStpBv(body.geometry.get())) return nullptr;
  return std::make_unique<GapStop>(robot);
}

}  // namespace fcl_stpbv::benchmark
