// demo: the HRP-2-style robot from its meshes to distances and gradients, compared with plain FCL's answers.
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/formatted.h"
#include "tools/posed_robot.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::tools;

constexpr double kMm = 1e3;
constexpr double kDegree = 180 / M_PI;
// FCL's default tolerance. A larger error is not rounding.
constexpr double kFclTolerance = 1e-6;

double seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

void heading(const std::string& text) {
  std::printf("\n%s\n%s\n", text.c_str(), std::string(text.size(), '-').c_str());
}

struct PlainFcl {
  double distance;
  Eigen::Vector3d normal;
};

// The query that a user of FCL would make: the same polyhedra, default settings.
PlainFcl plainFcl(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  fcl::DistanceResultd result;
  fcl::distance(&a, &b, request, result);
  return {result.min_distance, (result.nearest_points[1] - result.nearest_points[0]).normalized()};
}

// Distance of the hulls with a certificate, to decide which of the two answers is wrong.
double hullDistance(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
  const StpBvGeometry* first = asStpBv(a.collisionGeometry().get());
  const StpBvGeometry* second = asStpBv(b.collisionGeometry().get());
  return polyhedralWitness(first->hull(), a.getTransform(), second->hull(), b.getTransform()).upper;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * kDegree;
}

void printVolumes(const RobotModel& robot, const RobotGeometry& geometry, double time) {
  int fewest = std::numeric_limits<int>::max(), most = 0;
  double cover = 0;
  for (const Body& body : geometry.bodies) {
    fewest = std::min(fewest, body.volume->vertexCount());
    most = std::max(most, body.volume->vertexCount());
    cover = std::max(cover, body.cover.max);
  }
  std::printf(
      "%zu of %zu links as STP-BVs (r = 10 mm, R = 10 m), read and built in %.2f s:\n"
      "%d to %d vertices each, at most %.1f mm beyond the hull.\n",
      geometry.bodies.size(), robot.links.size(), time, fewest, most, cover * kMm);
}

// The joint that changes this distance most.
std::string steepest(const PosedRobot& posed, const Kinematics& kinematics, int link1, int link2,
                     const DistanceAnswer& answer) {
  double slope = 0;
  std::string joint;
  for (const Kinematics::Dependence& d : kinematics.dependence(link1, link2)) {
    const Twist& twist = posed.state().motion[static_cast<std::size_t>(d.motion)];
    const Eigen::Vector3d& x = answer.points[d.sign < 0 ? 0 : 1];
    const double own = d.sign * answer.normal.dot(twist.linear + twist.angular.cross(x));
    if (!joint.empty() && std::abs(own) <= std::abs(slope)) continue;
    const int coordinate = kinematics.motions()[static_cast<std::size_t>(d.motion)].coordinate;
    slope = own;
    joint = kinematics.names()[static_cast<std::size_t>(coordinate)];
  }
  return signedFixed(slope, 3) + " " + joint;
}

struct Row {
  int a, b;
  DistanceAnswer answer;
};

std::vector<Row> closest(const PosedRobot& posed, std::size_t count) {
  std::vector<Row> rows;
  for (const auto& [a, b] : posed.pairs()) {
    rows.push_back(
        {a, b,
         distance(posed.object(static_cast<std::size_t>(a)), posed.object(static_cast<std::size_t>(b)))});
  }
  std::sort(rows.begin(), rows.end(),
            [](const Row& x, const Row& y) { return x.answer.distance < y.answer.distance; });
  rows.resize(std::min(count, rows.size()));
  return rows;
}

void printPairs(const PosedRobot& posed, const Kinematics& kinematics, const RobotGeometry& geometry,
                const std::vector<Row>& rows) {
  heading("The closest pairs");
  std::printf("%-26s %9s %9s %8s  %s\n", "", "STP-BV", "plain FCL", "normals", "steepest joint");
  std::printf("%-26s %9s %9s %8s  %s\n", "", "[mm]", "[mm]", "[deg]", "[m/rad]");
  int wrong = 0;
  double worst = 0;
  for (const Row& row : rows) {
    const Body& first = geometry.bodies[static_cast<std::size_t>(row.a)];
    const Body& second = geometry.bodies[static_cast<std::size_t>(row.b)];
    const fcl::CollisionObjectd& o1 = posed.object(static_cast<std::size_t>(row.a));
    const fcl::CollisionObjectd& o2 = posed.object(static_cast<std::size_t>(row.b));
    const PlainFcl plain = plainFcl(o1, o2);
    const double error = std::abs(plain.distance - hullDistance(o1, o2));
    wrong += error > kFclTolerance;
    worst = std::max(worst, error);
    std::printf("%-26s %9.3f %9.3f %8.2f  %s\n", (first.name + " - " + second.name).c_str(),
                row.answer.distance * kMm, plain.distance * kMm, angle(row.answer.normal, plain.normal),
                steepest(posed, kinematics, first.link, second.link, row.answer).c_str());
  }
  std::printf(
      "\nEach STP-BV lies outside its hull, by 10 mm at least and by its over-cover at\n"
      "most, so its distance is smaller than the hulls'. Of these %zu pairs FCL is off\n"
      "by more than its own tolerance of 1e-6 m in %s, against the certified\n"
      "distance of the same hulls. \"normals\" is the angle between FCL's normal and\n"
      "the smooth one.\n",
      rows.size(), wrong ? formatted("%d, by up to %.3f mm", wrong, worst * kMm).c_str() : "none");
}

// A random posture in which the left limbs are the mirror image of the right ones, as humanoids often stand
// and walk.
Eigen::VectorXd mirrored(const Kinematics& kinematics, std::mt19937_64& random) {
  Eigen::VectorXd q = kinematics.neutral();
  for (int i = 0; i < kinematics.size(); ++i) {
    const std::string& name = kinematics.names()[static_cast<std::size_t>(i)];
    if (name[0] != 'R') continue;
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
    q[i] = kinematics.lower()[i] + unit * (kinematics.upper()[i] - kinematics.lower()[i]);
    const RobotModel& robot = kinematics.robot();
    const bool pitch = robot.joints[static_cast<std::size_t>(robot.joint(name))].axis.y() != 0;
    q[kinematics.coordinate("L" + name.substr(1))] = pitch ? q[i] : -q[i];
  }
  return q;
}

struct Faults {
  int queries = 0, wrong = 0;
  double worst = 0;
};

// Where the answers part: each limb against its own mirror image. Moves the robot.
void printMirrored(PosedRobot& posed, const Kinematics& kinematics, const RobotGeometry& geometry) {
  constexpr int kPostures = 2000;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [a, b] : posed.pairs()) {
    const std::string& first = geometry.bodies[static_cast<std::size_t>(a)].name;
    const std::string& second = geometry.bodies[static_cast<std::size_t>(b)].name;
    if (first[0] != second[0] && first.substr(1) == second.substr(1)) pairs.emplace_back(a, b);
  }
  Faults smooth, plain;
  std::mt19937_64 random(1);
  for (int posture = 0; posture < kPostures; ++posture) {
    const Eigen::VectorXd q = mirrored(kinematics, random);
    posed.moveTo(q);
    for (const auto& [a, b] : pairs) {
      const DistanceAnswer here = distance(posed.object(a), posed.object(b));
      if (here.distance < 0) continue;
      const PlainFcl fclHere = plainFcl(posed.object(a), posed.object(b));
      const double error = std::abs(fclHere.distance - hullDistance(posed.object(a), posed.object(b)));
      ++smooth.queries;
      smooth.worst = std::max(smooth.worst, here.upper - here.lower);
      smooth.wrong += here.upper - here.lower > kFclTolerance;
      plain.worst = std::max(plain.worst, error);
      plain.wrong += error > kFclTolerance;
    }
  }
  const std::string bounds = smooth.worst > 0 ? formatted("bounds at most %.0e m apart", smooth.worst)
                                              : "both bounds the same number";
  std::printf(
      "Left limbs against right ones in %d mirrored postures: plain FCL is off by\n"
      "more than 1e-6 m in %d of %d pairs, by up to %.3f mm, the STP-BVs in %d\n"
      "(%s).\n\n",
      kPostures, plain.wrong, smooth.queries, plain.worst * kMm, smooth.wrong, bounds.c_str());
}

// FCL's broadphase with this library's callback.
void printClosest(PosedRobot& posed, const std::string& pose) {
  SelfCheck check{&posed, {}};
  const auto asked = std::chrono::steady_clock::now();
  posed.manager().distance(&check, selfDistanceCallback);
  const double took = seconds(asked);
  const DistanceAnswer& found = check.data.result;
  if (!found.object[0]) return;
  const auto name = [](const fcl::CollisionObjectd* object) {
    return static_cast<const Body*>(object->getUserData())->name;
  };
  std::printf(
      "Posture '%s': %s and %s are closest,\n%.6f mm apart. FCL's broadphase found them with our callback, "
      "in\n%.0f us, and asked for %zu of %zu pairs.\n\n",
      pose.c_str(), name(found.object[0]).c_str(), name(found.object[1]).c_str(), found.distance * kMm,
      took * 1e6, check.data.pairs, posed.pairs().size());
}

int run(const std::string& urdf, const std::string& srdfPath, const std::string& pose, std::size_t top) {
  const auto start = std::chrono::steady_clock::now();
  const auto robot = std::make_shared<const RobotModel>(loadUrdf(urdf));
  const Srdf srdf = loadSrdf(srdfPath, *robot);
  GeometryOptions options;
  options.cacheFolder.clear();  // so that the demo shows the conversion
  const RobotGeometry geometry = loadGeometry(*robot, options);
  const double built = seconds(start);

  const Kinematics kinematics(robot);
  const Eigen::VectorXd q = kinematics.configuration(srdf.state(pose));
  PosedRobot posed(kinematics, geometry, srdf);
  heading("What was found");
  printMirrored(posed, kinematics, geometry);
  posed.moveTo(q);
  printClosest(posed, pose);
  printVolumes(*robot, geometry, built);
  printPairs(posed, kinematics, geometry, closest(posed, top));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Distances and gradients of the HRP-2-style robot, next to plain FCL's.", "demo");
  std::string pose = "half_sitting", robot = FCL_STPBV_SOURCE_DIR "/data/hrp2_style/hrp2_style";
  std::size_t top = 12;
  app.option("--pose", pose, "Posture, a group_state of the SRDF").shown();
  app.option("--top", top, "Pairs to print").whole().shown();
  return app.run(argc, argv, [&] { return run(robot + ".urdf", robot + ".srdf", pose, top); });
}
