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

class Prover {
 public:
  enum class Verdict { clear, collision, unclear };

  Prover(const ProofScene& scene, const LinkPair& pair)
      : scene_(scene), pair_(pair), search_(searchOf(scene, pair)), q_(scene.kinematics->neutral()) {
    const RobotModel& robot = scene.kinematics->robot();
    const JointPath path = jointPath(robot, pair.link1, pair.obstacle ? 0 : pair.link2);
    for (std::size_t i = 0; i < path.joints.size(); ++i) {
      const JointModel& joint = robot.joints[at(path.joints[i])];
      if (joint.type == JointType::fixed || (joint.mimic && joint.mimic->multiplier == 0)) continue;
      BoxJoint box;
      box.slides = joint.type == JointType::prismatic;
      box.up = i < path.up;
      if (joint.mimic) box.rate = joint.mimic->multiplier;
      const std::string& owner = joint.mimic ? robot.joints[at(joint.mimic->joint)].name : joint.name;
      const std::vector<int>& coordinates = search_.coordinates();
      box.slot = static_cast<int>(
          std::find(coordinates.begin(), coordinates.end(), scene.kinematics->coordinate(owner)) -
          coordinates.begin());
      joints_.push_back(box);
      models_.push_back(&joint);
    }
    lipschitz_ = Eigen::Map<const Eigen::VectorXd>(search_.lipschitz().data(),
                                                   static_cast<Index>(search_.lipschitz().size()));
  }

  Index coordinates() const { return static_cast<Index>(search_.coordinates().size()); }
  /// Whether the pair has a bound: none across planar and floating joints or a moving base.
  bool hasBound() const { return lipschitz_.allFinite(); }
  const Eigen::VectorXd& middle() const { return q_; }
  int widest() const { return widest_; }

  Verdict look(const JointBox& box) {
    ask(box);
    if (!(distance_ > kNotKnown)) return Verdict::unclear;
    if (distance_ <= scene_.margin) return Verdict::collision;
    return bound(scene_.margin) > scene_.margin ? Verdict::clear : Verdict::unclear;
  }

  double lowerBound(const JointBox& box) {
    ask(box);
    return bound(kInfinity);
  }

 private:
  // Computes the distances at the box's middle.
  void ask(const JointBox& box) {
    const Eigen::VectorXd middle = middleOf(box);
    // Rounded up, because the differences are off by half a unit in the last place of the limits.
    half_ = (box.upper - middle).cwiseMax(middle - box.lower) * (1 + 4 * kEps);
    for (Index k = 0; k < middle.size(); ++k)
      q_[search_.coordinates()[static_cast<std::size_t>(k)]] = middle[k];
    search_.forget();
    distance_ = search_.distance(q_);
    place();
    leversHold_ = std::all_of(joints_.begin(), joints_.end(), [&](const BoxJoint& joint) {
      const int k = search_.coordinates()[at(joint.slot)];
      return !joint.slides || (box.lower[joint.slot] >= scene_.kinematics->lower()[k] &&
                               box.upper[joint.slot] <= scene_.kinematics->upper()[k]);
    });
  }

  // Lower bound on the distance in the whole box: the cheap bound, or the bound of planes if the cheap one is
  // not above `enough`. Stops at the first pair of bodies for which no bound is above `enough`. Then widest_
  // is the coordinate to cut.
  double bound(double enough) {
    const CollisionConstraints& rows = search_.constraints();
    const Eigen::VectorXd share = lipschitz_.cwiseProduct(half_);
    const double cheap = leversHold_ ? share.sum() : kInfinity;
    double lowest = kInfinity;
    for (int row = 0; row < rows.rows(); ++row) {
      const DistanceAnswer answer = rows.answer(row);
      double found = answer.lower - cheap - slack_;
      share_ = share;
      if (found <= enough)
        found = std::max(found, planeBound(rows.pairs()[at(row)], answer, enough + slack_) - slack_);
      lowest = std::min(lowest, found);
      if (found > enough || enough == kInfinity) continue;
      if (share_.size() > 0) share_.maxCoeff(&widest_);
      break;
    }
    return lowest;
  }

  // Axes, origins and ranges of the joints in the middle of the box, and what rounding may have made of a
  // bound: each of some `steps` products and sums behind a coordinate, from the root along the links and
  // through the bound's own sums, is off by a few units in the last place of the longest length. The angle of
  // a joint that mimics another one is rounded itself, and its joint may turn by up to 1e6 rad.
  void place() {
    double length = 0, angles = 0;
    const Kinematics::State& state = search_.constraints().state();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const Eigen::Isometry3d& child = state.link[at(models_[i]->child)];
      joints_[i].axis = child.linear() * models_[i]->axis;
      joints_[i].origin = child.translation();
      joints_[i].half = half_[joints_[i].slot] * std::abs(joints_[i].rate) * (1 + kEps);
      length = std::max(length, joints_[i].origin.norm() + (joints_[i].slides ? joints_[i].half : 0));
      if (!models_[i]->mimic || joints_[i].slides) continue;
      const double middle = q_[search_.coordinates()[at(joints_[i].slot)]];
      angles += std::abs(joints_[i].rate * middle) + joints_[i].half + std::abs(models_[i]->mimic->offset);
    }
    const auto reach = [&](const Vector3d& centre, double radius) {
      length = std::max(length, centre.norm() + radius);
    };
    for (const CheckedPair& pair : search_.constraints().pairs()) {
      for (const int b : {pair.body, pair.obstacle ? pair.body : pair.other}) {
        const Body& body = scene_.geometry->bodies[at(b)];
        reach(state.link[at(body.link)] * body.centre, body.radius);
      }
      if (!pair_.obstacle) continue;
      const Obstacle& obstacle = scene_.obstacles[at(pair_.link2)];
      reach(obstacle.centre(), obstacle.radius());
    }
    const double m = static_cast<double>(joints_.size());
    const double steps =
        static_cast<double>(scene_.kinematics->robot().joints.size()) + m * m * m + 16 + angles;
    slack_ = 16 * kEps * steps * length;
  }

  double planeBound(const CheckedPair& pair, const DistanceAnswer& answer, double enough) {
    const std::optional<BodyPoints>& first = scene_.bodies->robot[at(pair.body)];
    const std::optional<BodyPoints>& second =
        pair.obstacle ? scene_.bodies->obstacles[at(pair_.link2)] : scene_.bodies->robot[at(pair.other)];
    if (!first || !second) return -kInfinity;
    const double least = -mostDepth(*first, *second);
    if (least > enough || answer.normal.isZero()) return least;
    const Kinematics::State& state = search_.constraints().state();
    move(*first, state.link[at(pair_.link1)], first_);
    move(*second, pair.obstacle ? Eigen::Isometry3d::Identity() : state.link[at(pair_.link2)], second_);
    bound_.set(joints_, first_, second_);
    taken_.resize(half_.size());
    taken_.setZero();
    const double found = bound_.gap(answer.normal, answer.points, enough, taken_);
    if (taken_.size() > 0 && taken_.maxCoeff() > 0) share_ = taken_;
    return std::max(found, least);
  }

  static void move(const BodyPoints& body, const Eigen::Isometry3d& pose, BodyPoints& moved) {
    moved.points.resize(body.points.size());
    for (std::size_t i = 0; i < body.points.size(); ++i) moved.points[i] = pose * body.points[i];
    moved.centre = pose * body.centre;
    moved.radius = body.radius;
    moved.reach = body.reach;
  }

  const ProofScene& scene_;
  LinkPair pair_;
  PairSearch search_;
  Eigen::VectorXd q_, lipschitz_;
  // Of the box: the half widths, and how much each coordinate reduces the gap.
  Eigen::VectorXd half_, share_, taken_;
  std::vector<BoxJoint> joints_;
  std::vector<const JointModel*> models_;
  PlaneBound bound_;
  BodyPoints first_, second_;
  double distance_ = 0, slack_ = 0;
  bool leversHold_ = true;  // whether the levers' bounds hold: only if joints that slide keep to their limits
  int widest_ = 0;
};

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
  while (!proof.open.empty() && proof.boxes < maxBoxes) {
    JointBox box = std::move(proof.open.back());
    proof.open.pop_back();
    ++proof.boxes;
    const BoxBound::Verdict verdict = bound.look(box);
    if (verdict == BoxBound::Verdict::clear) continue;
    if (box.lower.size() == 0 &&
        verdict == BoxBound::Verdict::unclear) {  // nothing to cut: the pair is rigid
      proof.open.push_back(std::move(box));
      break;
    }
    if (verdict == BoxBound::Verdict::collision) {
      proof.collision = bound.middle();
      proof.open.clear();
      break;
    }
    JointBox other = box;
    const int k = bound.widest();
    box.upper[k] = other.lower[k] = middleOf(box)[k];
    proof.open.push_back(std::move(other));
    proof.open.push_back(std::move(box));
  }
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
