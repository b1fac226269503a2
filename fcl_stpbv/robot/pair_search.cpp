// The distance of one pair of links as a function of the joints between them. Descents and climbs follow the
// gradient within the limits, with a step that doubles after a gain and halves otherwise (Armijo). The
// Lipschitz constants come from the joints' levers.
#include "fcl_stpbv/robot/pair_search.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_freedoms.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {
namespace {

// The constraints of a pair have at most its own obstacle, so that a scene of many costs no more.
ConstraintOptions optionsOf(const LinkPair& pair, const std::vector<Obstacle>& obstacles) {
  ConstraintOptions options;
  if (pair.obstacle) options.obstacles = {obstacles.at(at(pair.link2))};
  return options;
}

// Which bodies the pair has depends on the obstacle's index in the scene; among its constraints it is 0.
std::vector<CheckedPair> ownBodiesOf(const RobotGeometry& geometry, const LinkPair& pair) {
  std::vector<CheckedPair> bodies = bodiesOf(geometry, pair);
  if (pair.obstacle)
    for (CheckedPair& both : bodies) both.other = 0;
  return bodies;
}

}  // namespace

PairSearch::PairSearch(std::shared_ptr<const Kinematics> kinematics,
                       std::shared_ptr<const RobotGeometry> geometry, const LinkPair& pair,
                       const std::vector<Obstacle>& obstacles)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      constraints_(kinematics_, geometry_, ownBodiesOf(*geometry_, pair), optionsOf(pair, obstacles)),
      d_(constraints_.rows()),
      values_(constraints_.nonZeros()),
      gradient_(kinematics_->size()),
      room_(searchRoom(*kinematics_, *geometry_, optionsOf(pair, obstacles).obstacles)) {
  const std::vector<int>& rows = constraints_.rowStart();  // all rows have the same columns
  coordinates_.assign(constraints_.columnIndices().begin(), constraints_.columnIndices().begin() + rows[1]);
  const double reach = reachOf(*geometry_, pair.link1);
  if (pair.obstacle)
    boundSlopes(pair.link1, reach, 0, reachOf(obstacles[at(pair.link2)]));
  else
    boundSlopes(pair.link1, reach, pair.link2, reachOf(*geometry_, pair.link2));
}

// A turning joint moves a body's point by at most its distance from the axis. The moment of the normal's line
// about the axis is the same at both witness points, so the link with the smaller distance can be used. That
// distance is at most the way along the links plus the body's reach. An obstacle is fixed to the root link.
void PairSearch::boundSlopes(int link1, double reach1, int link2, double reach2) {
  const RobotModel& robot = kinematics_->robot();
  const JointPath joints = jointPath(robot, link1, link2);
  struct Span {
    int joint;
    double length;
  };
  std::vector<Span> path;  // from link1 up, then down to link2
  for (int j : joints.joints) path.push_back({j, lengthOf(robot, j)});
  double total = 0;
  for (const Span& part : path) total += part.length;

  lipschitz_.assign(coordinates_.size(), 0);
  for (const Kinematics::Motion& motion : kinematics_->motions())  // a moving base has no limits
    for (std::size_t k = 0; k < coordinates_.size(); ++k)
      if (motion.joint < 0 && motion.coordinate == coordinates_[k]) lipschitz_[k] = kInfinity;
  double before = 0;  // length of the way from link1 to this joint
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool on1 = i < joints.up;  // the joint's child is then on the side of link1
    const JointModel& joint = robot.joints[at(path[i].joint)];
    const double to1 = before + (on1 ? 0 : path[i].length) + reach1;
    const double to2 = total - before - (on1 ? 0 : path[i].length) + reach2;
    before += path[i].length;
    if (joint.type == JointType::fixed) continue;
    double slope = kInfinity;
    if (joint.type == JointType::prismatic) slope = 1;
    if (joint.type == JointType::revolute || joint.type == JointType::continuous) slope = std::min(to1, to2);
    int coordinate = kinematics_->coordinate(joint.name);
    if (joint.mimic) {
      slope *= std::abs(joint.mimic->multiplier);
      coordinate = kinematics_->coordinate(robot.joints[at(joint.mimic->joint)].name);
    }
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      if (coordinates_[k] >= coordinate && coordinates_[k] < coordinate + freedoms(joint.type))
        lipschitz_[k] += slope;
    }
  }
}

double PairSearch::distance(const Eigen::VectorXd& q) {
  constraints_.evaluate(q, d_);
  return d_.minCoeff();
}

double PairSearch::distanceAndGradient(const Eigen::VectorXd& q) {
  constraints_.evaluateValues(q, d_, values_);
  Eigen::Index row;
  const double least = d_.minCoeff(&row);
  gradient_.setZero();
  const int start = constraints_.rowStart()[static_cast<std::size_t>(row)];
  for (std::size_t k = 0; k < coordinates_.size(); ++k)
    gradient_[coordinates_[k]] = values_[start + static_cast<int>(k)];
  return least;
}

// Projected steps along the gradient; `sign` is -1 for downhill and 1 for uphill. Each coordinate has its own
// unit (SearchRoom), so that steps fit the robot's size.
template <class Arrived>
double PairSearch::follow(Eigen::VectorXd& q, double sign, Arrived arrived) {
  constexpr int kSteps = 200;
  const double enough = 1e-6 * room_.scale;  // m; the search has arrived when a step gains less
  double step = 0.1, d = distanceAndGradient(q);
  for (int i = 0; i < kSteps && !arrived(d); ++i) {
    const Eigen::VectorXd slope = sign * gradient_.cwiseProduct(room_.unit);
    if (!(slope.norm() > 1e-12 * room_.scale)) break;
    bool better = false;
    for (int half = 0; half < 30 && !better; ++half) {
      const Eigen::VectorXd next = (q + step / slope.norm() * slope.cwiseProduct(room_.unit))
                                       .cwiseMax(kinematics_->lower())
                                       .cwiseMin(kinematics_->upper());
      const double there = distanceAndGradient(next);
      const double promised = slope.dot((next - q).cwiseQuotient(room_.unit));
      if (promised <= 0) return d;  // the limits stop every coordinate
      const double gain = sign * (there - d);
      if (gain > 1e-4 * promised) {
        better = true;
        q = next;
        d = there;
        step = std::min(1.0, step * 2);
        if (gain < enough) return d;
      } else {
        step /= 2;
      }
    }
    if (!better) break;
  }
  return d;
}

double PairSearch::descend(Eigen::VectorXd& q, double margin) {
  return follow(q, -1, [margin](double d) { return d <= margin; });
}

double PairSearch::climb(Eigen::VectorXd& q, double margin) {
  return follow(q, 1, [margin](double d) { return d > margin; });
}

}  // namespace fcl_stpbv::detail
