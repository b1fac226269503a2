// Makes a random task:
// 1. The seed picks one of four families.
// 2. The robot stands on both feet.
// 3. A fridge, a table or shelves of random size contain things, none of them within 9 cm of the place to be
//    reached. Or a block stands in front of the legs.
// 4. One hand must reach the place.
#include "tools/bench/posture_study/tasks.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <cmath>
#include <random>

namespace fcl_stpbv::tools {
namespace {

using Eigen::Vector3d;

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}

  RandomTask make(int family) {
    right_ = flip();
    stand();
    switch (family) {
      case 0:
        fridge();
        break;
      case 1:
        table();
        break;
      case 2:
        shelves();
        break;
      default:
        legs();
    }
    return std::move(made_);
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  bool flip() { return uniform(0, 1) < 0.5; }
  double side() const { return right_ ? -1 : 1; }  // side of the hand that reaches

  template <class Shape>
  void add(const std::string& name, Shape shape, const Vector3d& centre, double yaw = 0) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = centre;
    auto geometry = std::make_shared<Shape>(shape);
    geometry->computeLocalAABB();
    made_.obstacles.push_back(obstacleOf(fcl::CollisionObjectd(geometry, pose), name));
  }
  void addBox(const std::string& name, const Vector3d& low, const Vector3d& high) {
    add(name, fcl::Boxd(high - low), (low + high) / 2);
  }
  // Adds an object that stands on a board: a bottle, box or ball.
  void addThing(const std::string& name, double x, double y, double floor) {
    const double size = uniform(0.025, 0.05), height = uniform(0.1, 0.28);
    const double kind = uniform(0, 3);
    if (kind < 1) add(name, fcl::Cylinderd(size, height), {x, y, floor + height / 2});
    if (kind >= 1 && kind < 2)
      add(name, fcl::Boxd(2 * size, 2 * size, height), {x, y, floor + height / 2}, uniform(0, 3));
    if (kind >= 2) add(name, fcl::Sphered(size), {x, y, floor + size});
  }
  // Adds some objects around a place that is to be reached, none nearer to it than 9 cm.
  void clutter(int count, const Vector3d& target, const Vector3d& low, const Vector3d& high) {
    for (int i = 0; i < count; ++i) {
      double x, y;
      do {
        x = uniform(low.x(), high.x());
        y = uniform(low.y(), high.y());
      } while (std::hypot(x - target.x(), y - target.y()) < 0.09);
      addThing("thing_" + std::to_string(i + 1), x, y, low.z());
    }
  }

  void stand() {
    const double apart = uniform(0.09, 0.15);
    PostureTask& task = made_.task;
    task.path = "random task";
    task.state = flip() ? "zero" : "half_sitting";
    task.basePose.translation() = Vector3d(0, 0, 0.705);
    for (const double s : {-1.0, 1.0}) {
      const std::string link = s < 0 ? "RLEG_LINK5" : "LLEG_LINK5";
      PostureTask::Place foot{link, {}};
      foot.placement.name = link;
      foot.placement.frame.translation() = Vector3d(0, 0, -0.105);
      foot.placement.target.translation() = Vector3d(0, s * apart, 0);
      task.placements.push_back(foot);
      task.contacts.push_back({link,
                               {Vector3d(0.14, s * 0.07, -0.105), Vector3d(0.14, -s * 0.064, -0.105),
                                Vector3d(-0.1, s * 0.07, -0.105), Vector3d(-0.1, -s * 0.064, -0.105)}});
    }
    task.stabilityMargin = 0.02;
  }

  // Lets the hand grasp something upright, or reach a place in any orientation.
  void reach(const Vector3d& target, bool upright) {
    PostureTask::Place hand{right_ ? "RARM_LINK5" : "LARM_LINK5", {}};
    hand.placement.name = "hand";
    hand.placement.frame.translation() = Vector3d(0, -side() * 0.03, -0.135);
    hand.placement.frame.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()).toRotationMatrix();
    hand.placement.target.translation() = target;
    hand.placement.free = {false, false, false, !upright, !upright, true};
    made_.task.placements.push_back(hand);
  }

  void fridge() {
    made_.family = "fridge";
    const double front = uniform(0.24, 0.32), back = 0.86, left = uniform(0.24, 0.32),
                 shelf = uniform(0.76, 1.1);
    const double width = left + 0.38, open = uniform(1.5, 1.9);
    const double s = side();  // the open door is on the reaching hand's side
    const auto panel = [&](const std::string& name, const Vector3d& a, const Vector3d& b) {
      addBox(name, {a.x(), std::min(s * a.y(), s * b.y()), a.z()},
             {b.x(), std::max(s * a.y(), s * b.y()), b.z()});
    };
    panel("side_panel", {front, left, 0.7}, {back, left + 0.04, 1.56});
    panel("other_panel", {front, -0.37, 0.7}, {back, -0.33, 1.56});
    panel("lower_door", {front - 0.06, -0.37, 0.06}, {front, left + 0.04, 0.73});
    panel("shelf_low", {front + 0.02, -0.33, shelf - 0.012}, {back, left, shelf});
    panel("shelf_high", {front + 0.02, -0.33, shelf + 0.32}, {back, left, shelf + 0.332});
    const Eigen::Vector2d along(-std::sin(open), -std::cos(open)), out(-std::cos(open), std::sin(open));
    const Eigen::Vector2d middle = Eigen::Vector2d(front, left + 0.04) + along * width / 2 + out * 0.03;
    add("upper_door", fcl::Boxd(width, 0.06, 0.82), {middle.x(), s * middle.y(), 1.15},
        std::atan2(s * along.y(), along.x()));
    const Vector3d can(uniform(front + 0.15, front + 0.32), s * uniform(-0.15, left - 0.07),
                       shelf + uniform(0.07, 0.16));
    clutter(3, can, {front + 0.07, std::min(-s * 0.25, s * (left - 0.06)), shelf},
            {front + 0.4, std::max(-s * 0.25, s * (left - 0.06)), shelf});
    reach(can, true);
  }

  void table() {
    made_.family = "table";
    const double height = uniform(0.55, 0.95), front = uniform(0.2, 0.35), y = side() * uniform(-0.15, 0.4);
    addBox("table_top", {front, -0.6, height - 0.03}, {front + 0.7, 0.6, height});
    addBox("table_leg_1", {front + 0.02, -0.58, 0}, {front + 0.07, -0.53, height - 0.03});
    addBox("table_leg_2", {front + 0.02, 0.53, 0}, {front + 0.07, 0.58, height - 0.03});
    const bool under = uniform(0, 1) < 0.3;
    const double z = under ? height - uniform(0.12, 0.3) : height + uniform(0.07, 0.25);
    const Vector3d target(front + uniform(0.05, 0.25), y, z);
    clutter(5, under ? Vector3d(9, 9, 9) : target, {front + 0.05, -0.5, height}, {front + 0.5, 0.5, height});
    reach(target, !under && flip());
  }

  void shelves() {
    made_.family = "shelves";
    const double front = uniform(0.25, 0.4), gap = uniform(0.26, 0.36), lowest = uniform(0.1, 0.3);
    addBox("side_1", {front, -0.5, 0}, {front + 0.35, -0.47, 1.9});
    addBox("side_2", {front, 0.47, 0}, {front + 0.35, 0.5, 1.9});
    std::vector<double> boards;
    for (double z = lowest; z < 1.8; z += gap) {
      boards.push_back(z);
      addBox("board_" + std::to_string(boards.size()), {front, -0.47, z - 0.02}, {front + 0.35, 0.47, z});
    }
    std::vector<double> within;
    for (const double z : boards)
      if (z > 0.5 && z < 1.25) within.push_back(z);
    const double board = within[static_cast<std::size_t>(uniform(0, 1) * static_cast<double>(within.size()))];
    const Vector3d target(front + uniform(0.02, 0.2), side() * uniform(-0.15, 0.38),
                          board + uniform(0.08, gap - 0.1));
    clutter(4, target, {front + 0.05, -0.42, board}, {front + 0.3, 0.42, board});
    reach(target, flip());
  }

  void legs() {
    made_.family = "legs";
    const Vector3d target(uniform(-0.1, 0.15), side() * uniform(-0.03, 0.03), uniform(0.2, 0.5));
    addBox("block", {0.3, -0.3, 0}, {0.5, 0.3, uniform(0.2, 0.5)});
    reach(target, false);
  }

  RandomTask made_;
  std::mt19937_64 random_;
  bool right_ = false;
};

}  // namespace

RandomTask randomTask(std::uint64_t seed) { return Maker(seed).make(static_cast<int>(seed % 4)); }

}  // namespace fcl_stpbv::tools
