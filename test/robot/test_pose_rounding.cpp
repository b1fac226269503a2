// Verdicts at margins that the distance reaches, for robots whose poses are rounded far more than the two
// bodies' own places show. The truth is computed in long double from the URDF's numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "fcl_stpbv/robot/pose_rounding.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::VectorXd;

namespace {

using Real = long double;
const std::string kBall = "<sphere radius=\"0.1\"/>";

std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}
std::string origin(double x) { return "<origin xyz=\"" + number(x) + " 0 0\"/>"; }
std::string mimic(double multiplier, double offset = 0) {
  return "<mimic joint=\"s\" multiplier=\"" + number(multiplier) + "\" offset=\"" + number(offset) + "\"/>";
}
std::string ballAt(const std::string& name, double x) {
  return "<link name=\"" + name + "\"><collision>" + origin(x) + "<geometry>" + kBall +
         "</geometry></collision></link>";
}
const std::string kZ = "<axis xyz=\"0 0 1\"/>";

/// A robot of two balls of 0.1 m.
struct TwoBalls {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
  std::vector<CheckedPair> pairs{{0, 1, false}};
  CollisionChecker checker;
  MotionCheck motions;

  explicit TwoBalls(const std::string& body)
      : kinematics(std::make_shared<const Kinematics>(
            std::make_shared<const RobotModel>(parseUrdf(robot(body), "balls.urdf")))),
        geometry(std::make_shared<const RobotGeometry>(loadGeometry(kinematics->robot()))),
        checker(kinematics, geometry, pairs),
        motions(kinematics, geometry, pairs) {}

  /// How often a margin that is at least the distance of the centres less 0.2 m is called kept at q.
  int wrongAt(const VectorXd& q, Real apart) {
    const double ball = 0.1;
    const Real distance = apart - 2 * static_cast<Real>(ball);
    const double margin = std::nextafter(static_cast<double>(distance), 1e9);
    if (distance > margin) return 0;
    checker.setMargin(margin);
    return !checker.collides(q) + motions.isFree(q, margin) + motions.isMotionFree(q, q, margin);
  }
};

/// Both links have the same length, and the second is folded back onto the first.
std::string folded(double length) {
  return link("o", kBall) + link("a") + link("b") + link("c", kBall) +
         joint("j1", "revolute", "o", "a", kZ, 4) +
         joint("j2", "revolute", "a", "b", origin(length) + kZ, 4) +
         joint("j3", "fixed", "b", "c", origin(length));
}

/// A ball that turns at 0.5 m, by a joint that mimics another one.
std::string geared(double multiplier) {
  return ballAt("o", 0.8) + link("a") + ballAt("c", 0.5) + joint("s", "revolute", "o", "a", "", 4) +
         joint("j", "continuous", "o", "c", kZ + mimic(multiplier), 4);
}

/// A ball that slides by multiplier q + offset.
std::string racked(double multiplier, double offset) {
  return link("o", kBall) + link("a") + link("c", kBall) + joint("s", "revolute", "o", "a", "", 4) +
         joint("j", "prismatic", "o", "c", mimic(multiplier, offset), 4);
}

/// A ball that slides and turns at 0.5 m.
std::string turning() {
  return link("o", kBall) + link("a") + ballAt("c", 0.5) + joint("s", "prismatic", "o", "a", "", 4) +
         joint("j", "continuous", "a", "c", kZ, 4);
}

Real geared(double multiplier, double q) {
  const Real angle = static_cast<Real>(multiplier) * static_cast<Real>(q), half = 0.5L;
  const Real x = half * std::cos(angle) - static_cast<Real>(0.8), y = half * std::sin(angle);
  return std::sqrt(x * x + y * y);
}

using Matrix4L = Eigen::Matrix<Real, 4, 4>;
using Vector3L = Eigen::Matrix<Real, 3, 1>;

Matrix4L turned(const Vector3L& axis, Real angle) {
  Matrix4L pose = Matrix4L::Identity();
  pose.topLeftCorner<3, 3>() = Eigen::AngleAxis<Real>(angle, axis).toRotationMatrix();
  return pose;
}
Matrix4L moved(const Vector3L& way) {
  Matrix4L pose = Matrix4L::Identity();
  pose.topRightCorner<3, 1>() = way;
  return pose;
}

/// A chain of joints of all types, some of which mimic the first one.
std::string chain(int joints, Random& random) {
  const char* const types[] = {"revolute", "prismatic", "fixed", "floating", "planar"};
  std::string text = link("l0") + link("l1") + joint("s", "revolute", "l0", "l1", kZ, 4);
  for (int i = 1; i <= joints; ++i) {
    const int type = i % 7 == 0 ? 3 : i % 5 == 0 ? 4 : i % 3;
    const auto three = [&](double size) {
      std::string list;
      for (int k = 0; k < 3; ++k) list += number(random.uniform(-size, size)) + " ";
      return list;
    };
    const std::string place = "<origin xyz=\"" + three(random.uniform(0, 1) < 0.1 ? 100 : 0.5) + "\" rpy=\"" +
                              three(3) + "\"/><axis xyz=\"" + three(1) + "\"/>";
    const bool follows = type < 2 && random.uniform(0, 1) < 0.3;
    text += link("l" + std::to_string(i + 1)) +
            joint("j" + std::to_string(i), types[type], "l" + std::to_string(i), "l" + std::to_string(i + 1),
                  place + (follows ? mimic(random.uniform(-1e4, 1e4), random.uniform(-10, 10)) : ""), 4);
  }
  return text;
}

/// The last link's pose, in long double from the model's numbers.
Matrix4L lastPose(const Kinematics& kinematics, const VectorXd& q) {
  const RobotModel& robot = kinematics.robot();
  Matrix4L pose = Matrix4L::Identity();
  if (kinematics.baseMoves()) {
    const Vector3L w = q.segment<3>(3).cast<Real>();
    pose = moved(q.head<3>().cast<Real>()) * turned(w.normalized(), w.norm());
  }
  for (const LinkModel& link : robot.links) {
    if (link.parentJoint < 0) continue;
    const JointModel& joint = robot.joints[static_cast<std::size_t>(link.parentJoint)];
    pose = pose * joint.origin.matrix().cast<Real>();
    const Vector3L axis = joint.axis.cast<Real>().normalized();
    const std::string& leader =
        joint.mimic ? robot.joints[static_cast<std::size_t>(joint.mimic->joint)].name : joint.name;
    const int k = kinematics.coordinate(leader);
    if (joint.type == JointType::fixed) continue;
    if (joint.type == JointType::floating) {
      const Vector3L w = q.segment<3>(k + 3).cast<Real>();
      pose = pose * moved(q.segment<3>(k).cast<Real>()) * turned(w.normalized(), w.norm());
    } else if (joint.type == JointType::planar) {
      Eigen::Quaternion<Real> plane;
      plane.setFromTwoVectors(Vector3L(0, 0, 1), axis);
      pose = pose * moved(plane * Vector3L(q[k], q[k + 1], 0)) * turned(axis, q[k + 2]);
    } else {
      Real value = q[k];
      if (joint.mimic)
        value = static_cast<Real>(joint.mimic->multiplier) * value + static_cast<Real>(joint.mimic->offset);
      pose = pose * (joint.type == JointType::prismatic ? moved(value * axis) : turned(axis, value));
    }
  }
  return pose;
}

}  // namespace

TEST_CASE("the bound on a chain's rounding holds, and is of the right size") {
  Random random(11);
  double most = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto model =
        std::make_shared<const RobotModel>(parseUrdf(robot(chain(1 + trial % 30, random)), "chain.urdf"));
    const Kinematics kinematics(model, trial % 2 ? BaseMotion::floating : BaseMotion::fixed);
    const int last = static_cast<int>(model->links.size()) - 1;
    const double reach = random.uniform(0, 2);
    const detail::PoseRounding rounding(kinematics, {{last, reach}});
    Kinematics::State state = kinematics.makeState();
    for (int k = 0; k < 10; ++k) {
      const double size = random.uniform(0, 1) < 0.3 ? 1e3 : 3;
      VectorXd q(kinematics.size());
      for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = random.uniform(-size, size);
      kinematics.forwardPoses(q, state);
      const Eigen::Vector3d point = reach * randomDirection(3, random);
      const Vector3L truth = (lastPose(kinematics, q) * point.cast<Real>().homogeneous()).head<3>();
      const Eigen::Vector3d placed = state.link[static_cast<std::size_t>(last)] * point;
      const double error = static_cast<double>((placed.cast<Real>() - truth).norm());
      CAPTURE(trial, k, error);
      CHECK(error <= rounding.most(q));
      most = std::max(most, error / rounding.most(q));
    }
  }
  // Where one term of the sum dominates, such as the angle of a joint that is geared up far.
  CHECK(most > 0.1);
}

TEST_CASE("no margin that a pair reaches is called kept, however far away the links between its bodies are") {
  Random random(3);
  for (const double length : {1.0, 100.0, 1e3, 1e4, 1e5}) {
    TwoBalls fold(folded(length));
    int wrong = 0;
    for (int i = 0; i < 300; ++i) {
      VectorXd q(2);
      q << random.uniform(-3, 3), 3.14159265358979 - (0.2 + random.uniform(0.1, 0.6)) / length;
      const Real a = q[0], b = a + static_cast<Real>(q[1]), l = length;
      const Real x = l * (std::cos(a) + std::cos(b)), y = l * (std::sin(a) + std::sin(b));
      wrong += fold.wrongAt(q, std::sqrt(x * x + y * y));
    }
    CAPTURE(length);
    CHECK(wrong == 0);
  }
}

TEST_CASE("no margin that a pair reaches is called kept, however far a joint is geared up") {
  Random random(2);
  for (const double multiplier : {1.0, 100.0, 1e3, 1e5, 1e6}) {
    TwoBalls gear(geared(multiplier)), rack(racked(multiplier, 1 - multiplier));
    int turns = 0, slides = 0;
    for (int i = 0; i < 300; ++i) {
      VectorXd q(1);
      q << random.uniform(-3, 3);
      turns += gear.wrongAt(q, geared(multiplier, q[0]));
      q << 1 - random.uniform(-0.5, 0.5) / multiplier;
      const Real way =
          static_cast<Real>(multiplier) * static_cast<Real>(q[0]) + static_cast<Real>(1 - multiplier);
      slides += rack.wrongAt(q, std::abs(way));
    }
    CAPTURE(multiplier);
    CHECK(turns == 0);
    CHECK(slides == 0);
  }
}

TEST_CASE("no motion is proven free to a margin that it reaches, however many turns its joint has made") {
  TwoBalls turn(turning());
  Random random(2);
  for (const double turned : {0.0, 1e4, 1e6, 1e8}) {
    int wrong = 0, asked = 0;
    for (int i = 0; i < 300; ++i) {
      VectorXd q0(2), q1(2);
      q0 << random.uniform(-1, 1), turned + random.uniform(-3, 3);
      q1 << q0[0] + random.uniform(-1, 1), q0[1] + random.uniform(-1, 1);
      const auto apart = [&](Real t) {
        const Real s = q0[0] + t * (static_cast<Real>(q1[0]) - q0[0]),
                   a = q0[1] + t * (static_cast<Real>(q1[1]) - q0[1]);
        const Real x = s + 0.5L * std::cos(a), y = 0.5L * std::sin(a);
        return std::sqrt(x * x + y * y);
      };
      constexpr int kSteps = 1000;
      int least = 0;
      for (int k = 1; k <= kSteps; ++k)
        if (apart(Real(k) / kSteps) < apart(Real(least) / kSteps)) least = k;
      if (least == 0 || least == kSteps) continue;
      Real from = Real(least - 1) / kSteps, to = Real(least + 1) / kSteps;
      for (int k = 0; k < 80; ++k) {  // of one valley
        const Real a = from + (to - from) * 0.382L, b = from + (to - from) * 0.618L;
        (apart(a) < apart(b) ? to : from) = apart(a) < apart(b) ? b : a;
      }
      const Real distance = apart((from + to) / 2) - 2 * static_cast<Real>(0.1);
      if (distance < 0.01L) continue;
      ++asked;
      for (const double more : {1e-13, 1e-12, 1e-11, 1e-10})
        wrong += turn.motions.isMotionFree(q0, q1, static_cast<double>(distance + more));
    }
    CAPTURE(turned, asked);
    CHECK(asked > 20);
    CHECK(wrong == 0);
  }
}
