// The cause of a collision: the meshes meet; otherwise the hulls meet; otherwise only the volumes. Pairs of
// bodies are tested nearest first, so that distant meshes need no distance. Exact bodies are made once and
// kept. The key of a result in the cache is made of the meshes, the volumes and their poses.
#include "fcl_stpbv/report/pair_cause.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/digest.h"
#include "fcl_stpbv/report/mesh_fit.h"
#include "fcl_stpbv/robot/keyed_mesh.h"

namespace fcl_stpbv::report {

using namespace detail;

PairCauses::PairCauses(std::shared_ptr<const Kinematics> kinematics,
                       std::shared_ptr<const RobotGeometry> robot, std::vector<Obstacle> obstacles,
                       std::shared_ptr<const RobotGeometry> scene, VolumeCache* cache)
    : kinematics_(std::move(kinematics)),
      robot_(std::move(robot)),
      scene_(std::move(scene)),
      obstacles_(std::move(obstacles)),
      cache_(cache) {}

void PairCauses::use(std::shared_ptr<const RobotGeometry> robot) {
  robot_ = std::move(robot);
  partHulls_.clear();
  digests_.clear();
}

const ExactBody& PairCauses::exact(const Body& body) {
  const Body& whole = body.partOf < 0 ? body : robot_->bodies[at(body.partOf)];
  const auto& shape = whole.primitive ? whole.primitive : whole.geometry;
  std::unique_ptr<ExactBody>& place =
      exact_[{whole.file.empty() ? "" : meshKey(whole), whole.file.empty() ? shape.get() : nullptr}];
  if (!place) place = std::make_unique<ExactBody>(whole);
  return *place;
}

const fcl::CollisionGeometryd& PairCauses::hull(const Body& body) {
  if (body.partOf < 0) return exact(body).hull();
  auto& place = partHulls_[&body];
  if (!place) place = detail::hullGeometry(body.hull);
  return *place;
}

PairCauses::Placed PairCauses::first(const CheckedPair& pair, const Kinematics::State& state) {
  const Body& body = robot_->bodies[at(pair.body)];
  return {&exact(body), &hull(body), state.link[at(body.link)] * body.pose};
}

PairCauses::Placed PairCauses::second(const CheckedPair& pair, const Kinematics::State& state) {
  if (pair.obstacle) {
    const Body& body = scene_->bodies[at(pair.other)];
    return {&exact(body), &hull(body), obstacles_[at(pair.other)].pose()};
  }
  return first({pair.other, pair.body}, state);
}

PairCause PairCauses::explain(const std::vector<CheckedPair>& bodies, const Eigen::VectorXd& q,
                              double margin) {
  const std::optional<std::string> asked = cache_ ? question(bodies, q, margin) : std::nullopt;
  if (!asked) return measured(bodies, q, margin);
  const std::array<const char*, 4> causes{"", kMarginOnly, kHullOnly, kMeshesMeet};
  const auto measure = [&]() -> std::vector<double> {
    const PairCause found = measured(bodies, q, margin);
    const auto cause = std::find(causes.begin(), causes.end(), found.cause);
    return {found.meshDistance, static_cast<double>(cause - causes.begin())};
  };
  std::vector<double> kept = cache_->numbers(*asked, "cause", measure);
  if (kept.size() != 2 || !(kept[1] >= 0 && kept[1] < 4)) kept = measure();
  return {kept[0], causes[static_cast<std::size_t>(kept[1])]};
}

const std::string& PairCauses::contentDigest(const Body& body) {
  std::string& known = digests_[&body];
  if (known.empty()) known = sha256(contentOf(body));
  return known;
}

// Everything that measured() reads, as text; no value if a body is no mesh.
std::optional<std::string> PairCauses::question(const std::vector<CheckedPair>& bodies,
                                                const Eigen::VectorXd& q, double margin) {
  Kinematics::State state = kinematics_->makeState();
  kinematics_->forward(q, state);
  std::string text;
  appendNumber(text, margin);
  const auto add = [&](const Body& body, const Eigen::Isometry3d& pose) {
    if (body.file.empty()) return false;
    text += '\n';
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) appendNumber(text += ' ', pose(row, column));
    text += ' ' + contentDigest(body);
    return true;
  };
  const auto addOwn = [&](int index) {
    const Body& body = robot_->bodies[at(index)];
    return add(body, state.link[at(body.link)] * body.pose);
  };
  for (const CheckedPair& pair : bodies) {
    const bool meshes = addOwn(pair.body) && (pair.obstacle ? add(scene_->bodies[at(pair.other)],
                                                                  obstacles_[at(pair.other)].pose())
                                                            : addOwn(pair.other));
    if (!meshes) return std::nullopt;
  }
  return text;
}

// Measures one pair of bodies after the other, nearest first.
PairCause PairCauses::measured(const std::vector<CheckedPair>& bodies, const Eigen::VectorXd& q,
                               double margin) {
  ConstraintOptions options;
  options.obstacles = obstacles_;
  CollisionConstraints constraints(kinematics_, robot_, bodies, options);
  Eigen::VectorXd d(constraints.rows());
  constraints.evaluate(q, d);
  std::vector<int> order(bodies.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return d[a] < d[b]; });
  PairCause found{kInfinity, ""};
  bool hulls = false;
  const auto wholeOf = [&](int body) {
    const int whole = robot_->bodies[at(body)].partOf;
    return whole < 0 ? body : whole;
  };
  std::set<std::pair<int, int>> measured;  // pairs of whole bodies; parts share their mesh
  for (const int row : order) {
    const Placed a = first(bodies[at(row)], constraints.state()),
                 b = second(bodies[at(row)], constraints.state());
    if (d[row] <= margin) {
      if (found.cause.empty()) found.cause = kMarginOnly;
      hulls = hulls || !isFartherThan(margin, *a.hull, a.pose, *b.hull, b.pose);
    }
    // A volume contains its mesh, so meshes are at least as far apart as their volumes.
    const CheckedPair& pair = bodies[at(row)];
    const int other = pair.obstacle ? pair.other : wholeOf(pair.other);
    if (d[row] >= found.meshDistance || !measured.insert({wholeOf(pair.body), other}).second) continue;
    const double least = std::max(0.0, constraints.answer(row).lower);
    found.meshDistance =
        std::min(found.meshDistance, meshDistance(*a.body, a.pose, *b.body, b.pose, least).upper);
  }
  if (found.cause.empty()) return found;
  if (found.meshDistance <= std::max(0.0, margin))
    found.cause = kMeshesMeet;
  else if (hulls)
    found.cause = kHullOnly;
  return found;
}

}  // namespace fcl_stpbv::report
