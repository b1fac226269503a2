// What urdf_collision_report finds:
// 1. the pair list with its reasons (robot/pair_list.h);
// 2. each checked pair in the given posture or its closest one: distances of volumes, hulls and meshes,
//    gradient;
// 3. how far the links' volumes exceed their meshes, and what each collision comes from.
#include "fcl_stpbv/report/collision_report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/report/robot_files.h"
#include "fcl_stpbv/robot/json_text.h"
#include "fcl_stpbv/robot/smooth_pairs.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A configuration from a JSON object of joints' values, or a list of all coordinates.
Eigen::VectorXd poseFromJson(const std::string& path, const Kinematics& kinematics) {
  // A joint value larger than any robot's is a mistake, and past 1e9 its sine has no exact digit left.
  constexpr double kMost = 1e6;
  const auto values = [&](const nlohmann::json& json) {
    const auto list = json.is_array() ? json.get<std::vector<double>>() : std::vector{json.get<double>()};
    for (const double value : list)
      if (!(std::abs(value) <= kMost)) throw Error(path + ": a joint's value must be from -1e6 to 1e6");
    return list;
  };
  try {
    const nlohmann::json json = readJson(path);
    if (json.is_array()) {
      const std::vector<double> all = values(json);
      if (static_cast<int>(all.size()) != kinematics.size())
        throw Error(path + ": has " + std::to_string(all.size()) + " values, the robot has " +
                    std::to_string(kinematics.size()) + " coordinates");
      return Eigen::Map<const Eigen::VectorXd>(all.data(), kinematics.size());
    }
    Srdf::State state;
    state.name = path;
    for (const auto& [joint, value] : json.items()) {
      if (kinematics.robot().joint(joint) < 0) throw Error(path + ": the robot has no joint '" + joint + "'");
      state.joints[joint] = values(value);
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

// Height of the supporting plane with the unit normal `n` over the geometry's origin (m).
double supportOf(const fcl::CollisionGeometryd& geometry, const Eigen::Vector3d& n) {
  if (const StpBvGeometry* smooth = asStpBv(&geometry)) return smooth->volume().support(n);
  Shape shape;
  return shapeOf(geometry, shape) ? n.dot(shape.support(n)) + shape.margin : 0;
}

// A body or an obstacle in its place, and what it covers: a primitive, or as a polyhedron the hull of all the
// mesh's points, also under a reduced volume.
struct Placed {
  const fcl::CollisionGeometryd* body;
  std::shared_ptr<const fcl::CollisionGeometryd> hull;
  Eigen::Isometry3d pose;

  double cover(const Eigen::Vector3d& normal) const {
    if (normal.isZero() || !asStpBv(body)) return 0;
    const Eigen::Vector3d n = pose.linear().transpose() * normal;
    Shape covered;
    if (!shapeOf(*hull, covered)) return 0;
    return supportOf(*body, n) - n.dot(covered.support(n)) - covered.margin;
  }
};

Placed placed(const Body& body, const Kinematics::State& state) {
  std::shared_ptr<const fcl::CollisionGeometryd> hull = body.geometry;
  if (body.primitive) hull = body.primitive;
  if (body.full) hull = std::make_shared<StpBvGeometry>(body.full);
  return {body.geometry.get(), hull, state.link[at(body.link)] * body.pose};
}

Placed placed(const Obstacle& obstacle) {
  return {obstacle.geometry.get(), obstacle.primitive ? obstacle.primitive : obstacle.geometry,
          obstacle.pose};
}

void covers(const CollisionReport& report, const CheckedPair& both, const Kinematics::State& state,
            PairReport& pair) {
  const Placed first = placed(report.geometry->bodies[at(both.body)], state);
  const Placed second = both.obstacle ? placed(report.obstacles[at(both.other)])
                                      : placed(report.geometry->bodies[at(both.other)], state);
  pair.overCover1 = first.cover(pair.answer.normal);
  pair.overCover2 = second.cover(-pair.answer.normal);
  const auto margin = [](const Placed& body) {
    const StpBvGeometry* smooth = asStpBv(body.body);
    return smooth ? smooth->volume().radii().r : 0.0;
  };
  pair.lipschitz = 1 / (margin(first) + margin(second));
  pair.hullDistance = std::numeric_limits<double>::quiet_NaN();
  Shape a, b;
  if (!shapeOf(*first.hull, a) || !shapeOf(*second.hull, b)) return;
  const Distance hulls = distance(a, first.pose, b, second.pose);
  if (hulls.status != DistanceStatus::invalid && hulls.distance > 0) pair.hullDistance = hulls.distance;
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
    causes_ =
        std::make_unique<PairCauses>(report_.kinematics, report_.geometry, report_.obstacles, sceneGeometry_);
    for (const Body& body : report_.geometry->bodies)
      report_.fits.push_back(meshFit(body, causes_->exact(body)));
    warnOfOpenMeshes();
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

  RobotFiles files() const {
    RobotFiles files{request_.urdf,     request_.srdf,     request_.obstacles,
                     request_.geometry, request_.geometry, request_.skipInvalid};
    files.sceneGeometry.links.clear();  // these name the robot's
    files.sceneGeometry.budgets.clear();
    files.sceneGeometry.flatLinks.clear();
    files.sceneGeometry.flat = request_.flatObstacles;
    return files;
  }

  void load() {
    RobotLoader loader(files());
    loader.read();
    report_.robot = loader.robot();
    if (loader.srdf()) srdf_ = *loader.srdf();
    std::vector<std::string>& errors = loader.faults().errors;
    if (errors.empty()) LoadFaults::gather(errors, [&] { readPostures(); });
    loader.build();
    RobotGeometry bodies = *loader.geometry();
    sceneGeometry_ = loader.sceneGeometry();
    if (!request_.flatPrimitives) cover(bodies);
    report_.geometry = std::make_shared<const RobotGeometry>(std::move(bodies));
    report_.skipped = loader.skipped();
    report_.warnings = loader.warnings();
    if (!request_.polyhedra.empty())
      report_.polyhedra = comparePolyhedra(*report_.geometry, request_.polyhedra);
    if (loader.scene()) report_.obstacles = obstaclesOf(loader.scene(), sceneGeometry_);
  }

  void readPostures() {
    report_.kinematics = std::make_shared<const Kinematics>(report_.robot);
    if (!request_.pose.empty()) poseOf("--pose", request_.pose, *report_.kinematics, srdf());
    neutral_ = request_.neutral.empty() ? report_.kinematics->neutral()
                                        : poseOf("--neutral", request_.neutral, *report_.kinematics, srdf());
  }

  void cover(RobotGeometry& bodies) {
    constexpr std::size_t kMostBodies = 5000;  // pairList() refuses a robot with more before long
    if (bodies.bodies.size() > kMostBodies) return;
    std::vector<CheckedPair> pairs = selfPairs(*report_.robot, bodies, srdf());
    const auto& motions = report_.kinematics->motions();
    const bool baseMoves = !motions.empty() && motions.front().joint < 0;
    const std::vector<CheckedPair> around =
        obstaclePairs(*report_.robot, bodies, sceneGeometry_.bodies.size(), baseMoves);
    pairs.insert(pairs.end(), around.begin(), around.end());
    coverPrimitives(pairs, bodies, &sceneGeometry_);
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
    const std::vector<CheckedPair> bodies = bodiesOf(*report_.geometry, entry);
    measurePair(report_, bodies, pair);
    pair.colliding = pair.answer.distance <= request_.search.margin;
    explain(bodies, pair);
    report_.pairs.push_back(std::move(pair));
  }

  // Where the volumes meet, or come closer than what they exceed their hulls by: farther apart the volumes'
  // distance says enough. A contradiction is explained where it was found.
  void explain(const std::vector<CheckedPair>& bodies, PairReport& pair) {
    const double margin = request_.search.margin;
    if (pair.answer.distance <= std::max(margin, pair.overCover1 + pair.overCover2)) {
      const PairCause found = causes_->explain(bodies, pair.configuration, margin);
      pair.meshDistance = found.meshDistance;
      pair.cause = found.cause;
    }
    if (pair.cause.empty() && pair.contradictsSrdf)
      pair.cause = causes_->explain(bodies, pair.closest, margin).cause;
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
      if (pair.colliding) ++report_.causes[pair.cause];
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

  void warnOfOpenMeshes() {
    const auto& bodies = report_.geometry->bodies;
    const auto open = std::count_if(bodies.begin(), bodies.end(),
                                    [&](const Body& body) { return !causes_->exact(body).closed(); });
    if (open > 0)
      report_.warnings.push_back(
          request_.urdf + ": " + std::to_string(open) +
          " meshes are not closed: whether another lies inside one of them is judged by its "
          "winding number, and their volume is not known.");
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
  std::unique_ptr<PairCauses> causes_;
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
