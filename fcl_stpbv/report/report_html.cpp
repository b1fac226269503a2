// The report's page: the files of page/ filled with its data in one packed block (packed_text.h): JSON with
// figures cut to eight digits, in which shapes are 16-bit numbers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/report/json_values.h"
#include "fcl_stpbv/report/outline.h"
#include "fcl_stpbv/report/packed_text.h"
#include "fcl_stpbv/report/page_files.h"
#include "fcl_stpbv/report/report_formats.h"
#include "fcl_stpbv/report/shown_text.h"
#include "fcl_stpbv/report/trajectory_data.h"
#include "fcl_stpbv/robot/joint_freedoms.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// Tolerance of a drawn body, as a share of its size: an edge rounded by r = 1 cm on a link of 30 cm gets
// three steps.
constexpr double kTolerance = 1.0 / 500;
// Largest number of corners of a body. It is enough for the tolerance on links of robots, and bounds the
// page's size.
constexpr int kMostCorners = 400;
constexpr double kSteps = 65535;

template <class Number>
std::string base64(const std::vector<Number>& values) {
  return report::base64(values.data(), values.size() * sizeof(Number));
}

// The shape of a body: corners as steps within the body's box, triangles as indices.
nlohmann::json shapeOf(const fcl::CollisionGeometryd& geometry) {
  const TriangleMesh mesh = outline(geometry, kTolerance * geometry.aabb_radius, kMostCorners);
  Eigen::Vector3d low(0, 0, 0), high(0, 0, 0);
  if (!mesh.vertices.empty()) low = high = mesh.vertices[0];
  for (const Eigen::Vector3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Eigen::Vector3d step = (high - low) / kSteps;
  std::vector<std::uint16_t> corners, triangles;
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (int i = 0; i < 3; ++i)
      corners.push_back(static_cast<std::uint16_t>(step[i] > 0 ? std::lround((v[i] - low[i]) / step[i]) : 0));
  for (const auto& t : mesh.triangles)
    for (const int v : t) triangles.push_back(static_cast<std::uint16_t>(v));
  return {{"low", numbers(low)},
          {"step", numbers(step)},
          {"corners", base64(corners)},
          {"triangles", base64(triangles)}};
}

nlohmann::json rowsOf(const Eigen::Isometry3d& pose) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) rows.push_back(pose(i, k));
  return rows;
}

// Bodies and obstacles, each with its shape and its owner, which is the name that its pairs have. Equal
// shapes are stored once.
class Bodies {
 public:
  explicit Bodies(const CollisionReport& report) {
    for (const Body& body : report.geometry->bodies)
      add(body.name,
          report.pairsOfBodies ? body.name : report.robot->links[static_cast<std::size_t>(body.link)].name,
          body.link, body.pose, *body.geometry, body.parts > 0);
    for (const Obstacle& obstacle : report.obstacles)
      add(obstacle.name, obstacle.name, -1, obstacle.pose(), *obstacle.geometry(), false);
  }
  nlohmann::json shapes = nlohmann::json::array(), list = nlohmann::json::array();

 private:
  void add(const std::string& name, const std::string& owner, int link, const Eigen::Isometry3d& pose,
           const fcl::CollisionGeometryd& geometry, bool split) {
    nlohmann::json shape = shapeOf(geometry);
    const auto [known, isNew] = known_.emplace(shape.dump(), shapes.size());
    if (isNew) shapes.push_back(std::move(shape));
    list.push_back({{"name", name},
                    {"owner", owner},
                    {"link", link},
                    {"obstacle", link < 0},
                    {"split", split},
                    {"at", rowsOf(pose)},
                    {"shape", known->second}});
  }

  std::map<std::string, std::size_t> known_;
};

// The pose of each link on its parent: the joint's origin, the axes along which it slides and those about
// which it turns.
class Joints {
 public:
  explicit Joints(const Kinematics& kinematics) {
    const RobotModel& robot = kinematics.robot();
    for (const LinkModel& link : robot.links) {  // parents first
      if (link.parentJoint < 0) {
        add(-1, Eigen::Isometry3d::Identity());
        if (kinematics.baseMoves()) move(baseOf(kinematics), Eigen::Vector3d::UnitZ(), 0);
        continue;
      }
      const JointModel& joint = robot.joints[static_cast<std::size_t>(link.parentJoint)];
      add(joint.parent, joint.origin);
      const int followed = joint.mimic ? joint.mimic->joint : link.parentJoint;
      const int coordinate = kinematics.coordinate(robot.joints[static_cast<std::size_t>(followed)].name);
      move(joint.type, joint.axis, coordinate, joint.mimic.value_or(Mimic{followed, 1, 0}));
    }
  }
  nlohmann::json list = nlohmann::json::array();

 private:
  static JointType baseOf(const Kinematics& kinematics) {
    const auto& motions = kinematics.motions();
    const auto ofBase = std::count_if(motions.begin(), motions.end(),
                                      [](const Kinematics::Motion& motion) { return motion.joint < 0; });
    return ofBase == freedoms(JointType::planar) ? JointType::planar : JointType::floating;
  }

  void add(int parent, const Eigen::Isometry3d& origin) {
    list.push_back({{"parent", parent},
                    {"origin", rowsOf(origin)},
                    {"slides", nlohmann::json::array()},
                    {"turns", nlohmann::json::array()}});
  }

  // Adds the motions of the joint that was added last. `coordinate` is the first of its coordinates.
  void move(JointType type, const Eigen::Vector3d& axis, int coordinate, const Mimic& by = {-1, 1, 0}) {
    const auto add = [&](const char* what, const Eigen::Vector3d& along) {
      list.back()[what].push_back({{"axis", numbers(along)},
                                   {"coordinate", coordinate++},
                                   {"multiplier", by.multiplier},
                                   {"offset", by.offset}});
    };
    if (type == JointType::planar)
      for (int i = 0; i < 2; ++i) add("slides", planeAcross(axis).col(i));
    if (type == JointType::floating)
      for (const char* what : {"slides", "turns"})
        for (int i = 0; i < 3; ++i) add(what, Eigen::Vector3d::Unit(i));
    else if (type != JointType::fixed)
      add(type == JointType::prismatic ? "slides" : "turns", axis);
  }
};

// Rounds numbers to eight digits, because nobody reads more off a page, and more digits compress badly.
void shorten(nlohmann::json& value) {
  if (value.is_number_float()) {
    const double x = value.get<double>();
    const double places = 7 - std::floor(std::log10(std::max(std::abs(x), 1e-12)));
    const double scale = std::pow(10, std::max(0.0, places));
    if (std::isfinite(x)) value = std::round(x * scale) / scale;
  } else if (value.is_structured()) {
    for (nlohmann::json& item : value) shorten(item);
  }
}

// Files are named without their folders.
void leaveFoldersOut(const std::string& robot, nlohmann::json& data) {
  const auto shorten = [&](nlohmann::json& text) {
    if (text.is_string()) text = withoutFolders(text.get<std::string>(), robot);
  };
  for (const char* texts : {"warnings", "skipped", "violated"})
    for (nlohmann::json& text : data[texts]) shorten(text);
  for (nlohmann::json& link : data["links"]) shorten(link["file"]);
  for (const char* text : {"title", "pose"}) shorten(data[text]);
  if (data["trajectory"].is_object()) {
    nlohmann::json& file = data["trajectory"]["file"];
    file = std::filesystem::path(file.get<std::string>()).filename().string();
  }
}

// What a task asks for: targets with their frames, and contacts.
void addMarks(const TaskMarks& marks, nlohmann::json& data) {
  data["targets"] = data["contacts"] = nlohmann::json::array();
  for (const TargetMark& mark : marks.targets)
    data["targets"].push_back({{"name", mark.name},
                               {"target", rowsOf(mark.target)},
                               {"frame", rowsOf(mark.frame)},
                               {"turns", mark.turns},
                               {"off", mark.off},
                               {"turned", mark.turned}});
  for (const ContactMark& mark : marks.contacts) {
    nlohmann::json points = nlohmann::json::array();
    for (const Eigen::Vector3d& point : mark.points) points.push_back(numbers(point));
    data["contacts"].push_back({{"link", mark.link}, {"points", std::move(points)}});
  }
}

nlohmann::json dataOf(const CollisionReport& report, const std::string& title,
                      const std::vector<std::string>& violated, const TaskMarks& marks) {
  nlohmann::json data = nlohmann::json::parse(toJson(report));
  const char* const usual = report.obstacles.empty() ? "self-collision report" : "collision report";
  data["title"] = title.empty() ? usual : title;
  data["violated"] = violated;
  addMarks(marks, data);
  data["sampled"] = !report.pairsOfBodies;  // a posture's pairs come from its task, not from a search
  data["hand_over"] = kHandOver;
  data["joints"] = report.kinematics->names();
  data["configurations"] = nlohmann::json::array();
  std::map<std::vector<double>, std::size_t> known;
  const auto indexOf = [&](const Eigen::VectorXd& q) {
    const auto [at, isNew] = known.emplace(std::vector<double>(q.data(), q.data() + q.size()), known.size());
    if (isNew) data["configurations"].push_back(at->first);
    return at->second;
  };
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const PairReport& pair = report.pairs[i];
    nlohmann::json& item = data["pairs"][i];
    item["posture"] = indexOf(pair.configuration);
    item["cover"] = pair.overCover1 + pair.overCover2;
    item["colliding"] = pair.colliding;
    if (std::isfinite(pair.time)) {
      item["time_text"] = report.trajectory->timeText(pair.time);
      item["time_share"] = report.trajectory->share(pair.time);
    }
    item["touches_first"] = pair.stopsTrajectory && report.trajectory->verdict == MotionVerdict::contact;
    item["contradicts_srdf"] = pair.contradictsSrdf;
    item.erase("closest");
  }
  data["trajectory"] = trajectoryData(report, indexOf);
  if (known.empty()) indexOf(report.kinematics->neutral());
  data["kinematics"] = std::move(Joints(*report.kinematics).list);
  leaveFoldersOut(report.robot->path, data);
  shorten(data);
  Bodies bodies(report);
  data["shapes"] = std::move(bodies.shapes);
  data["bodies"] = std::move(bodies.list);
  return data;
}

// Replaces each @NAME@ in `text` by the part of that name.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& parts) {
  std::string out;
  while (!text.empty()) {
    const std::size_t at = text.find('@');
    out += text.substr(0, at);
    if (at == std::string_view::npos) break;
    text.remove_prefix(at + 1);
    const std::size_t end = text.find('@');
    out += parts.at(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return out;
}

}  // namespace

// The chart above the tables, if a trajectory was followed.
static std::string trajectorySection(const CollisionReport& report) {
  if (!report.trajectory) return "";
  return "<section id=\"trajectory\" aria-label=\"Trajectory\"><h2>Least distance of all "
         "checked pairs along the trajectory</h2>" +
         chartOf(*report.trajectory, report.margin) +
         "<p id=\"instants\"></p><div id=\"instant\" class=\"tip\" hidden></div></section>";
}

std::string toHtml(const CollisionReport& report, const std::string& title,
                   const std::vector<std::string>& violated, const TaskMarks& marks) {
  const std::string data =
      dataOf(report, title, violated, marks).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return filled(kPageHtml, {{"TRAJECTORY", trajectorySection(report)},
                            {"STYLE", std::string(kPageStyle)},
                            {"SCRIPT", std::string(kPageScript)},
                            {"THREE", packed(std::string(kPageThree))},
                            {"REPORT", packed(data)}});
}

}  // namespace fcl_stpbv::report
