// Proves that two links never collide, by branch and bound over boxes of joint values (docs/proofs.md):
// 1. the distance at the box's middle, minus the largest change that the joints' levers allow;
// 2. else the gap along a plane fixed to a link between the two, minus how far the joints push each body;
// 3. else cut the box where that gains most. The result for a box depends only on that box.
#include "fcl_stpbv/robot/pair_proof.h"

#include <algorithm>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/box_bound.h"

namespace fcl_stpbv {

namespace {

using namespace detail;

using Eigen::Index;

void requireSize(const JointBox& box, Index coordinates) {
  if (box.lower.size() != coordinates || box.upper.size() != coordinates)
    throw Error("a proof's boxes need a lower and an upper limit of each of the pair's " +
                std::to_string(coordinates) + " coordinates");
  if (!(box.lower.array() <= box.upper.array()).all())
    throw Error(
        "a proof's box has a lower limit above the upper one or not a number, so that it holds no "
        "configuration");
}

bool bounded(const JointBox& box) { return box.lower.allFinite() && box.upper.allFinite(); }

bool before(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return std::lexicographical_compare(a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
}

bool boxBefore(const JointBox& a, const JointBox& b) {
  return before(a.lower, b.lower) || (!before(b.lower, a.lower) && before(a.upper, b.upper));
}

}  // namespace

ProofScene proofScene(std::shared_ptr<const Kinematics> kinematics,
                      std::shared_ptr<const RobotGeometry> geometry, std::vector<Obstacle> obstacles,
                      double margin) {
  const auto bodies = std::make_shared<ProofBodies>();
  for (const Body& body : geometry->bodies) bodies->robot.push_back(bodyPoints(*body.geometry, body.pose));
  for (const Obstacle& obstacle : obstacles)
    bodies->obstacles.push_back(bodyPoints(*obstacle.geometry(), obstacle.pose()));
  return {std::move(kinematics), std::move(geometry), std::move(obstacles), margin, bodies};
}

std::vector<int> proofCoordinates(const ProofScene& scene, const LinkPair& pair) {
  return searchOf(scene, pair).coordinates();
}

PairProof unproven(const ProofScene& scene, const LinkPair& pair) {
  const std::vector<int> coordinates = proofCoordinates(scene, pair);
  const Index size = static_cast<Index>(coordinates.size());
  JointBox all{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  for (Index k = 0; k < size; ++k) {
    all.lower[k] = scene.kinematics->lower()[coordinates[static_cast<std::size_t>(k)]];
    all.upper[k] = scene.kinematics->upper()[coordinates[static_cast<std::size_t>(k)]];
  }
  PairProof proof;
  proof.open.push_back(std::move(all));
  return proof;
}

PairProof provePair(const ProofScene& scene, const LinkPair& pair, std::vector<JointBox> boxes,
                    long maxBoxes) {
  PairProof proof;
  proof.open = std::move(boxes);
  BoxBound bound(scene, pair);
  for (const JointBox& box : proof.open) requireSize(box, bound.coordinates());
  if (!bound.hasBound() || !std::all_of(proof.open.begin(), proof.open.end(), bounded)) return proof;
  std::vector<JointBox> stuck;  // unclear boxes that cannot be cut
  while (!proof.open.empty() && proof.boxes < maxBoxes) {
    JointBox box = std::move(proof.open.back());
    proof.open.pop_back();
    ++proof.boxes;
    const BoxBound::Verdict verdict = bound.look(box);
    if (verdict == BoxBound::Verdict::clear) continue;
    if (verdict == BoxBound::Verdict::collision) {
      proof.collision = bound.middle();
      proof.open.clear();
      return proof;
    }
    const int k = bound.cut();
    if (k < 0) {
      stuck.push_back(std::move(box));
      continue;
    }
    JointBox other = box;
    box.upper[k] = other.lower[k] = middleOf(box)[k];
    proof.open.push_back(std::move(other));
    proof.open.push_back(std::move(box));
  }
  proof.open.insert(proof.open.begin(), stuck.begin(), stuck.end());
  return proof;
}

double distanceBound(const ProofScene& scene, const LinkPair& pair, const JointBox& box) {
  BoxBound bound(scene, pair);
  requireSize(box, bound.coordinates());
  return bounded(box) && bound.hasBound() ? bound.lowerBound(box) : -kInfinity;
}

PairProof merge(PairProof one, PairProof other) {
  PairProof both;
  constexpr long kMost = std::numeric_limits<long>::max();
  both.boxes = one.boxes > kMost - other.boxes ? kMost : one.boxes + other.boxes;
  if (one.collision && other.collision)
    both.collision = before(*one.collision, *other.collision) ? one.collision : other.collision;
  else
    both.collision = one.collision ? one.collision : other.collision;
  if (both.collision) return both;
  both.open = std::move(one.open);
  both.open.insert(both.open.end(), other.open.begin(), other.open.end());
  std::sort(both.open.begin(), both.open.end(), boxBefore);
  return both;
}

}  // namespace fcl_stpbv
