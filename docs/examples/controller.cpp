// Two arms move the boxes in their hands past each other at 1 kHz, kept apart by a velocity damper: once with
// STP-BVs, once with the boxes themselves and the same margin, whose gradient jumps. Run it in
// data/hrp2_style. It writes controller.csv and controller.html into the given folder.
#include <fcl/geometry/shape/box.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "docs/examples/chart.h"
#include "docs/examples/named.h"
#include "docs/examples/page_head.h"
#include "docs/examples/reported.h"
#include "fcl_stpbv/robot/srdf.h"
#include "fcl_stpbv/robot/velocity_damper.h"

using namespace fcl_stpbv;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kPeriod = 1e-3;         // s
constexpr int kDuration = 6;             // s
constexpr double kr = 0.01, kR = 10;     // m
const Vector3d kSize(0.12, 0.10, 0.16);  // of each box (m)

struct Tick {
  // Distance of the boxes with their margins (m); largest acceleration of a joint (rad/s^2).
  double distance, fastest;
};

struct Robot {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const Kinematics> kinematics;
  VectorXd start;
  int coordinate(const std::string& joint) const { return coordinateOf(*kinematics, joint); }
};

Robot load() {
  Robot r;
  r.model = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
  r.kinematics = std::make_shared<const Kinematics>(r.model);
  r.start = r.kinematics->configuration(loadSrdf("hrp2_style.srdf", *r.model).state("half_sitting"));
  for (const double side : {1.0, -1.0}) {
    const std::string arm = side > 0 ? "LARM" : "RARM";
    r.start[r.coordinate(arm + "_JOINT0")] = -0.6;
    r.start[r.coordinate(arm + "_JOINT1")] = side * 0.25;
    r.start[r.coordinate(arm + "_JOINT3")] = -1.2;
  }
  return r;
}

/// A level box under a hand, as a volume or as a plain box.
Body held(const Robot& robot, const std::string& link, bool smooth) {
  Kinematics::State state = robot.kinematics->makeState();
  robot.kinematics->forward(robot.start, state);
  Body box;
  box.link = linkOf(*robot.model, link);
  const Eigen::Isometry3d& hand = state.link[static_cast<std::size_t>(box.link)];
  box.name = link + "'s box";
  box.pose = hand.inverse() * Eigen::Translation3d(hand * Vector3d(0, 0, -0.12));
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(kSize.cwiseProduct(Vector3d(i & 1 ? .5 : -.5, i & 2 ? .5 : -.5, i & 4 ? .5 : -.5)));
  if (smooth) {
    box.volume = StpBv::build(corners, {kr, kR});
    box.geometry = std::make_shared<StpBvGeometry>(box.volume);
  } else {
    box.geometry = std::make_shared<fcl::Boxd>(kSize);
    box.geometry->computeLocalAABB();
  }
  box.centre = box.pose.translation();
  box.radius = kSize.norm() / 2 + kr + kSize.squaredNorm() / kR;  // with the bulge of a volume
  return box;
}

/// The desired motion of the arms without collisions: inwards and back, one hand up while the other goes
/// down.
VectorXd wanted(const Robot& robot, double t) {
  VectorXd q = robot.start;
  for (const double side : {1.0, -1.0}) {
    const std::string arm = side > 0 ? "LARM" : "RARM";
    q[robot.coordinate(arm + "_JOINT0")] += side * 0.15 * std::sin(2 * t);
    q[robot.coordinate(arm + "_JOINT1")] -= side * 0.4 * (1 - std::cos(M_PI * t / 3)) / 2;
    q[robot.coordinate(arm + "_JOINT2")] -= side * 0.5 * (1 - std::cos(M_PI * t / 3)) / 2;
    q[robot.coordinate(arm + "_JOINT4")] += side * 0.04 * std::sin(3 * t);
    q[robot.coordinate(arm + "_JOINT5")] += 0.03 * std::sin(2.3 * t);
  }
  return q;
}

std::vector<Tick> run(const Robot& robot, bool smooth) {
  auto geometry = std::make_shared<RobotGeometry>();
  geometry->bodies = {held(robot, "LARM_LINK5", smooth), held(robot, "RARM_LINK5", smooth)};
  CollisionConstraints constraints(robot.kinematics, geometry, {{0, 1, false}});
  const double margin = smooth ? 0 : 2 * kr;  // the volumes contain this margin
  // clang-format off
DamperOptions options;
options.all.influence += margin;                     // defaults: d_i 5 cm, d_s 1 cm, xi 0.5 m/s
options.all.security += margin;
VelocityDamper damper(constraints, options);
VectorXd q = robot.start, qd = VectorXd::Zero(q.size());
Eigen::MatrixXd A(1, q.size());
VectorXd b(1);
std::vector<Tick> ticks;
for (double t = 0; t < kDuration; t += kPeriod) {
  VectorXd next = 10 * (wanted(robot, t) - q);       // the task: proportional control
  damper.update(q, qd);
  if (damper.dense(A, b) == 1) {                     // one row: the quadratic program min |x - task|^2 is a projection
    const VectorXd row = A.row(0);
    next += row * std::max(0.0, b[0] - row.dot(next)) / row.squaredNorm();
  }
  ticks.push_back({damper.d()[0] - margin, (next - qd).lpNorm<Eigen::Infinity>() / kPeriod});
  qd = next;
  q += kPeriod * qd;
}
  // clang-format on
  return ticks;
}

/// Opens the file before the work, so that a missing folder is reported at once.
std::ofstream opened(const std::filesystem::path& path) {
  std::ofstream file(path);
  if (!file) throw Error(path.string() + ": cannot be written; name a folder that is there");
  return file;
}

bool show(const std::vector<Tick>& smooth, const std::vector<Tick>& flat, std::ostream& csv,
          std::ostream& page) {
  csv << "seconds,distance,distance_boxes,acceleration,acceleration_boxes\n";
  double peak = 0, peakFlat = 0, least = 1;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    csv << static_cast<double>(i) * kPeriod << ',' << smooth[i].distance << ',' << flat[i].distance << ','
        << smooth[i].fastest << ',' << flat[i].fastest << '\n';
    if (i < 500) continue;  // leave out the start from rest
    peak = std::max(peak, smooth[i].fastest);
    peakFlat = std::max(peakFlat, flat[i].fastest);
    least = std::min(least, smooth[i].distance);
  }
  char found[200];
  std::snprintf(found, sizeof found,
                "On STP-BVs the joints reach %.1f rad/s², on boxes with a margin %.0f rad/s²", peak,
                peakFlat);
  page << pageHead(found)
       << "<p>Two arms move the boxes they hold past each other, kept apart by a velocity damper. The "
          "peaks are those after 0.5 s: before, the arms start from rest.</p>";
  const auto picture = [&](const char* title, double Tick::*value, double unit, int low, int high,
                           Level level) {
    Curve boxes{"the boxes with a margin", "var(--hulls)", {}}, volumes{"their STP-BVs", "var(--smooth)", {}};
    for (const Tick& tick : flat) boxes.values.push_back(tick.*value / unit);
    for (const Tick& tick : smooth) volumes.values.push_back(tick.*value / unit);
    page << "\n<h2>" << title << "</h2>\n<div class='chart'>"
         << chart(kDuration, low, high, {boxes, volumes}, level) << "</div>\n";
  };
  picture("Largest joint acceleration (rad/s²)", &Tick::fastest, 1, -1, 3, {});
  picture("Distance beyond the margins (mm)", &Tick::distance, 1e-3, 0, 3, {"10 mm, to be kept", 10});
  page << "</html>\n";
  std::printf("peak acceleration %.3g rad/s^2 on STP-BVs, %.3g on boxes; %.4f m kept\n", peak, peakFlat,
              least);
  if (!csv.flush() || !page.flush()) throw Error("controller.csv or controller.html could not be written");
  return peakFlat > 10 * peak && least > 0.0099;
}

}  // namespace

int main(int argc, char** argv) {
  const auto work = [&] {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    const Robot robot = load();
    std::ofstream csv = opened(folder / "controller.csv"), page = opened(folder / "controller.html");
    return show(run(robot, true), run(robot, false), csv, page) ? 0 : 1;
  };
  return reported(argc, argv, work, "[FOLDER]");
}
