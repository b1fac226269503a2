// A collision report for people: a summary, then lists cut after `top` lines.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/report/report_formats.h"
#include "fcl_stpbv/report/text_table.h"
#include "fcl_stpbv/text_cells.h"

namespace fcl_stpbv::report {
namespace {

using detail::counted;
using detail::fixed;
using detail::formatted;
using detail::printable;

constexpr double kMm = 1e3;

// How far hulls and volumes exceed meshes, worst first.
std::string fits(const CollisionReport& report, std::size_t top) {
  std::vector<std::size_t> order(report.fits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return report.fits[i].volumeExcess > report.fits[j].volumeExcess;
  });
  const std::string rest = unshown(order.size(), top);
  if (order.size() > top) order.resize(top);
  TextTable table("lrrrrr");
  table.add({"", "hull", "volume", "", "r", "R"});
  table.add({"link", "[mm]", "[mm]", "ratio", "[mm]", "[m]"});
  for (const std::size_t i : order) {
    const MeshFit& fit = report.fits[i];
    const Body& body = report.geometry->bodies[i];
    table.add({body.name, millimetres(fit.hullExcess), millimetres(fit.volumeExcess),
               std::isfinite(fit.volumeRatio) ? formatted("%.3f", fit.volumeRatio) : "-",
               body.volume ? millimetres(body.volume->radii().r) : "-",
               body.volume ? formatted("%.3f", body.volume->radii().R) : "-"});
  }
  return "\n" + table.text() + rest +
         "hull, volume: upper bound on how far their surfaces are from the mesh\n"
         "ratio: the STP-BV's content to the mesh's\n";
}

// The radii that --advise chose.
std::string advised(const CollisionReport& report) {
  StpBvOptions least{HUGE_VAL, HUGE_VAL}, most{0, 0};
  double acceleration = 0;
  for (const Body& body : report.geometry->bodies) {
    if (!body.advice) continue;
    least = {std::min(least.r, body.radii.r), std::min(least.R, body.radii.R)};
    most = {std::max(most.r, body.radii.r), std::max(most.R, body.radii.R)};
    acceleration = std::max(acceleration, body.advice->acceleration);
  }
  if (most.R == 0) return "";
  return formatted("advised r from %.3f to %.3f mm, R from %.3f to %.3f m: shapes add at most %.3f m/s^2\n",
                   least.r * kMm, most.r * kMm, least.R, most.R, acceleration);
}

// The first three of some pairs by name, and how many more there are.
std::string named(const std::vector<const PairReport*>& pairs) {
  std::vector<std::string> names;
  for (const PairReport* pair : pairs) names.push_back(printable(pair->link1 + " - " + pair->link2));
  return detail::listed(names, names.size());
}

// The pairs for which parts were made that did not help.
std::string unsplit(const CollisionReport& report, bool anySplit) {
  std::vector<const PairReport*> left;
  for (const PairReport& pair : report.pairs)
    if (pair.checked && pair.colliding && pair.cause == kHullOnly) left.push_back(&pair);
  if (left.empty()) return anySplit ? "" : "No link needs to be split into parts\n";
  return "No parts clear the " +
         (left.size() == 1 ? "pair that collides by its hulls"
                           : counted(left.size(), "pair") + " that collide by their hulls") +
         " alone: " + named(left) + "\n";
}

// The links that are split, for which pairs, and what that costs.
std::string splits(const CollisionReport& report) {
  if (report.partsCost.rows == 0) return "";
  std::string text;
  const std::vector<Body>& bodies = report.geometry->bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].parts == 0) continue;
    double excess = 0;
    for (const Body& body : bodies)
      if (body.partOf == static_cast<int>(i)) excess = std::max(excess, body.excess);
    text += "  " + printable(bodies[i].name) +
            formatted(" in %d parts, %.3f mm from the mesh at most, for", bodies[i].parts, excess * kMm);
    std::vector<const PairReport*> own;
    for (const PairReport& pair : report.pairs) {
      const LinkPair& links = pair.links;
      const bool ofLink = links.link1 == bodies[i].link || (!links.obstacle && links.link2 == bodies[i].link);
      if (ofLink && report.isByParts(pair)) own.push_back(&pair);
    }
    text += (own.empty() ? "" : " ") + named(own) + "\n";
  }
  if (text.empty()) return unsplit(report, false);
  const std::string cost = formatted(
      "rows of a controller: %d with whole bodies, %.1f us a tick;\n  %d with parts, %.1f us;\n"
      "  %d with hand-over to parts below %g m, %d of these rows not constant there, %.1f us\n",
      report.wholeCost.rows, report.wholeCost.usPerTick, report.partsCost.rows, report.partsCost.usPerTick,
      report.handOverCost.rows, kHandOver, report.handOverCost.live, report.handOverCost.usPerTick);
  return "Split into convex parts:\n" + text + unsplit(report, true) + cost;
}

// The meshes' volumes beside those of their published polyhedra, those that differ most first.
std::string polyhedra(const CollisionReport& report, std::size_t top) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < report.polyhedra.size(); ++i)
    if (!report.polyhedra[i].file.empty()) order.push_back(i);
  if (order.empty()) return "";
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return report.polyhedra[i].difference > report.polyhedra[j].difference;
  });
  TextTable table("lrrr");
  table.add({"", "surfaces", "", "without"});
  table.add({"link", "[um]", "vertices", "a partner"});
  for (std::size_t k = 0; k < std::min(top, order.size()); ++k) {
    const PolyhedronReport& p = report.polyhedra[order[k]];
    table.add({report.geometry->bodies[order[k]].name, formatted("%.3f", p.difference * 1e6),
               formatted("%d, %4d", p.meshVertices, p.vertices), formatted("%d, %4d", p.meshAlone, p.alone)});
  }
  return "\n" + (order.size() == 1 ? "1 mesh has" : std::to_string(order.size()) + " meshes have") +
         " a published polyhedron\n" + table.text() + unshown(order.size(), top) +
         "two figures: the mesh's, the polyhedron's; surfaces: how far the two volumes are apart\n";
}

// The result for the trajectory, in a few lines.
std::string trajectory(const CollisionReport& report) {
  if (!report.trajectory) return "";
  const TrajectoryReport& t = *report.trajectory;
  const char* speed = t.trajectory.timed ? "m/s" : "m per way point";
  std::string text = "Trajectory " + t.path + ", " + std::to_string(t.trajectory.points.size()) +
                     " way points: " + trajectoryVerdict(report);
  if (t.verdict == MotionVerdict::contact) {
    text += ", at";
    for (const Eigen::Vector3d& p : t.stop.answer.points)
      text += " (" + fixed(p.x(), 6) + " " + fixed(p.y(), 6) + " " + fixed(p.z(), 6) + ")";
  }
  text += "\n";
  for (const TrajectoryStop& pair : t.undecided)
    if (t.verdict == MotionVerdict::contact || pair.pair != t.stop.pair)
      text += "not decided: " + printable(report.trajectoryPair(pair.pair)) +
              ", whose distance is the margin to rounding from " + t.timeText(pair.from, true) + " on\n";
  if (t.steepestPair >= 0)
    text += formatted("fastest approach of %zu samples %.4f %s, ", t.chartTime.size(), t.steepest, speed) +
            printable(report.trajectoryPair(t.steepestPair)) + " at " + t.timeText(t.steepestTime) + "\n";
  if (!t.closestProven) text += "some closest approaches are those that were found, without a proof\n";
  return text;
}

// Pairs that the SRDF leaves out although they collide, each with a configuration where it does.
std::string contradictions(const CollisionReport& report, std::size_t top) {
  std::string text;
  std::size_t count = 0;
  for (const PairReport& pair : report.pairs) {
    if (!pair.contradictsSrdf || count++ >= top) continue;
    const bool never = pair.reason == reasonText(PairReason::neverSampled) ||
                       pair.reason == reasonText(PairReason::neverProven);
    text += "\nThe SRDF leaves out " + printable(pair.link1 + " - " + pair.link2) + " as " +
            printable(pair.srdfReason) + "; found: " + pair.reason + (never ? " within the limits" : "") +
            (pair.cause.empty() ? "" : ", " + pair.cause) + formatted(", %.3f mm at", pair.minDistance * kMm);
    for (const auto& [joint, slope] : pair.gradient) {
      const auto& names = report.kinematics->names();
      const auto k = std::find(names.begin(), names.end(), joint) - names.begin();
      text += " " + printable(joint) + "=" + fixed(pair.closest[k], 4);
    }
  }
  return count == 0 ? "" : text + "\n" + unshown(count, top);
}

}  // namespace

std::string trajectoryVerdict(const CollisionReport& report) {
  const TrajectoryReport& t = *report.trajectory;
  if (t.verdict == MotionVerdict::free) return "proven free";
  const std::string pair = printable(report.trajectoryPair(t.stop.pair));
  const bool starts = t.stop.from <= t.trajectory.time.front();
  if (t.verdict == MotionVerdict::contact)
    return "CONTACT of " + pair + (starts ? " at the start" : " at " + t.timeText(t.stop.until));
  std::string why;
  if (!t.undecided.empty()) why = "the distance is the margin to rounding";
  if (t.followedUntil < t.trajectory.time.back()) {
    if (!why.empty()) why += "; from " + t.timeText(t.followedUntil, true) + " on ";
    why += "the way is so long that a proof takes too many distances; give way points between";
  }
  return "NOT DECIDED for " + pair +
         (starts ? " from the start on: " : " at " + t.timeText(t.stop.from, true) + ", free before: ") + why;
}

std::string toText(const CollisionReport& report, std::size_t top) {
  std::string text = printable(report.robot->name) + ": " + std::to_string(report.robot->links.size()) +
                     " links, " + std::to_string(report.geometry->bodies.size()) + " bodies, " +
                     std::to_string(report.kinematics->size()) + " coordinates\n";
  for (const std::string& shape : report.skipped)
    text += "LEFT OUT, NOT CHECKED: " + detail::printableLines(shape) + "\n";
  std::map<std::string, int> reasons;
  for (const PairReport& pair : report.pairs) ++reasons[pair.reason];
  text += counted(report.pairs.size(), "pair") + ":";
  for (const auto& [reason, count] : reasons) text += " " + std::to_string(count) + " " + reason + ",";
  text.back() = '\n';
  text += std::to_string(report.checked) + " checked, " + std::to_string(report.colliding) +
          " of them in collision";
  if (report.margin != 0) text += formatted(" (within %g mm)", report.margin * kMm);
  text += report.trajectory     ? " at their closest on the trajectory\n"
          : report.pose.empty() ? " in their closest configurations found\n"
                                : " in the posture " + report.pose + "\n";
  text += trajectory(report) + advised(report);
  for (const auto& [cause, count] : report.causes)
    text += "  " + counted(static_cast<std::size_t>(count), "pair") + ": " + cause + "\n";
  if (report.checked > 0)
    text += formatted("%.1f us for all checked pairs with gradients, %.0f ns a pair\n", report.usPerTick,
                      report.nsPerPair);
  text += splits(report);
  text += pairsText(report, top);
  return text + fits(report, top) + polyhedra(report, top) + contradictions(report, top);
}

}  // namespace fcl_stpbv::report
