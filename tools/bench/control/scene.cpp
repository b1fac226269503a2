// Eight scenarios for the robot of data/hrp2_style. It moves boxes in its hands, its arms, a hand or a foot
// along tables, a wall, a shelf and each other. A seed varies the waves of the paths. The pairs become rows
// of CollisionConstraints, with the bodies of a method.
#include "tools/bench/control/scene.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "test/reference/source_folder.h"

namespace fcl_stpbv::benchmark {
namespace {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// The robot in data/, read once.
struct Robot {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const Kinematics> kinematics;
  RobotGeometry geometry;
  Srdf srdf;
};

const Robot& robot() {
  static const Robot loaded = [] {
    const std::string folder = test::sourceFolder() + "/data/hrp2_style/";
    Robot r;
    r.model = std::make_shared<const RobotModel>(loadUrdf(folder + "hrp2_style.urdf"));
    r.kinematics = std::make_shared<const Kinematics>(r.model);
    GeometryOptions options;
    options.radii = {1e-3, 10};
    r.geometry = loadGeometry(*r.model, options);
    r.srdf = loadSrdf(folder + "hrp2_style.srdf", *r.model);
    return r;
  }();
  return loaded;
}

Isometry3d placed(const Vector3d& position) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = position;
  return pose;
}

/// Builds a scene.
class Builder {
 public:
  explicit Builder(Scene& scene) : scene_(scene), state_(scene.kinematics->makeState()) {}

  void move(const std::vector<std::string>& joints) {
    for (const std::string& joint : joints) scene_.joints.push_back(scene_.kinematics->coordinate(joint));
  }
  void set(const std::string& joint, double value) {
    scene_.start[scene_.kinematics->coordinate(joint)] = value;
    scene_.kinematics->forward(scene_.start, state_);
  }
  const Isometry3d& hand(const std::string& link, double side) {
    const int index = robot().model->link(link);
    scene_.hands.push_back({index, state_.link[static_cast<std::size_t>(index)], side});
    return scene_.hands.back().start;
  }
  /// Adds a box that is static, or that `link` holds in its present pose.
  int box(const Vector3d& size, const Vector3d& centre, int link = -1) {
    const Isometry3d pose = placed(centre);
    scene_.solids.push_back({link,
                             link < 0 ? pose : state_.link[static_cast<std::size_t>(link)].inverse() * pose,
                             boxCorners(size)});
    return static_cast<int>(scene_.solids.size()) - 1;
  }
  int body(const std::string& link) {
    const int index = robot().model->link(link);
    const Body& b = robot().geometry.bodies[static_cast<std::size_t>(robot().geometry.of(index).first)];
    scene_.solids.push_back({index, b.pose, b.volume->vertices()});
    return static_cast<int>(scene_.solids.size()) - 1;
  }
  double lowest(const std::vector<int>& bodies) const {
    double low = 1e9;
    for (int i : bodies) {
      const Solid& s = scene_.solids[static_cast<std::size_t>(i)];
      for (const Vector3d& x : s.corners)
        low = std::min(low, (state_.link[static_cast<std::size_t>(s.link)] * s.pose * x).z());
    }
    return low;
  }
  void pair(int a, int b) { scene_.pairs.emplace_back(a, b); }

 private:
  Scene& scene_;
  Kinematics::State state_;
};

const std::vector<std::string> kLeftArm{"CHEST_JOINT0", "CHEST_JOINT1", "LARM_JOINT0", "LARM_JOINT1",
                                        "LARM_JOINT2",  "LARM_JOINT3",  "LARM_JOINT4", "LARM_JOINT5"};
const std::vector<std::string> kRightArm{"RARM_JOINT0", "RARM_JOINT1", "RARM_JOINT2",
                                         "RARM_JOINT3", "RARM_JOINT4", "RARM_JOINT5"};
const std::vector<std::string> kLeftLeg{"LLEG_JOINT0", "LLEG_JOINT1", "LLEG_JOINT2",
                                        "LLEG_JOINT3", "LLEG_JOINT4", "LLEG_JOINT5"};

void bendArm(Builder& build, const std::string& side, double sign, const Variation& v) {
  build.set(side + "_JOINT0", -0.6 + v.start[0]);
  build.set(side + "_JOINT1", sign * (0.25 + v.start[1]));
  build.set(side + "_JOINT3", -1.2 + v.start[2]);
}

void boxInHand(Builder& build, const std::string& scenario) {
  const Vector3d centre = build.hand("LARM_LINK5", 1) * Vector3d(0, 0, -0.16);
  const int held = build.box({0.14, 0.10, 0.06}, centre, robot().model->link("LARM_LINK5"));
  int other = -1;
  if (scenario == "table") other = build.box({0.6, 0.8, 0.3}, centre - Vector3d(0, 0, 0.24));
  if (scenario == "rail") other = build.box({0.6, 0.12, 0.3}, centre - Vector3d(0, 0, 0.24));
  if (scenario == "wall") other = build.box({0.6, 0.3, 0.5}, centre + Vector3d(0, 0.26, 0));
  if (scenario == "shelf") other = build.box({0.3, 0.8, 0.02}, centre + Vector3d(0.07 + 0.06 + 0.15, 0, 0));
  build.pair(held, other);
}

void foot(Builder& build) {
  build.set("LLEG_JOINT2", -0.6);
  build.set("LLEG_JOINT3", 1.1);
  build.set("LLEG_JOINT4", -0.5);
  const Isometry3d at = build.hand("LLEG_LINK5", 1);
  const int sole = build.body("LLEG_LINK5");
  const double low = build.lowest({sole});
  const int step =
      build.box({0.3, 0.4, 0.2}, {at.translation().x() + 0.05, at.translation().y(), low - 0.15});
  build.pair(sole, step);
}

}  // namespace

std::vector<Vector3d> boxCorners(const Vector3d& size) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(0.5 * size.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return corners;
}

double margins(const Method& method) {
  if (method.model == Model::hull || method.model == Model::manifold) return 2 * method.r;
  return method.model == Model::half && !method.bare ? method.r : 0;
}

Variation variationOf(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  Variation v;
  for (double& phase : v.phase) phase = seed == 0 ? 0 : uniform(0, 2 * M_PI);
  v.size = seed == 0 ? 1 : uniform(0.8, 1.2);
  v.tilt = seed == 0 ? 0.03 : uniform(0.01, 0.05);
  for (double& start : v.start) start = seed == 0 ? 0 : uniform(-0.05, 0.05);
  return v;
}

const std::vector<std::string>& scenarios() {
  static const std::vector<std::string> names{"table", "rail", "wall", "boxes",
                                              "hand",  "arms", "step", "shelf"};
  return names;
}

Scene makeScene(const std::string& scenario, int seed) {
  const std::vector<std::string>& names = scenarios();
  if (std::find(names.begin(), names.end(), scenario) == names.end())
    throw Error("unknown scenario '" + scenario +
                "'; there are table, rail, wall, boxes, hand, arms, step, shelf");
  Scene scene;
  scene.kinematics = robot().kinematics;
  scene.start = scene.kinematics->configuration(robot().srdf.state("half_sitting"));
  scene.scenario = scenario;
  scene.variation = variationOf(seed);
  scene.begin = scenario == "boxes" || scenario == "arms" ? 1.5 : 1.0;
  Builder build(scene);
  const bool both = scenario == "boxes" || scenario == "arms";
  build.move(scenario == "step" ? kLeftLeg : kLeftArm);
  if (both) build.move(kRightArm);
  if (scenario == "step") {
    foot(build);
    return scene;
  }
  bendArm(build, "LARM", 1, scene.variation);
  if (both) bendArm(build, "RARM", -1, scene.variation);
  if (scenario == "hand") {
    const Isometry3d at = build.hand("LARM_LINK5", 1);
    const std::vector<int> bodies{build.body("LARM_LINK4"), build.body("LARM_LINK5"),
                                  build.body("LARM_LINK6")};
    const int table =
        build.box({0.6, 0.8, 0.3}, {at.translation().x(), at.translation().y(), build.lowest(bodies) - 0.21});
    for (int b : bodies) build.pair(b, table);
  } else if (both) {
    const Isometry3d left = build.hand("LARM_LINK5", 1), right = build.hand("RARM_LINK5", -1);
    std::vector<int> one, two;
    if (scenario == "boxes") {
      one = {build.box({0.12, 0.10, 0.16}, left * Vector3d(0, 0, -0.12), scene.hands[0].link)};
      two = {build.box({0.12, 0.10, 0.16}, right * Vector3d(0, 0, -0.12), scene.hands[1].link)};
    } else {
      for (const char* link : {"LARM_LINK3", "LARM_LINK4", "LARM_LINK5", "LARM_LINK6"})
        one.push_back(build.body(link));
      for (const char* link : {"RARM_LINK3", "RARM_LINK4", "RARM_LINK5", "RARM_LINK6"})
        two.push_back(build.body(link));
    }
    for (int a : one)
      for (int b : two) build.pair(a, b);
  } else {
    boxInHand(build, scenario);
  }
  return scene;
}

Isometry3d Scene::target(const Hand& hand, double time) const {
  const double pace = 2 * M_PI * time / 3;
  const Variation& v = variation;
  const auto wave = [&](double rate, int k) {
    return v.size * (std::sin(rate * pace + v.phase[k]) - std::sin(v.phase[k]) * std::exp(-2 * time));
  };
  Vector3d to(0.06 * wave(1, 0), 0.03 * wave(2, 1), -std::min(0.10, 0.05 * time));
  if (scenario == "rail") to.y() = 0.05 * wave(1.3, 1);
  if (scenario == "wall") to = {0.06 * wave(1, 0), std::min(0.12, 0.06 * time), 0.03 * wave(2, 1)};
  if (scenario == "shelf") to = {std::min(0.12, 0.06 * time), 0.06 * wave(1, 0), 0.04 * wave(1.3, 1)};
  if (scenario == "step") to = {0.05 * wave(1, 0), 0.02 * wave(2, 1), -std::min(0.10, 0.05 * time)};
  if (scenario == "boxes")
    to = {0.03 * wave(1, 0) * hand.side, -hand.side * std::min(0.40, 0.30 * time),
          0.03 * wave(2, 1) * hand.side};
  if (scenario == "arms")
    to = {0.06 * wave(1, 0) * hand.side, -hand.side * std::min(0.30, 0.15 * time),
          0.04 * wave(2, 1) * hand.side};
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = hand.start.translation() + to;
  pose.linear() = (Eigen::AngleAxisd(v.tilt * std::sin(0.7 * pace), Vector3d::UnitY()) *
                   Eigen::AngleAxisd(v.tilt * (std::cos(0.9 * pace) - 1), Vector3d::UnitX()))
                      .toRotationMatrix() *
                  hand.start.linear();
  return pose;
}

std::unique_ptr<CollisionConstraints> constraintsOf(const Scene& scene, const Method& method) {
  if (method.model == Model::none) return nullptr;
  const auto geometryOf = [&](const Solid& s) -> std::shared_ptr<fcl::CollisionGeometryd> {
    const bool flat = method.model == Model::hull || method.model == Model::manifold ||
                      (method.model == Model::half && s.link < 0);
    if (flat) return hullGeometry(s.corners);
    return std::make_shared<StpBvGeometry>(StpBv::build(s.corners, {method.r, method.R}));
  };
  auto geometry = std::make_shared<RobotGeometry>();
  ConstraintOptions options;
  std::vector<int> index;
  for (const Solid& s : scene.solids) {
    const auto shape = geometryOf(s);
    shape->computeLocalAABB();
    if (s.link < 0) {
      index.push_back(static_cast<int>(options.obstacles.size()));
      options.obstacles.push_back(obstacleOf(fcl::CollisionObjectd(shape, s.pose), "obstacle"));
      continue;
    }
    index.push_back(static_cast<int>(geometry->bodies.size()));
    Body body;
    body.link = s.link;
    body.name = "body";
    body.pose = s.pose;
    body.geometry = shape;
    body.centre = s.pose * shape->aabb_center;
    body.radius = shape->aabb_radius;
    geometry->bodies.push_back(body);
  }
  std::vector<CheckedPair> pairs;
  for (const auto& [a, b] : scene.pairs) {
    const bool obstacle = scene.solids[static_cast<std::size_t>(b)].link < 0;
    pairs.push_back({index[static_cast<std::size_t>(a)], index[static_cast<std::size_t>(b)], obstacle});
  }
  return std::make_unique<CollisionConstraints>(scene.kinematics, geometry, pairs, options);
}

}  // namespace fcl_stpbv::benchmark
