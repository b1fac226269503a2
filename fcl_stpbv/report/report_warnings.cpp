// One function per warning. Each returns a whole sentence, or "".
#include "fcl_stpbv/report/report_warnings.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

std::string openMeshes(const CollisionReport& report) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < report.fits.size(); ++i) {
    const Body& body = report.geometry->bodies[i];
    if (body.partOf < 0 && !report.fits[i].closed) open.push_back("'" + body.name + "'");
  }
  if (open.empty()) return "";
  const std::string names = listed(open, open.size());
  return open.size() == 1
             ? "1 mesh is not closed, that of " + names +
                   ". Its volume is not known, and whether another mesh lies inside it is an estimate, by "
                   "its winding number."
             : std::to_string(open.size()) + " meshes are not closed, those of " + names +
                   ". Their volume is not known, and whether another mesh lies inside one of them is an "
                   "estimate, by its winding number.";
}

// There is no warning about the neutral posture if a posture or a trajectory was given.
std::string neutralCollisions(const CollisionReport& report, const std::string& neutral) {
  const NeutralPosture& found = report.neutral;
  if (found.colliding == 0 || report.trajectory || !report.pose.empty()) return "";
  std::vector<std::string> pairs;
  for (const LinkPair& pair : found.named)
    pairs.push_back(report.robot->links[at(pair.link1)].name + " - " +
                    report.robot->links[at(pair.link2)].name);
  std::string warning = (found.colliding == 1 ? "1 pair of links that is not adjacent overlaps"
                                              : std::to_string(found.colliding) +
                                                    " pairs of links that are not adjacent overlap") +
                        " in the neutral posture (" +
                        (neutral.empty() ? "all joints at zero, or at the limit nearest to it" : neutral) +
                        "): " + listed(pairs, at(found.colliding));
  if (found.better.size() > 0)
    warning +=
        "; in another posture " +
        (found.collidingThere == 0   ? "none does"
         : found.collidingThere == 1 ? "only 1 does"
                                     : "only " + std::to_string(found.collidingThere) + " do") +
        ": give --neutral " +
        (found.state.empty() ? "the file that urdf_collision_report --format json writes" : found.state);
  return warning + ".";
}

// The pair list has no pairs of an obstacle and a body that no joint moves, so their collisions are only
// reported here.
std::string unmovedInObstacles(const CollisionReport& report) {
  Kinematics::State state = report.kinematics->makeState();
  report.kinematics->forwardPoses(report.kinematics->neutral(), state);
  std::string first;
  std::size_t meet = 0;
  for (const Body& body : report.geometry->bodies) {
    if (body.partOf >= 0 || moves(*report.robot, body.link)) continue;
    const Eigen::Isometry3d pose = state.link[static_cast<std::size_t>(body.link)] * body.pose;
    for (const Obstacle& obstacle : report.obstacles) {
      if (!collides(*body.geometry, pose, *obstacle.geometry(), obstacle.pose(), report.margin)) continue;
      if (++meet == 1) first = "'" + body.name + "' meets the obstacle '" + obstacle.name + "'";
    }
  }
  if (meet == 0) return "";
  const std::string others = meet > 1 ? ", nor " + std::to_string(meet - 1) + " more like it" : "";
  return first + "; no joint moves it, so this pair is not checked" + others + ".";
}

std::string kinks(const CollisionReport& report) {
  const auto kinked = std::count_if(report.pairs.begin(), report.pairs.end(), [](const PairReport& pair) {
    return pair.checked && !pair.answer.continuous;
  });
  if (kinked == 0) return "";
  return std::to_string(kinked) +
         (kinked == 1 ? " checked pair has no smooth body, so its gradient may jump"
                      : " checked pairs have no smooth body, so their gradients may jump") +
         " (\"continuous\" is false in the JSON of urdf_collision_report).";
}

}  // namespace

std::string overlapsAllowed(double margin) {
  if (margin >= 0) return "";
  return formatted("the margin is negative: what overlaps by less than %g m counts as clear.", -margin);
}

std::vector<std::string> reportWarnings(const CollisionReport& report, const std::string& neutral) {
  std::vector<std::string> warnings;
  for (const std::string& text :
       {openMeshes(report), openParts(*report.geometry), neutralCollisions(report, neutral),
        unmovedInObstacles(report), overlapsAllowed(report.margin), kinks(report)})
    if (!text.empty()) warnings.push_back(report.robot->path + ": " + text);
  return warnings;
}

}  // namespace fcl_stpbv::report
