// See load_warnings.h.
#include "fcl_stpbv/robot/load_warnings.h"

#include <set>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/adjacency.h"

namespace fcl_stpbv::detail {
namespace {

// A warning that names the joints for which `still` holds. Empty if there are none.
template <class Still>
std::vector<std::string> warningOf(const RobotModel& robot, const Still& still, const char* one,
                                   const char* several) {
  constexpr std::size_t kNamed = 5;
  std::vector<std::string> names;
  for (const JointModel& joint : robot.joints)
    if (still(joint)) names.push_back("'" + joint.name + "'");
  if (names.empty()) return {};
  return {robot.path + ": " + (names.size() == 1 ? "the joint " : "the joints ") +
          listed(names, names.size(), kNamed) + " " + (names.size() == 1 ? one : several) + "."};
}

}  // namespace

std::vector<std::string> stillJoints(const RobotModel& robot) {
  const auto still = [](const JointModel& joint) {
    const bool single = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    return single && !joint.mimic && joint.lower == joint.upper;
  };
  return warningOf(robot, still, "has no range between its limits, so it never moves",
                   "have no range between their limits, so they never move");
}

std::vector<std::string> stillObstacles(const RobotModel& scene) {
  const auto still = [](const JointModel& joint) { return joint.type != JointType::fixed; };
  return warningOf(scene, still, "stands still in the neutral posture, as all obstacles do",
                   "stand still in the neutral posture, as all obstacles do");
}

std::vector<std::string> leavesOutNone(const RobotModel& robot, const RobotGeometry& geometry,
                                       const Srdf& srdf) {
  const Adjacency adjacency(robot, geometry);
  const SkipReasons reasons(&srdf);
  std::set<int> links;
  for (const Body& body : geometry.bodies) links.insert(body.link);
  std::size_t near = 0;
  for (const int i : links)
    for (auto j = links.upper_bound(i); j != links.end(); ++j) {
      if (!reasons.of(robot.links[at(i)].name, robot.links[at(*j)].name).empty()) return {};
      near += adjacency.of(i, *j) != Joining::separate;
    }
  if (near == 0) return {};
  return {srdf.path + ": leaves out no pair of links, so " + counted(near, "pair") +
          " of adjacent or rigidly joined ones " + (near == 1 ? "is" : "are") +
          " checked too; urdf_collision_report --format srdf writes one that leaves them out."};
}

std::vector<std::string> raisedR(const RobotModel& robot, const RobotGeometry& geometry,
                                 const GeometryOptions& options, const std::string& remedy) {
  const Body* most = nullptr;
  for (const Body& body : geometry.bodies) {
    const bool given = !options.fitBigRadius ||
                       options.links.count(robot.links[static_cast<std::size_t>(body.link)].name) > 0;
    // A single vertex gives a ball for any R.
    if (!body.primitive || body.volume->vertexCount() < 2 || !given) continue;
    if (body.volume->radii().R <= body.radii.R) continue;
    if (!most || body.volume->radii().R > most->volume->radii().R) most = &body;
  }
  if (!most) return {};
  return {
      formatted("%s: R = %.4g m is too small for the smooth cover of '%s', which has R = %.4g m instead; ",
                robot.path.c_str(), most->radii.R, most->name.c_str(), most->volume->radii().R) +
      remedy + "."};
}

std::string openParts(const RobotGeometry& geometry) {
  std::set<std::string> names;
  for (const Body& body : geometry.bodies)
    if (body.openPieces > 0) names.insert(geometry.bodies[static_cast<std::size_t>(body.partOf)].name);
  if (names.empty()) return "";
  const std::string others =
      names.size() > 1 ? " and of " + std::to_string(names.size() - 1) + " more meshes" : "";
  return "the convex parts of '" + *names.begin() + "'" + others +
         " cover faces, but not the space inside: the mesh is not closed. Close it, or take the link whole.";
}

}  // namespace fcl_stpbv::detail
