// A collision report as text, JSON, CSV and SRDF.
#include "fcl_stpbv/report/report_formats.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/report/formatted.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

constexpr double kMm = 1e3;

std::string steepest(const PairReport& pair) {
  const auto top =
      std::max_element(pair.gradient.begin(), pair.gradient.end(),
                       [](const auto& a, const auto& b) { return std::abs(a.second) < std::abs(b.second); });
  return top == pair.gradient.end() ? "" : formatted("%+.3f ", top->second) + top->first;
}

nlohmann::json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json joints(const Eigen::VectorXd& q, const Kinematics& kinematics) {
  nlohmann::json json = nlohmann::json::object();
  for (int i = 0; i < kinematics.size(); ++i) json[kinematics.names()[static_cast<std::size_t>(i)]] = q[i];
  return json;
}

nlohmann::json orNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

const char* statusName(DistanceStatus status) {
  switch (status) {
    case DistanceStatus::exact:
      return "exact";
    case DistanceStatus::local:
      return "local";
    case DistanceStatus::bounded:
      return "bounded";
    default:
      return "invalid";
  }
}

// What a list cut after `top` lines ends with.
std::string unshown(std::size_t all, std::size_t top) {
  return all > top ? "... and " + std::to_string(all - top) + " more (--top)\n" : "";
}

// How far hulls and volumes exceed meshes, worst first.
std::string fits(const CollisionReport& report, std::size_t top) {
  std::vector<std::size_t> order(report.fits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return report.fits[i].volumeExcess > report.fits[j].volumeExcess;
  });
  const std::string rest = unshown(order.size(), top);
  if (order.size() > top) order.resize(top);
  std::string text = formatted("\n%-44s %11s %13s %9s %8s %8s\n", "link", "hull [mm]", "volume [mm]", "ratio",
                               "r [mm]", "R [m]");
  for (const std::size_t i : order) {
    const MeshFit& fit = report.fits[i];
    const Body& body = report.geometry->bodies[i];
    text +=
        formatted("%-44s %11.3f %13.3f ", body.name.c_str(), fit.hullExcess * kMm, fit.volumeExcess * kMm) +
        (std::isfinite(fit.volumeRatio) ? formatted("%9.3f", fit.volumeRatio) : formatted("%9s", "-")) +
        (body.volume ? formatted(" %8.3f %8.3f\n", body.volume->radii().r * kMm, body.volume->radii().R)
                     : formatted(" %8s %8s\n", "-", "-"));
  }
  return text + rest +
         "hull, volume: at most so far are their surfaces from the mesh; ratio: the volume's to the mesh's\n";
}

bool isByParts(const CollisionReport& report, const PairReport& pair) {
  return report.geometry->byParts.count(pair.links) > 0;
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
    text += "  " + bodies[i].name +
            formatted(" in %d parts, %.3f mm from the mesh at most, for", bodies[i].parts, excess * kMm);
    int count = 0;
    for (const PairReport& pair : report.pairs) {
      const LinkPair& links = pair.links;
      const bool own = links.link1 == bodies[i].link || (!links.obstacle && links.link2 == bodies[i].link);
      if (!own || !isByParts(report, pair)) continue;
      if (++count <= 3) text += (count > 1 ? ", " : " ") + pair.link1 + " - " + pair.link2;
    }
    text += (count > 3 ? " and " + std::to_string(count - 3) + " more pairs\n" : "\n");
  }
  const std::string cost = formatted(
      "rows %d, %.1f us a tick with whole bodies; %d, %.1f us with parts; %d of %d not constant, "
      "%.1f us where whole bodies hand over to parts at %g m\n",
      report.wholeCost.rows, report.wholeCost.usPerTick, report.partsCost.rows, report.partsCost.usPerTick,
      report.handOverCost.live, report.handOverCost.rows, report.handOverCost.usPerTick, kHandOver);
  return (text.empty() ? "No link needs to be split into parts\n" : "Split into convex parts:\n" + text) +
         cost;
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
  std::string text = formatted("\n%zu meshes have a published polyhedron\n%-44s %14s %11s %21s\n",
                               order.size(), "link", "surfaces [um]", "vertices", "without a partner");
  for (std::size_t k = 0; k < std::min(top, order.size()); ++k) {
    const std::size_t i = order[k];
    const PolyhedronReport& p = report.polyhedra[i];
    text += formatted("%-44s %14.3f %5d, %4d %15d, %4d\n", report.geometry->bodies[i].name.c_str(),
                      p.difference * 1e6, p.meshVertices, p.vertices, p.meshAlone, p.alone);
  }
  return text + unshown(order.size(), top) +
         "two figures: the mesh's, the polyhedron's; surfaces: how far the two volumes are apart\n";
}

std::string nameOf(const CollisionReport& report, int pair) {
  const auto& [first, second] = report.trajectoryPairs[static_cast<std::size_t>(pair)];
  return first + " - " + second;
}

// What became of the trajectory, in a few lines.
std::string trajectory(const CollisionReport& report) {
  if (!report.trajectory) return "";
  const TrajectoryReport& t = *report.trajectory;
  const char* unit = t.trajectory.timed ? " s" : "";
  const char* speed = t.trajectory.timed ? "m/s" : "m a way point";
  std::string text =
      "Trajectory " + t.path + ", " + std::to_string(t.trajectory.points.size()) + " way points: ";
  if (t.verdict == MotionVerdict::free) {
    text += "proven free\n";
  } else if (t.verdict == MotionVerdict::contact) {
    text += "CONTACT of " + nameOf(report, t.pair) +
            formatted(" between %.9g and %.9g%s, at", t.from, t.until, unit);
    for (const Eigen::Vector3d& p : t.contact.points)
      text += formatted(" (%.6f %.6f %.6f)", p.x(), p.y(), p.z());
    text += "\n";
  } else {
    text += "NOT DECIDED for " + nameOf(report, t.pair) +
            formatted(" at %.9g%s, free before: the distance is the margin to rounding\n", t.from, unit);
  }
  if (t.steepestPair >= 0)
    text += formatted("fastest approach %.4f %s, ", t.steepest, speed) + nameOf(report, t.steepestPair) +
            formatted(" at %.4g%s\n", t.steepestTime, unit);
  if (!t.closestProven) text += "some closest approaches are those that were found, without a proof\n";
  return text;
}

nlohmann::json trajectoryJson(const CollisionReport& report) {
  if (!report.trajectory) return {};
  const TrajectoryReport& t = *report.trajectory;
  const char* const verdicts[] = {"free", "contact", "undecided"};
  nlohmann::json json{{"file", t.path},
                      {"way_points", t.trajectory.points.size()},
                      {"timed", t.trajectory.timed},
                      {"verdict", verdicts[static_cast<int>(t.verdict)]},
                      {"free_until", t.from},
                      {"closest_proven", t.closestProven},
                      {"closest_precision", TrajectoryReport::kPrecision},
                      {"steepest_approach", t.steepest},
                      {"steepest_time", t.steepestTime},
                      {"chart", {{"time", t.chartTime}, {"distance", t.chartDistance}}}};
  if (t.steepestPair >= 0) json["steepest_pair"] = nameOf(report, t.steepestPair);
  if (t.verdict != MotionVerdict::free) {
    const auto& [first, second] = report.trajectoryPairs[static_cast<std::size_t>(t.pair)];
    json["contact"] = {{"time", t.until},
                       {"link1", first},
                       {"link2", second},
                       {"point1", numbers(t.contact.points[0])},
                       {"point2", numbers(t.contact.points[1])}};
  }
  return json;
}

// Pairs that the SRDF leaves out and that collide, each with where.
std::string contradictions(const CollisionReport& report, std::size_t top) {
  std::string text;
  std::size_t count = 0;
  for (const PairReport& pair : report.pairs) {
    if (!pair.contradictsSrdf || count++ >= top) continue;
    text += "\nThe SRDF leaves out " + pair.link1 + " - " + pair.link2 + " as " + pair.srdfReason +
            "; found: " + pair.reason + (pair.cause.empty() ? "" : ", " + pair.cause) +
            formatted(", %.3f mm at", pair.minDistance * kMm);
    for (const auto& [joint, slope] : pair.gradient) {
      const auto& names = report.kinematics->names();
      const auto k = std::find(names.begin(), names.end(), joint) - names.begin();
      text += " " + joint + formatted("=%.4f", pair.closest[k]);
    }
  }
  return count == 0 ? "" : text + "\n" + unshown(count, top);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string toText(const CollisionReport& report, std::size_t top) {
  std::string text = report.robot->name + ": " + std::to_string(report.robot->links.size()) + " links, " +
                     std::to_string(report.geometry->bodies.size()) + " bodies, " +
                     std::to_string(report.kinematics->size()) + " coordinates\n";
  for (const std::string& shape : report.skipped) text += "LEFT OUT, NOT CHECKED: " + shape + "\n";
  std::map<std::string, int> reasons;
  for (const PairReport& pair : report.pairs) ++reasons[pair.reason];
  text += std::to_string(report.pairs.size()) + " pairs:";
  for (const auto& [reason, count] : reasons) text += " " + std::to_string(count) + " " + reason + ",";
  text.back() = '\n';
  text += std::to_string(report.checked) + " checked, " + std::to_string(report.colliding) +
          " of them in collision";
  text += report.trajectory     ? " at their closest on the trajectory\n"
          : report.pose.empty() ? " in their closest configurations found\n"
                                : " in the posture " + report.pose + "\n";
  text += trajectory(report);
  for (const auto& [cause, count] : report.causes) text += "  " + std::to_string(count) + " " + cause + "\n";
  if (report.checked > 0)
    text += formatted("%.1f us for all checked pairs with gradients, %.0f ns a pair\n", report.usPerTick,
                      report.nsPerPair);
  text += splits(report);
  text += formatted("\n%-44s %11s %11s %11s %-26s %s\n", "pair", "STP-BV [mm]", "hulls [mm]", "cover [mm]",
                    "reason", "steepest joint [m/rad]");
  std::size_t shown = 0;
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked || shown++ >= top) break;
    const std::string hull =
        std::isfinite(pair.hullDistance) ? formatted("%.3f", pair.hullDistance * kMm) : "-";
    text += formatted("%-44s %11.3f %11s %11.3f %-26s ", (pair.link1 + " - " + pair.link2).c_str(),
                      pair.answer.distance * kMm, hull.c_str(), (pair.overCover1 + pair.overCover2) * kMm,
                      pair.reason.c_str()) +
            steepest(pair) + "\n";
  }
  text += unshown(static_cast<std::size_t>(report.checked), top);
  text += "\ncover: how much closer the two smooth surfaces are than their hulls, along the normal\n";
  return text + fits(report, top) + polyhedra(report, top) + contradictions(report, top);
}

std::string toJson(const CollisionReport& report) {
  nlohmann::json json;
  json["robot"] = report.robot->name;
  json["pose"] = report.pose.empty() ? nlohmann::json() : nlohmann::json(report.pose);
  json["neutral"] = {{"colliding", report.neutral.colliding}};
  if (report.neutral.better.size() > 0)
    json["neutral"].update({{"better", joints(report.neutral.better, *report.kinematics)},
                            {"better_state", report.neutral.state},
                            {"better_colliding", report.neutral.collidingThere}});
  json["trajectory"] = trajectoryJson(report);
  json["warnings"] = report.warnings;
  json["skipped"] = report.skipped;
  json["links"] = nlohmann::json::array();
  for (std::size_t i = 0; i < report.geometry->bodies.size(); ++i) {
    const Body& body = report.geometry->bodies[i];
    nlohmann::json link{{"name", body.name}, {"file", body.file}};
    if (body.volume) {
      link["vertices"] = body.volume->vertexCount();
      link["vertices_unreduced"] = (body.full ? body.full : body.volume)->vertexCount();
      link["r"] = body.volume->radii().r;
      link["R"] = body.volume->radii().R;
      link["over_cover_max"] = body.cover.max;
      link["over_cover_mean"] = body.cover.mean;
    }
    if (body.parts > 0) link["parts"] = body.parts;
    if (body.partOf >= 0) {
      link["part_of"] = report.geometry->bodies[static_cast<std::size_t>(body.partOf)].name;
      link["excess_max"] = body.excess;
    }
    if (i < report.fits.size()) {
      link["hull_excess"] = report.fits[i].hullExcess;
      link["volume_excess"] = report.fits[i].volumeExcess;
      link["volume_ratio"] = orNull(report.fits[i].volumeRatio);
    }
    if (i < report.polyhedra.size() && !report.polyhedra[i].file.empty()) {
      const PolyhedronReport& p = report.polyhedra[i];
      link["polyhedron"] = {{"file", p.file},
                            {"vertices", p.vertices},
                            {"without_partner", p.alone},
                            {"mesh_without_partner", p.meshAlone},
                            {"surface_difference", p.difference}};
    }
    json["links"].push_back(link);
  }
  json["pairs"] = nlohmann::json::array();
  for (const PairReport& pair : report.pairs) {
    json["pairs"].push_back({{"link1", pair.link1},
                             {"link2", pair.link2},
                             {"obstacle", pair.links.obstacle},
                             {"reason", pair.reason},
                             {"srdf_reason", pair.srdfReason},
                             {"checked", pair.checked},
                             {"distance", orNull(pair.answer.distance)},
                             {"status", statusName(pair.answer.status)},
                             {"continuous", pair.answer.continuous},
                             {"point1", numbers(pair.answer.points[0])},
                             {"point2", numbers(pair.answer.points[1])},
                             {"normal", numbers(pair.answer.normal)},
                             {"gradient", pair.gradient},
                             {"over_cover1", pair.overCover1},
                             {"over_cover2", pair.overCover2},
                             {"hull_distance", orNull(pair.hullDistance)},
                             {"mesh_distance_most", orNull(pair.meshDistanceMost)},
                             {"mesh_distance", orNull(pair.meshDistance)},
                             {"by_parts", isByParts(report, pair)},
                             {"cause", pair.cause},
                             {"lipschitz", orNull(pair.lipschitz)},
                             {"time", orNull(pair.time)},
                             {"min_distance", orNull(pair.minDistance)},
                             {"closest", joints(pair.closest, *report.kinematics)},
                             {"probability_bound", pair.probabilityBound},
                             {"security_distance", pair.security},
                             {"influence_distance", pair.influence}});
  }
  json["summary"] = {{"pairs_total", report.pairs.size()},
                     {"checked", report.checked},
                     {"disabled", static_cast<int>(report.pairs.size()) - report.checked},
                     {"min_distance", orNull(report.minDistance)},
                     {"colliding", report.colliding},
                     {"causes", report.causes},
                     {"ns_per_pair", report.nsPerPair},
                     {"us_per_tick", report.usPerTick}};
  if (report.partsCost.rows > 0)
    json["summary"]["rows"] = {{"whole", report.wholeCost.rows},
                               {"whole_us_per_tick", report.wholeCost.usPerTick},
                               {"parts", report.partsCost.rows},
                               {"parts_us_per_tick", report.partsCost.usPerTick},
                               {"hand_over", report.handOverCost.rows},
                               {"hand_over_live", report.handOverCost.live},
                               {"hand_over_us_per_tick", report.handOverCost.usPerTick}};
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string toCsv(const CollisionReport& report) {
  std::string text =
      "link1,link2,reason,srdf_reason,checked,cause,distance,mesh_distance,hull_distance,over_cover1,over_"
      "cover2,min_distance,"
      "point1_x,point1_y,point1_z,point2_x,point2_y,point2_z,normal_x,normal_y,normal_z\n";
  for (const std::string& shape : report.skipped) text += "," + quoted("left out: " + shape) + ",0\n";
  for (const PairReport& pair : report.pairs) {
    text += quoted(pair.link1) + "," + quoted(pair.link2) + "," + quoted(pair.reason) + "," +
            quoted(pair.srdfReason) + "," + (pair.checked ? "1" : "0") + "," + pair.cause;
    for (double value : {pair.answer.distance, pair.meshDistance, pair.hullDistance, pair.overCover1,
                         pair.overCover2, pair.minDistance})
      text += "," + (std::isfinite(value) ? toDecimal(value) : std::string());
    for (const Eigen::Vector3d& v : {pair.answer.points[0], pair.answer.points[1], pair.answer.normal})
      for (int i = 0; i < 3; ++i) text += "," + toDecimal(v[i]);
    text += "\n";
  }
  return text;
}

std::string toSrdfText(const CollisionReport& report, const std::string& path, bool defaultToo) {
  std::vector<std::string> comments;
  comments.reserve(report.skipped.size());
  for (const std::string& skipped : report.skipped) comments.push_back("Left out, not checked: " + skipped);
  return withPairs(path, report.robot->name, toSrdf(*report.robot, report.list, defaultToo), comments);
}

}  // namespace fcl_stpbv::report
