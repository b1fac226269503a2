// Static stability: the centre of mass, seen from above, is a convex combination of contact points.
// 1. Hull of each contact (convex_polygon.h).
// 2. Clip it by its edges moved inward by the margin (Sutherland and Hodgman 1974).
// 3. Rows: centre of mass = sum of weights times points; derivatives by the mass below each joint.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/convex_polygon.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector2d;
using Eigen::Vector3d;

// A convex polygon, counter-clockwise, without what is nearer than `margin` to its edges.
std::vector<Vector2d> inner(const std::vector<Vector2d>& corners, double margin) {
  std::vector<Vector2d> kept = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d along = (corners[(i + 1) % corners.size()] - a).normalized();
    const auto depth = [&](const Vector2d& p) { return cross(along, p - a) - margin; };
    std::vector<Vector2d> cut;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const Vector2d &p = kept[k], &q = kept[(k + 1) % kept.size()];
      const double dp = depth(p), dq = depth(q);
      if (dp >= 0) cut.push_back(p);
      if ((dp < 0) != (dq < 0)) cut.push_back(p + dp / (dp - dq) * (q - p));
    }
    kept = std::move(cut);
  }
  return kept;
}

}  // namespace

CentreOfMass::CentreOfMass(const Kinematics& kinematics) {
  const RobotModel& robot = kinematics.robot();
  for (const LinkModel& link : robot.links) {
    const int parent = link.parentJoint < 0 ? -1 : robot.joints[at(link.parentJoint)].parent;
    links_.push_back({parent, link.mass, link.centreOfMass});
    mass_ += link.mass;
  }
  if (!(mass_ > 0)) throw Error(robot.path + ": no link has a mass; give the links <inertial> elements");
  for (const Kinematics::Motion& motion : kinematics.motions())
    motions_.push_back({motion.joint < 0 ? 0 : robot.joints[at(motion.joint)].child, motion.coordinate});
  below_.resize(links_.size());
  momentBelow_.resize(links_.size());
}

Vector3d CentreOfMass::evaluate(const Kinematics::State& state, Eigen::Ref<Eigen::Matrix3Xd> jacobian) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    below_[i] = links_[i].mass;
    momentBelow_[i] = links_[i].mass * (state.link[i] * links_[i].centre);
  }
  for (std::size_t i = links_.size(); i-- > 1;) {  // parents come before their children
    below_[at(links_[i].parent)] += below_[i];
    momentBelow_[at(links_[i].parent)] += momentBelow_[i];
  }
  jacobian.setZero();
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    const Twist& twist = state.motion[m];
    const std::size_t link = at(motions_[m].link);
    jacobian.col(motions_[m].coordinate) +=
        (below_[link] * twist.linear + twist.angular.cross(momentBelow_[link])) / mass_;
  }
  return momentBelow_[0] / mass_;
}

std::vector<Vector3d> shrunk(const std::vector<Vector3d>& points, double margin) {
  if (!(margin > 0)) return points;
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : points) centre += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  const Vector3d u = axes.col(2), v = axes.col(1);  // the patch's plane
  std::vector<Vector2d> flat;
  flat.reserve(points.size());
  for (const Vector3d& p : points) flat.emplace_back(u.dot(p - centre), v.dot(p - centre));
  std::vector<Vector3d> corners;
  if (points.size() >= 3)
    for (const Vector2d& p : inner(convexPolygon(flat), margin))
      corners.push_back(centre + p.x() * u + p.y() * v);
  if (corners.empty()) throw Error("a contact is narrower than twice the margin; give a smaller margin");
  return corners;
}

StaticStability::StaticStability(const Kinematics& kinematics, std::vector<Contact> contacts, double margin,
                                 int firstWeight)
    : kinematics_(kinematics),
      centre_(kinematics),
      contacts_(std::move(contacts)),
      firstWeight_(firstWeight),
      centreJacobian_(3, kinematics.size()) {
  for (Contact& contact : contacts_) {
    contact.points = shrunk(contact.points, margin);
    weights_ += static_cast<int>(contact.points.size());
    carriers_.push_back(kinematics.dependence(contact.link));
  }
  if (weights_ == 0) throw Error("there are no contacts; give some points of some links");
}

std::string StaticStability::name(int row) const {
  static const char* const kNames[] = {"stability x", "stability y", "stability weights"};
  return kNames[row];
}

void StaticStability::evaluate(const Point& point, Eigen::Ref<Eigen::VectorXd> values,
                               Eigen::Ref<RowMatrix> jacobian) {
  const Vector3d centre = centre_.evaluate(point.state, centreJacobian_);
  jacobian.topLeftCorner(2, kinematics_.size()) = centreJacobian_.topRows<2>();
  values << centre.x(), centre.y(), -1;
  int weight = firstWeight_;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    double sum = 0;
    Vector3d moment = Vector3d::Zero();
    for (const Vector3d& local : contacts_[c].points) {
      const Vector3d p = point.state.link[at(contacts_[c].link)] * local;
      sum += point.x[weight];
      moment += point.x[weight] * p;
      jacobian(0, weight) = -p.x();
      jacobian(1, weight) = -p.y();
      jacobian(2, weight) = 1;
      ++weight;
    }
    values[0] -= moment.x();
    values[1] -= moment.y();
    values[2] += sum;
    for (const Kinematics::Dependence& d : carriers_[c]) {
      const Twist& twist = point.state.motion[at(d.motion)];
      const Vector3d rate = sum * twist.linear + twist.angular.cross(moment);
      jacobian.col(kinematics_.motions()[at(d.motion)].coordinate).head<2>() -= rate.head<2>();
    }
  }
}

}  // namespace fcl_stpbv
