// Forward kinematics in the order of the tree: computes the pose of each link from its parent's, joint by
// joint (exponential map for floating joints), and the twist of each coordinate in world axes. The transform
// of a rotating joint is a sum of three constant matrices, with the factors 1, cos and sin of its angle. It
// is multiplied by the parent's pose, with one column per vector register.
#include "fcl_stpbv/robot/kinematics.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/robot/joint_freedoms.h"
#include "fcl_stpbv/robot/link_check.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

using detail::at;
using detail::crossMatrix;
using detail::freedoms;
using detail::kPi;
using detail::planeAcross;

// Rotation by a rotation vector, and the matrix that turns its rate into the angular velocity.
void exponential(const Vector3d& w, Matrix3d& rotation, Matrix3d& rate) {
  const double angle2 = w.squaredNorm(), angle = std::sqrt(angle2);
  double a, b, c;      // sin/angle, (1 - cos)/angle^2, (angle - sin)/angle^3
  if (angle < 1e-2) {  // the series' next terms are below 1e-15
    a = 1 - angle2 / 6 * (1 - angle2 / 20 * (1 - angle2 / 42));
    b = 0.5 - angle2 / 24 * (1 - angle2 / 30 * (1 - angle2 / 56));
    c = 1.0 / 6 - angle2 / 120 * (1 - angle2 / 42 * (1 - angle2 / 72));
  } else {
    a = std::sin(angle) / angle;
    b = (1 - std::cos(angle)) / angle2;
    c = (1 - a) / angle2;
  }
  const Matrix3d k = crossMatrix(w), k2 = k * k;
  rotation = Matrix3d::Identity() + a * k + b * k2;
  rate = Matrix3d::Identity() + b * k + c * k2;
}

Isometry3d pose(const Matrix3d& rotation, const Vector3d& position) {
  Isometry3d t;
  t.linear() = rotation;
  t.translation() = position;
  t.makeAffine();
  return t;
}

/// The three columns of a rotation and the column of an origin. The fourth numbers are 0, and 1 for the
/// origin.
struct Frame {
  detail::Packed column[4];
};

Frame frameOf(const Isometry3d& pose) {
  using detail::column;
  return {{column(pose, 0), column(pose, 1), column(pose, 2), column(pose, 3)}};
}

/// Writes the frame `local`, given relative to `parent`, as a pose.
inline void compose(const Frame& parent, const Frame& local, Isometry3d& pose) {
  using detail::Packed;
  const Packed* p = parent.column;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const Packed& l = local.column[i];
    Packed c = l[0] * p[0] + l[1] * p[1] + l[2] * p[2];
    if (i == 3) c += p[3];
    std::memcpy(pose.matrix().col(i).data(), &c, sizeof c);
  }
}

Twist turning(const Vector3d& axis, const Vector3d& origin) { return {origin.cross(axis), axis}; }
Twist sliding(const Vector3d& axis) { return {axis, Vector3d::Zero()}; }

// Files and results refer to coordinates by name, so the names must be distinct.
void requireDistinct(const std::vector<std::string>& names, const std::string& path) {
  std::set<std::string> known;
  for (const std::string& name : names)
    if (!known.insert(name).second)
      throw Error(path + ": two coordinates are named '" + name +
                  "'; rename the joint (those of planar and floating joints and of a moving base have names "
                  "such as joint/x and base/x)");
}

}  // namespace

Kinematics::Kinematics(std::shared_ptr<const RobotModel> robot, BaseMotion base)
    : robot_(std::move(robot)), coordinateOf_(robot_->joints.size(), -1), stepOf_(robot_->links.size(), -1) {
  if (base != BaseMotion::fixed) {
    JointModel root;
    root.type = base == BaseMotion::planar ? JointType::planar : JointType::floating;
    root.child = 0;
    root.axis = Vector3d::UnitZ();
    addCoordinates("base", root.type, -detail::kInfinity, detail::kInfinity);
    addStep(-1, root, 0, 1, 0);
  }
  for (std::size_t j = 0; j < robot_->joints.size(); ++j) {
    const JointModel& joint = robot_->joints[j];
    if (joint.mimic || joint.type == JointType::fixed) continue;
    coordinateOf_[j] = size();
    addCoordinates(joint.name, joint.type, joint.lower, joint.upper);
  }
  requireDistinct(names_, robot_->path);
  for (const LinkModel& link : robot_->links) {  // parents first
    if (link.parentJoint < 0) continue;
    const JointModel& joint = robot_->joints[at(link.parentJoint)];
    if (joint.mimic)
      addStep(link.parentJoint, joint, coordinateOf_[at(joint.mimic->joint)], joint.mimic->multiplier,
              joint.mimic->offset);
    else
      addStep(link.parentJoint, joint, coordinateOf_[at(link.parentJoint)], 1, 0);
  }
  neutral_ = Eigen::VectorXd::Zero(size()).cwiseMax(lower_).cwiseMin(upper_);
}

void Kinematics::addCoordinates(const std::string& name, JointType type, double lower, double upper) {
  const double infinity = detail::kInfinity;
  const auto add = [&](const std::string& suffix, double low, double high) {
    names_.push_back(name + suffix);
    lower_.conservativeResize(size());
    upper_.conservativeResize(size());
    lower_[size() - 1] = low;
    upper_[size() - 1] = high;
  };
  if (type == JointType::planar) {
    for (const char* suffix : {"/x", "/y"}) add(suffix, -infinity, infinity);
    add("/angle", -kPi, kPi);
  } else if (type == JointType::floating) {
    for (const char* suffix : {"/x", "/y", "/z"}) add(suffix, -infinity, infinity);
    for (const char* suffix : {"/rx", "/ry", "/rz"}) add(suffix, -kPi, kPi);
  } else {
    add("", lower, upper);
  }
}

void Kinematics::addStep(int joint, const JointModel& model, int coordinate, double multiplier,
                         double offset) {
  Step step{model.type,   model.parent, model.child,          -1, coordinate, multiplier, offset,
            model.origin, model.axis,   Matrix3d::Identity(), {}, {},         {}};
  if (model.type == JointType::planar) step.plane = planeAcross(model.axis);
  // Rodrigues: v turns to a (a.v) + cos (v - a (a.v)) + sin (a cross v).
  const Matrix3d on = model.axis * model.axis.transpose(),
                 turn[3] = {on, Matrix3d::Identity() - on, crossMatrix(model.axis)};
  Eigen::Matrix<double, 4, 3, Eigen::DontAlign>* part[3] = {&step.along, &step.even, &step.odd};
  for (int k = 0; k < 3; ++k) *part[k] << model.origin.linear() * turn[k], 0, 0, 0;
  if (freedoms(model.type) > 0) step.motion = static_cast<int>(motions_.size());
  for (int k = 0; k < freedoms(model.type); ++k) motions_.push_back({joint, coordinate + k, multiplier});
  stepOf_[at(model.child)] = static_cast<int>(steps_.size());
  whole_.steps_.push_back(static_cast<int>(steps_.size()));
  steps_.push_back(step);
}

int Kinematics::coordinate(const std::string& joint) const {
  const int j = robot_->joint(joint);
  return j < 0 ? -1 : coordinateOf_[at(j)];
}

Kinematics::State Kinematics::makeState() const {
  return {std::vector<Isometry3d>(robot_->links.size(), Isometry3d::Identity()),
          std::vector<Twist>(motions_.size())};
}

Kinematics::Subtree Kinematics::subtree(const std::vector<int>& links) const {
  std::vector<char> isOn(steps_.size());
  for (int link : links) {
    detail::requireLink("Kinematics", link, *robot_);
    for (int s; link >= 0 && (s = stepOf_[at(link)]) >= 0 && !isOn[at(s)]; link = steps_[at(s)].parent)
      isOn[at(s)] = 1;
  }
  Subtree part;
  for (const int s : whole_.steps_)
    if (isOn[at(s)]) part.steps_.push_back(s);
  return part;
}

FCL_STPBV_VECTORIZED
void Kinematics::forward(const Eigen::Ref<const Eigen::VectorXd>& q, State& state,
                         const Subtree& only) const {
  if (stepOf_[0] < 0) state.link[0].setIdentity();
  for (const int s : only.steps_) place<true>(steps_[at(s)], q, state);
}

FCL_STPBV_VECTORIZED
void Kinematics::forwardPoses(const Eigen::Ref<const Eigen::VectorXd>& q, State& state,
                              const Subtree& only) const {
  if (stepOf_[0] < 0) state.link[0].setIdentity();
  for (const int s : only.steps_) place<false>(steps_[at(s)], q, state);
}

template <bool withMotions>
void Kinematics::place(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const {
  const Frame parent = frameOf(step.parent < 0 ? Isometry3d::Identity() : state.link[at(step.parent)]);
  Isometry3d& link = state.link[at(step.child)];
  Twist* twist = withMotions && step.motion >= 0 ? &state.motion[at(step.motion)] : nullptr;
  if (step.type == JointType::fixed) {
    compose(parent, frameOf(step.origin), link);
  } else if (step.type == JointType::planar || step.type == JointType::floating) {
    placeFree(step, q, state, twist);
  } else if (step.type == JointType::prismatic) {
    compose(parent, frameOf(step.origin), link);
    const Vector3d axis = link.linear() * step.axis;
    link.translation() += step.value(q) * axis;
    if (twist) *twist = sliding(step.multiplier * axis);
  } else {
    const double angle = step.value(q), sine = std::sin(angle), cosine = std::cos(angle);
    Frame local{{{}, {}, {}, detail::column(step.origin, 3)}};
    for (Eigen::Index i = 0; i < 3; ++i) {
      detail::Packed part[3];
      std::memcpy(&part[0], step.along.col(i).data(), sizeof part[0]);
      std::memcpy(&part[1], step.even.col(i).data(), sizeof part[1]);
      std::memcpy(&part[2], step.odd.col(i).data(), sizeof part[2]);
      local.column[i] = part[0] + cosine * part[1] + sine * part[2];
    }
    compose(parent, local, link);
    if (twist) *twist = turning(step.multiplier * (link.linear() * step.axis), link.translation());
  }
}

// Places a joint with several coordinates. Such joints are never mimic joints.
void Kinematics::placeFree(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q, State& state,
                           Twist* twist) const {
  const Isometry3d frame = step.parent < 0 ? step.origin : state.link[at(step.parent)] * step.origin;
  Isometry3d& link = state.link[at(step.child)];
  if (step.type == JointType::planar) {
    const Matrix3d plane = frame.linear() * step.plane;
    const Vector3d position = frame.translation() + plane.leftCols<2>() * q.segment<2>(step.coordinate);
    const Eigen::AngleAxisd turn(q[step.coordinate + 2], step.axis);
    link = pose(frame.linear() * turn.toRotationMatrix(), position);
    if (!twist) return;
    twist[0] = sliding(plane.col(0));
    twist[1] = sliding(plane.col(1));
    twist[2] = turning(frame.linear() * step.axis, position);
  } else {
    Matrix3d rotation, rate;
    exponential(q.segment<3>(step.coordinate + 3), rotation, rate);
    const Vector3d position = frame * Vector3d(q.segment<3>(step.coordinate));
    link = pose(frame.linear() * rotation, position);
    if (!twist) return;
    rate = frame.linear() * rate;
    for (int k = 0; k < 3; ++k) {
      twist[k] = sliding(frame.linear().col(k));
      twist[3 + k] = turning(rate.col(k), position);
    }
  }
}

std::vector<Kinematics::Dependence> Kinematics::dependence(int link) const {
  detail::requireLink("Kinematics", link, *robot_);
  std::vector<Dependence> list;
  for (int l = link; l >= 0;) {
    const int s = stepOf_[at(l)];
    if (s < 0) break;
    const Step& step = steps_[at(s)];
    for (int k = 0; k < freedoms(step.type); ++k) list.push_back({step.motion + k, 1.0});
    l = step.parent;
  }
  std::sort(list.begin(), list.end(),
            [](const Dependence& a, const Dependence& b) { return a.motion < b.motion; });
  return list;
}

std::vector<Kinematics::Dependence> Kinematics::dependence(int link1, int link2) const {
  const std::vector<Dependence> first = dependence(link1), second = dependence(link2);
  std::vector<Dependence> list;
  std::size_t i = 0, j = 0;
  while (i < first.size() || j < second.size()) {
    const int a = i < first.size() ? first[i].motion : std::numeric_limits<int>::max();
    const int b = j < second.size() ? second[j].motion : std::numeric_limits<int>::max();
    if (a < b) list.push_back({a, -1.0});
    if (b < a) list.push_back({b, 1.0});
    i += a <= b;
    j += b <= a;
  }
  return list;
}

}  // namespace fcl_stpbv
