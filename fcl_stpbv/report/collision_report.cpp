// See collision_report.h.
#include "fcl_stpbv/report/collision_report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::report {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A configuration from a JSON object of joints' values, or a list of all coordinates.
Eigen::VectorXd poseFromJson(const std::string& path, const Kinematics& kinematics) {
  try {
    const nlohmann::json json = nlohmann::json::parse(readText(path));
    Srdf::State state;
    state.name = path;
    if (json.is_array()) {
      const auto values = json.get<std::vector<double>>();
      if (static_cast<int>(values.size()) != kinematics.size())
        throw Error(path + ": has " + std::to_string(values.size()) + " values, the robot has " +
                    std::to_string(kinematics.size()) + " coordinates");
      return Eigen::Map<const Eigen::VectorXd>(values.data(), kinematics.size());
    }
    for (const auto& [joint, value] : json.items()) {
      if (kinematics.robot().joint(joint) < 0) throw Error(path + ": the robot has no joint '" + joint + "'");
      state.joints[joint] =
          value.is_array() ? value.get<std::vector<double>>() : std::vector<double>{value.get<double>()};
    }
    return kinematics.configuration(state);
  } catch (const nlohmann::json::exception& error) {
    throw Error(path + ": expected a JSON object of joints and their values (" + error.what() + ")");
  }
}

// `option` is the argument that asks for the posture.
Eigen::VectorXd poseOf(const std::string& option, const std::string& pose, const Kinematics& kinematics,
                       const Srdf* srdf) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(pose, ignored)) return poseFromJson(pose, kinematics);
  if (!srdf)
    throw Error(option + " " + pose +
                ": no such file, and no SRDF with postures; give --srdf or a JSON file");
  return kinematics.configuration(srdf->state(pose));
}

// A body or an obstacle in its place. Its hull is that of all the mesh's points, also under a reduced volume.
struct Placed {
  const StpBvGeometry* smooth;
  std::shared_ptr<const StpBvGeometry> full;
  Eigen::Isometry3d pose;

  const HullGraph& hull() const { return full ? full->hull() : smooth->hull(); }
  double cover(const Eigen::Vector3d& normal) const {
    if (!smooth || normal.isZero()) return 0;
    const Eigen::Vector3d n = pose.linear().transpose() * normal;
    double height = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& v : (full ? full.get() : smooth)->volume().vertices())
      height = std::max(height, n.dot(v));
    return smooth->volume().support(n) - height;
  }
};

Placed placed(const Body& body, const Kinematics::State& state) {
  return {asStpBv(body.geometry.get()), body.full ? std::make_shared<StpBvGeometry>(body.full) : nullptr,
          state.link[at(body.link)] * body.pose};
}

void covers(const CollisionReport& report, const CheckedPair& both, const Kinematics::State& state,
            PairReport& pair) {
  const Placed first = placed(report.geometry->bodies[at(both.body)], state);
  Placed second;
  if (both.obstacle) {
    const Obstacle& obstacle = report.obstacles[at(both.other)];
    second = {asStpBv(obstacle.geometry.get()), nullptr, obstacle.pose};
  } else {
    second = placed(report.geometry->bodies[at(both.other)], state);
  }
  pair.overCover1 = first.cover(pair.answer.normal);
  pair.overCover2 = second.cover(-pair.answer.normal);
  pair.hullDistance = std::numeric_limits<double>::quiet_NaN();
  if (!first.smooth || !second.smooth) return;
  const PolyhedralWitness witness = polyhedralWitness(first.hull(), first.pose, second.hull(), second.pose);
  if (witness.verdict == PolyhedralWitness::Verdict::separated) pair.hullDistance = witness.upper;
}

class Maker {
 public:
  explicit Maker(const ReportRequest& request) : request_(request) {}

  CollisionReport make() {
    load();
    PairListOptions search = request_.search;
    search.obstacles = report_.obstacles;
    search.neutral = neutral_;
    report_.list = pairList(report_.kinematics, report_.geometry, srdf(), search);
    const bool posed = !request_.pose.empty();
    report_.pose = request_.pose;
    const Eigen::VectorXd q =
        posed ? poseOf("--pose", request_.pose, *report_.kinematics, srdf()) : report_.kinematics->neutral();
    for (const PairEntry& entry : report_.list) addPair(entry, posed ? q : entry.closest);
    summarise();
    requirePairs(static_cast<std::size_t>(report_.checked), *report_.robot, countsOf(report_.list));
    warnOfNeutral();
    warnOfKinks();
    measure(q);
    return std::move(report_);
  }

 private:
  const Srdf* srdf() const { return request_.srdf.empty() ? nullptr : &srdf_; }

  void load() {
    report_.robot = std::make_shared<const RobotModel>(loadUrdf(request_.urdf));
    if (srdf()) srdf_ = loadSrdf(request_.srdf, *report_.robot);
    report_.kinematics = std::make_shared<const Kinematics>(report_.robot);
    if (!request_.pose.empty())
      poseOf("--pose", request_.pose, *report_.kinematics, srdf());  // refused before the work
    neutral_ = request_.neutral.empty() ? report_.kinematics->neutral()
                                        : poseOf("--neutral", request_.neutral, *report_.kinematics, srdf());
    report_.geometry = std::make_shared<const RobotGeometry>(loadGeometry(*report_.robot, request_.geometry));
    report_.warnings = report_.geometry->warnings;
    if (!request_.polyhedra.empty())
      report_.polyhedra = comparePolyhedra(*report_.geometry, request_.polyhedra);
    if (request_.obstacles.empty()) return;
    const auto scene = std::make_shared<const RobotModel>(loadUrdf(request_.obstacles));
    GeometryOptions options = request_.geometry;
    options.links.clear();  // these name the robot's
    options.budgets.clear();
    options.flatLinks.clear();
    options.flat = request_.flatObstacles;
    sceneGeometry_ = loadGeometry(*scene, options);
    report_.warnings.insert(report_.warnings.end(), sceneGeometry_.warnings.begin(),
                            sceneGeometry_.warnings.end());
    report_.obstacles = obstaclesOf(scene, sceneGeometry_);
  }

  void addPair(const PairEntry& entry, const Eigen::VectorXd& q) {
    PairReport pair;
    pair.link1 = report_.robot->links[at(entry.link1)].name;
    pair.obstacle = entry.obstacle;
    pair.link2 =
        entry.obstacle ? report_.obstacles[at(entry.link2)].name : report_.robot->links[at(entry.link2)].name;
    pair.reason = reasonText(entry.reason);
    if (srdf() && !entry.obstacle) pair.srdfReason = srdf_.reasonToSkip(pair.link1, pair.link2);
    pair.checked = entry.obstacle || (srdf() ? pair.srdfReason.empty() : checkedWithoutSrdf(entry.reason));
    const bool explained = entry.reason == PairReason::adjacent || entry.reason == PairReason::rigid ||
                           entry.reason == PairReason::neverSampled ||
                           entry.reason == PairReason::neverProven;
    pair.contradictsSrdf = (pair.srdfReason == "Never" || pair.srdfReason == "Adjacent") && !explained;
    pair.minDistance = entry.minDistance;
    pair.probabilityBound = entry.probabilityBound();
    pair.security = entry.security;
    pair.influence = entry.influence;
    pair.configuration = q;
    pair.closest = entry.closest;
    measurePair(report_, bodiesOf(*report_.geometry, entry), pair);
    pair.colliding = pair.answer.distance <= request_.search.margin;
    report_.pairs.push_back(std::move(pair));
  }

  void summarise() {
    std::stable_sort(report_.pairs.begin(), report_.pairs.end(),
                     [](const PairReport& a, const PairReport& b) {
                       return a.checked != b.checked ? a.checked : a.answer.distance < b.answer.distance;
                     });
    report_.minDistance = std::numeric_limits<double>::infinity();
    for (const PairReport& pair : report_.pairs) {
      if (!pair.checked) continue;
      ++report_.checked;
      report_.colliding += pair.colliding;
      report_.minDistance = std::min(report_.minDistance, pair.answer.distance);
    }
  }

  void warnOfNeutral() {
    NeutralPosture& found = report_.neutral;
    found = judgeNeutral(report_.kinematics, report_.geometry, report_.list, neutral_, srdf(),
                         request_.search.margin);
    if (found.colliding == 0) return;
    std::string warning =
        request_.urdf + ": in the neutral posture (" +
        (request_.neutral.empty() ? "all joints at zero, or at the limit nearest to it" : request_.neutral) +
        ") the bodies of " + std::to_string(found.colliding) + " pairs of links meet that are not adjacent";
    if (found.better.size() > 0)
      warning += "; those of " + std::to_string(found.collidingThere) + " do in another posture: " +
                 (found.state.empty() ? "neutral.better in the JSON, which --neutral takes from a file"
                                      : "give --neutral " + found.state);
    report_.warnings.push_back(warning + ".");
  }

  void warnOfKinks() {
    const auto kinked = std::count_if(report_.pairs.begin(), report_.pairs.end(), [](const PairReport& pair) {
      return pair.checked && !pair.answer.continuous;
    });
    if (kinked > 0)
      report_.warnings.push_back(
          request_.urdf + ": " + std::to_string(kinked) +
          " checked pairs have no smooth body, so their gradients may jump (\"continuous\" "
          "is false in the JSON).");
  }

  // As a controller runs: small steps around the posture, everything warm.
  void measure(Eigen::VectorXd q) {
    constexpr int kTicks = 300;
    constexpr double kStep = 1e-3;  // rad or m
    std::vector<CheckedPair> bodies;
    for (const PairReport& pair : report_.pairs) {
      const int count = static_cast<int>(report_.geometry->bodies.size());
      if (pair.checked) bodies.push_back({pair.body1, pair.body2 % std::max(1, count), pair.body2 >= count});
      if (pair.checked && pair.body2 >= count) bodies.back().other = pair.body2 - count;
    }
    if (bodies.empty()) return;
    ConstraintOptions options;
    options.obstacles = report_.obstacles;
    options.threads = request_.search.threads;
    CollisionConstraints constraints(report_.kinematics, report_.geometry, bodies, options);
    Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros());
    std::vector<double> times;
    for (int i = 0; i < kTicks; ++i) {
      for (Eigen::Index k = 0; k < q.size(); ++k) q[k] += kStep * std::sin(static_cast<double>(i * (k + 1)));
      const auto start = std::chrono::steady_clock::now();
      constraints.evaluateValues(q, d, values);
      times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(times.begin(), times.begin() + kTicks / 2, times.end());
    report_.usPerTick = times[kTicks / 2] * 1e6;
    report_.nsPerPair = times[kTicks / 2] * 1e9 / static_cast<double>(bodies.size());
  }

  const ReportRequest& request_;
  Srdf srdf_;
  Eigen::VectorXd neutral_;
  RobotGeometry sceneGeometry_;
  CollisionReport report_;
};

}  // namespace

void measurePair(const CollisionReport& report, const std::vector<CheckedPair>& bodies, PairReport& pair) {
  ConstraintOptions options;
  options.obstacles = report.obstacles;
  CollisionConstraints constraints(report.kinematics, report.geometry, bodies, options);
  Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros());
  constraints.evaluateValues(pair.configuration, d, values);
  Eigen::Index row;
  d.minCoeff(&row);
  pair.answer = constraints.answer(static_cast<int>(row));
  const CheckedPair& closest = bodies[static_cast<std::size_t>(row)];
  pair.body1 = closest.body;
  pair.body2 = closest.other + (closest.obstacle ? static_cast<int>(report.geometry->bodies.size()) : 0);
  for (int k = constraints.rowStart()[static_cast<std::size_t>(row)];
       k < constraints.rowStart()[static_cast<std::size_t>(row) + 1]; ++k)
    pair.gradient[report.kinematics->names()[at(constraints.columnIndices()[at(k)])]] = values[k];
  covers(report, closest, constraints.state(), pair);
}

CollisionReport makeReport(const ReportRequest& request) { return Maker(request).make(); }

}  // namespace fcl_stpbv::report
