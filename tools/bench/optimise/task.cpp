// Four tasks of boxes; a seed varies sizes and starts.
// place: put a box onto a plate.
// slot: find the pose with the widest clearance between two plates.
// pack: pull five boxes together.
// corner: find a path around a block's corner.
#include "tools/bench/optimise/task.h"

#include <algorithm>
#include <random>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::benchmark {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Coordinates = Eigen::Matrix<double, 6, 1>;

class Random {
 public:
  explicit Random(int seed) : engine_(static_cast<unsigned>(seed)) {}
  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  Vector3d box(double low, double high) { return {in(low, high), in(low, high), in(low, high)}; }

 private:
  std::mt19937 engine_;
};

/// Three sliding and three turning joints for each body. The order of the turning joints keeps the singular
/// position (the second one at a right angle) away from the paths below.
std::shared_ptr<const Kinematics> freeBodies(int count) {
  std::string text = "<robot name=\"boxes\"><link name=\"world\"/>";
  const char* axes[6] = {"1 0 0", "0 1 0", "0 0 1", "0 1 0", "1 0 0", "0 0 1"};
  for (int body = 0; body < count; ++body) {
    std::string above = "world";
    for (int k = 0; k < 6; ++k) {
      const std::string name = "body" + std::to_string(body) + (k < 5 ? "_" + std::to_string(k) : "");
      text += "<link name=\"" + name + "\"/><joint name=\"to_" + name + "\" type=\"" +
              (k < 3 ? "prismatic" : "revolute") + "\"><parent link=\"" + above + "\"/><child link=\"" +
              name + "\"/><axis xyz=\"" + axes[k] +
              "\"/><limit lower=\"-10\" upper=\"10\" effort=\"1\" velocity=\"1\"/></joint>";
      above = name;
    }
  }
  return std::make_shared<const Kinematics>(
      std::make_shared<const RobotModel>(parseUrdf(text + "</robot>", "boxes")));
}

Isometry3d at(double x, double y, double z) { return Isometry3d(Eigen::Translation3d(x, y, z)); }

class TaskBuilder {
 public:
  TaskBuilder(const std::string& name, int bodies, int knots, bool clearance) {
    task_.name = name;
    task_.scene.kinematics = freeBodies(bodies);
    task_.knots = knots;
    task_.clearance = clearance;
    const int n = 6 * bodies * knots + (clearance ? 1 : 0);
    task_.Q = MatrixXd::Zero(n, n);
    task_.c = task_.start = VectorXd::Zero(n);
    task_.upper = VectorXd::Constant(n, 10);
  }

  /// Adds a free body, whose box is turned by `turned` in its link.
  void body(const Vector3d& size, const Isometry3d& turned = Isometry3d::Identity()) {
    const std::string link = "body" + std::to_string(task_.scene.solids.size());
    task_.scene.solids.push_back({task_.scene.kinematics->robot().link(link), turned, boxCorners(size)});
  }
  void obstacle(const Vector3d& size, const Isometry3d& pose) {
    task_.scene.solids.push_back({-1, pose, boxCorners(size)});
    task_.scene.pairs.emplace_back(0, static_cast<int>(task_.scene.solids.size()) - 1);
  }
  /// Adds weight |position - p|^2 / 2 + turning |angles - w|^2 / 2 for a body, with p and w from `goal`.
  void towards(int body, const Coordinates& goal, double weight, double turning) {
    for (int k = 0; k < 6; ++k) {
      const double w = k < 3 ? weight : turning;
      task_.Q(6 * body + k, 6 * body + k) += w;
      task_.c[6 * body + k] -= w * goal[k];
      task_.constant += 0.5 * w * goal[k] * goal[k];
    }
  }
  /// Adds the mean squared acceleration from rest to rest; 10 cm count as much as a radian.
  void smoothPath(const Coordinates& from, const Coordinates& to) {
    const int knots = task_.knots;
    const double rate = knots + 1;
    for (int i = -1; i <= knots; ++i)
      for (int k = 0; k < 6; ++k) {
        const double w = (k < 3 ? 1 : 0.01) * rate * rate * rate;
        VectorXd second = VectorXd::Zero(task_.c.size());
        double fixed = 0;
        for (int o = -1; o <= 1; ++o) {
          const double share = o == 0 ? -2 : 1;
          if (i + o < 0)
            fixed += share * from[k];
          else if (i + o >= knots)
            fixed += share * to[k];
          else
            second[6 * (i + o) + k] += share;
        }
        task_.Q += w * second * second.transpose();
        task_.c += w * fixed * second;
        task_.constant += 0.5 * w * fixed * fixed;
      }
  }
  Task& task() { return task_; }
  void limitAngles(double most) {
    for (Eigen::Index i = 0; i + 6 <= task_.upper.size(); i += 6)
      task_.upper.segment<3>(i + 3).setConstant(most);
    task_.lower = -task_.upper;
  }

 private:
  Task task_;
};

Isometry3d turnedAboutZ(double angle) { return Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitZ())); }

/// A box onto a plate, towards a place inside it. At the optimum the faces touch flush.
Task place(Random& random) {
  TaskBuilder build("place", 1, 1, false);
  const Vector3d size(random.in(0.08, 0.2), random.in(0.08, 0.2), random.in(0.05, 0.1));
  build.body(size, turnedAboutZ(random.in(-3, 3)));
  build.obstacle({1, 1, 0.2}, at(0, 0, -0.1));
  Coordinates goal;
  goal << random.in(-0.1, 0.1), random.in(-0.1, 0.1), -0.05, random.in(-0.05, 0.05), random.in(-0.05, 0.05),
      random.in(-0.3, 0.3);
  build.towards(0, goal, 100, 1);
  build.task().start << random.in(-0.1, 0.1), random.in(-0.1, 0.1), 0.2, random.box(-0.4, 0.4);
  build.limitAngles(0.6);
  return build.task();
}

/// The pose with the widest clearance between two plates.
Task slot(Random& random) {
  TaskBuilder build("slot", 1, 1, true);
  const double gap = random.in(0.12, 0.16);
  build.body({random.in(0.08, 0.2), random.in(0.08, 0.2), 0.08}, turnedAboutZ(random.in(-3, 3)));
  build.obstacle({1, 1, 0.2}, at(0, 0, -0.1 - gap / 2));
  build.obstacle({1, 1, 0.2}, at(0, 0, 0.1 + gap / 2));
  Coordinates goal;
  goal << random.in(-0.1, 0.1), random.in(-0.1, 0.1), random.in(-0.01, 0.01), random.in(-0.03, 0.03),
      random.in(-0.03, 0.03), random.in(-0.3, 0.3);
  build.towards(0, goal, 0.1, 1e-4);
  build.task().c[6] = -1;
  build.task().start << random.in(-0.1, 0.1), random.in(-0.1, 0.1), random.in(-0.01, 0.01),
      random.box(-0.1, 0.1), 0;
  build.task().upper.head<3>() = Vector3d(0.15, 0.15, 0.05);
  build.limitAngles(0.6);
  return build.task();
}

/// Five boxes pulled together.
Task pack(Random& random) {
  constexpr int kBoxes = 5;
  TaskBuilder build("pack", kBoxes, 1, false);
  for (int i = 0; i < kBoxes; ++i) {
    const Vector3d angles = random.box(-0.5, 0.5);
    const double length = angles.norm();
    build.body(random.box(0.08, 0.16), Isometry3d(Eigen::AngleAxisd(length, angles / length)));
    build.towards(i, Coordinates::Zero(), 10, 1e-3);
    const double turn = 2 * M_PI * i / kBoxes;
    build.task().start.segment<3>(6 * i) =
        Vector3d(0.3 * std::cos(turn), 0.3 * std::sin(turn), random.in(-0.15, 0.15));
    for (int other = 0; other < i; ++other) build.task().scene.pairs.emplace_back(i, other);
  }
  build.limitAngles(1);
  return build.task();
}

/// Ten knots of a path around a block's corner, while the box turns by a right angle.
Task corner(Random& random) {
  constexpr int kKnots = 10;
  TaskBuilder build("corner", 1, kKnots, false);
  build.body({0.14, 0.10, 0.05});
  build.obstacle({0.3, 0.4, 0.3}, at(0, 0, 0));
  const auto small = [&] { return random.in(-0.05, 0.05); };
  Coordinates from, to;
  from << random.in(-0.1, -0.02), small(), random.in(0.20, 0.22), small(), small(), random.in(-0.2, 0.2);
  to << random.in(0.20, 0.22), small(), random.in(-0.1, -0.02), M_PI / 2 + small(), small(),
      random.in(-0.2, 0.2);
  for (int i = 0; i < kKnots; ++i) {
    const double t = (i + 1.0) / (kKnots + 1), out = 0.12 * std::sin(M_PI * t);
    auto knot = build.task().start.segment<6>(6 * i);
    knot = (1 - t) * from + t * to;
    knot[0] += out;
    knot[2] += out;
  }
  build.smoothPath(from, to);
  build.limitAngles(2.5);
  return build.task();
}

}  // namespace

const std::vector<std::string>& tasks() {
  static const std::vector<std::string> names{"place", "slot", "pack", "corner"};
  return names;
}

Task makeTask(const std::string& name, int seed) {
  Random random(1000 + seed);
  if (name == "place") return place(random);
  if (name == "slot") return slot(random);
  if (name == "pack") return pack(random);
  if (name == "corner") return corner(random);
  throw Error("unknown task '" + name + "'; there are place, slot, pack, corner");
}

}  // namespace fcl_stpbv::benchmark
