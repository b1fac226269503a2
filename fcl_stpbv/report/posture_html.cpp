// The page of a posture: the collision report's page with one configuration.
#include <algorithm>
#include <filesystem>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/posture_formats.h"
#include "fcl_stpbv/report/report_formats.h"

namespace fcl_stpbv::report {

using namespace detail;

// A line for each constraint that the posture violates, and for each constraint in conflict.
static std::vector<std::string> violated(const Posture& posture) {
  std::vector<std::string> lines;
  if (posture.feasible) return lines;
  for (const Violation& v : posture.violations) lines.push_back(v.name + ": violated by " + amountOf(v));
  for (const Violation& v : posture.conflict)
    lines.push_back(v.name + ": in conflict, violated by " + amountOf(v) +
                    " at the least-squares compromise");
  for (const std::string& limit : posture.conflictLimits) lines.push_back(limit + ": at its limit there");
  return lines;
}

std::string toHtml(const PostureReport& report) {
  CollisionReport page;
  page.robot = report.scene.robot;
  page.geometry = report.scene.geometry;
  page.kinematics = report.kinematics;
  page.obstacles = report.scene.obstacles;
  page.pairsOfBodies = true;
  page.margin = report.task.collisionMargin;
  const Posture& posture = report.posture;
  page.pose = verdictOf(report) + formatted(", %d iterations, %.1f ms, cost %.4f", posture.iterations,
                                            posture.seconds * 1e3, posture.cost);
  page.warnings = report.warnings;
  page.skipped = report.skipped;
  page.minDistance = kInfinity;
  const auto nameOf = [&](int body) { return page.geometry->bodies[static_cast<std::size_t>(body)].name; };
  for (const CheckedPair& both : report.pairs) {
    PairReport pair;
    pair.link1 = nameOf(both.body);
    pair.links = linksOf(both, *page.geometry);
    pair.link2 =
        both.obstacle ? page.obstacles[static_cast<std::size_t>(both.other)].name : nameOf(both.other);
    pair.reason = both.obstacle ? "obstacle" : "self";
    pair.configuration = pair.closest = report.posture.q;
    measurePair(page, {both}, pair);
    pair.minDistance = pair.answer.distance;
    page.minDistance = std::min(page.minDistance, pair.minDistance);
    ++page.checked;
    pair.colliding =
        pair.answer.status == DistanceStatus::invalid || !(pair.minDistance > report.task.collisionMargin);
    page.colliding += pair.colliding;
    page.pairs.push_back(std::move(pair));
  }
  std::stable_sort(page.pairs.begin(), page.pairs.end(),
                   [](const PairReport& a, const PairReport& b) { return a.minDistance < b.minDistance; });
  return toHtml(page, "posture for " + std::filesystem::path(report.task.path).filename().string(),
                violated(report.posture), marksOf(report.task, *report.kinematics, report.posture.q));
}

}  // namespace fcl_stpbv::report
