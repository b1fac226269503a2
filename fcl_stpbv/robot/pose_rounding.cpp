// For each body: walks from the root out to its link and adds up the roundings of every length on the way.
#include "fcl_stpbv/robot/pose_rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {
namespace {

// In eps = 2^-52, twice the largest relative error of an operation. The norm of the error that a joint adds
// to the rotation of its child: 27, for the three constant matrices, sine and cosine, their sum, and the
// product with the parent's rotation (docs/robot.md, Rounding of the poses).
constexpr double kTurn = 32;
// Per metre of a length: 4 for the product that turns it, 5 for the body's own pose, and the rest for the
// differences of the check itself.
constexpr double kLength = 16;

// Roundings (in eps) of each metre of a length that `above` joints turn and that is part of the position of
// `below` more links, each of which rounds the sum.
double weightOf(std::size_t above, std::size_t below) {
  return kTurn * static_cast<double>(above) + static_cast<double>(below) + kLength;
}

}  // namespace

PoseRounding::PoseRounding(const Kinematics& kinematics, const std::vector<BodyReach>& bodies) {
  const RobotModel& robot = kinematics.robot();
  const std::size_t joints = robot.joints.size(), base = kinematics.baseMoves() ? 1 : 0;
  // For each joint, the base's last: the weight of the way that it slides, and the largest distance from it.
  std::vector<double> slide(joints + 1, 0), beyond(joints + 1, -1);
  std::size_t deepest = 0;
  double farthest = 0;
  bool isBounded = true;
  for (const bool bounded : {true, false})
    for (const BodyReach& body : bodies) {
      if (std::isfinite(body.length) != bounded) continue;
      isBounded = isBounded && bounded;
      const std::vector<int> up = body.link < 0 ? std::vector<int>{} : jointPath(robot, body.link, 0).joints;
      const auto originOf = [&](int joint) { return robot.joints[at(joint)].origin.translation().norm(); };
      // An unbounded body matters where other bodies are.
      double length = bounded ? body.length : farthest;
      for (const int joint : up) length += bounded ? 0 : originOf(joint);
      const std::size_t above = body.link < 0 ? 0 : base + up.size();
      double sum = weightOf(above, 0) * length;
      for (std::size_t k = 0; k < up.size(); ++k) {  // from the link to the root
        const std::size_t j = at(up[k]), outer = above - k;
        beyond[j] = std::max(beyond[j], length);
        slide[j] = std::max(slide[j], weightOf(outer, k + 1));
        sum += weightOf(outer - 1, k + 1) * originOf(up[k]);
        length += originOf(up[k]);
      }
      if (body.link >= 0 && base > 0) {
        beyond[joints] = std::max(beyond[joints], length);
        slide[joints] = std::max(slide[joints], weightOf(0, above));
      }
      still_ = std::max(still_, sum);
      deepest = std::max(deepest, above);
      if (bounded) farthest = std::max(farthest, length);
    }
  if (!isBounded)
    for (double& weight : slide) weight += kTurn * static_cast<double>(deepest);
  addValues(kinematics, slide, beyond);
}

void PoseRounding::addValues(const Kinematics& kinematics, const std::vector<double>& slide,
                             const std::vector<double>& beyond) {
  const std::vector<Kinematics::Motion>& motions = kinematics.motions();
  const std::vector<JointModel>& joints = kinematics.robot().joints;
  for (std::size_t first = 0, end; first < motions.size(); first = end) {
    const int joint = motions[first].joint;
    for (end = first; end < motions.size() && motions[end].joint == joint;) ++end;
    const std::size_t j = joint < 0 ? joints.size() : at(joint), freedoms = end - first;
    if (beyond[j] < 0) continue;  // it moves none of the bodies
    const bool slides = joint >= 0 && joints[j].type == JointType::prismatic;
    const bool isMimic = joint >= 0 && joints[j].mimic;
    const std::size_t sliding = freedoms == 6 ? 3 : freedoms == 3 ? 2 : slides ? 1 : 0;
    for (std::size_t m = first; m < end; ++m) {
      Value value{motions[m].coordinate, std::abs(motions[m].multiplier),
                  isMimic ? std::abs(joints[j].mimic->offset) : 0, beyond[j]};
      if (m < first + sliding)
        value.weight = slide[j], slides_.push_back(value);
      else if (isMimic || freedoms == 6)  // the angle of a rotation vector is the vector's length
        turns_.push_back(value);
    }
  }
}

double PoseRounding::most(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  const auto sizeOf = [&](const Value& value) {
    return value.multiplier * std::abs(q[value.coordinate]) + value.offset;
  };
  double sum = still_, way = 0;
  for (const Value& slide : slides_) {
    const double size = sizeOf(slide);
    sum += slide.weight * size;
    way += size;
  }
  for (const Value& turn : turns_) sum += sizeOf(turn) * (turn.weight + way);
  return std::numeric_limits<double>::epsilon() * sum;
}

}  // namespace fcl_stpbv::detail
