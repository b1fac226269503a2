// The code of docs/proofs.md, for the robot in data/hrp2_style. Run it in that folder.
#include <cstdio>

#include "docs/examples/reported.h"
#include "fcl_stpbv/robot/pair_proof.h"

using namespace fcl_stpbv;

namespace {

int run() {
  const auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*robot));
  const auto kinematics = std::make_shared<const Kinematics>(robot);
  // clang-format off
const ProofScene scene = proofScene(kinematics, geometry, {}, 0.0);   // once for all pairs
const LinkPair pair{robot->link("BODY"), robot->link("HEAD_LINK1")};
PairProof proof = unproven(scene, pair);                              // one box: all joints' ranges
for (int i = 0; i < 100 && !proof.open.empty(); ++i) proof = provePair(scene, pair, proof.open, 1000);
  // clang-format on
  std::printf("%s\n", proof.proven() ? "proven" : proof.collision ? "collides" : "open");
  return proof.proven() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
