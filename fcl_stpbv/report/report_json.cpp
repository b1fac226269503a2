// A collision report as JSON: links, pairs, trajectory, summary. Numbers that are not finite become null.
#include <nlohmann/json.hpp>

#include "fcl_stpbv/report/along_trajectory.h"
#include "fcl_stpbv/report/json_values.h"
#include "fcl_stpbv/report/report_formats.h"

namespace fcl_stpbv::report {
namespace {

nlohmann::json trajectoryJson(const CollisionReport& report) {
  if (!report.trajectory) return {};
  const TrajectoryReport& t = *report.trajectory;
  nlohmann::json json{{"file", t.path},
                      {"way_points", t.trajectory.points.size()},
                      {"timed", t.trajectory.timed},
                      {"verdict", toString(t.verdict)},
                      {"free_until", t.undecided.empty() ? t.stop.from : t.undecided.front().from},
                      {"followed_until", t.followedUntil},
                      {"closest_proven", t.closestProven},
                      {"closest_precision", TrajectoryReport::kPrecision},
                      {"steepest_approach", t.steepest},
                      {"chart", {{"time", t.chartTime}, {"distance", t.chartDistance}}}};
  json["steepest_pair"] = json["steepest_time"] = json["contact"] = nullptr;
  if (t.steepestPair >= 0) {
    json["steepest_pair"] = report.trajectoryPair(t.steepestPair);
    json["steepest_time"] = t.steepestTime;
  }
  if (t.verdict != MotionVerdict::free) {
    const auto [first, second] =
        report.namesOf(report.trajectoryPairs[static_cast<std::size_t>(t.stop.pair)]);
    json["contact"] = {{"time", t.stop.until},
                       {"link1", first},
                       {"link2", second},
                       {"point1", numbers(t.stop.answer.points[0])},
                       {"point2", numbers(t.stop.answer.points[1])}};
  }
  json["undecided"] = nlohmann::json::array();
  for (const TrajectoryStop& pair : t.undecided) {
    const auto [first, second] = report.namesOf(report.trajectoryPairs[static_cast<std::size_t>(pair.pair)]);
    json["undecided"].push_back({{"time", pair.from}, {"link1", first}, {"link2", second}});
  }
  return json;
}

// A value that there is only under some condition, else null.
template <class Make>
nlohmann::json onlyIf(bool known, const Make& make) {
  return known ? nlohmann::json(make()) : nlohmann::json();
}

nlohmann::json polyhedronJson(const PolyhedronReport& p) {
  return {{"file", p.file},
          {"vertices", p.vertices},
          {"without_partner", p.alone},
          {"mesh_without_partner", p.meshAlone},
          {"surface_difference", p.difference}};
}

nlohmann::json linkJson(const CollisionReport& report, std::size_t i) {
  const Body& body = report.geometry->bodies[i];
  const StpBv* const volume = body.volume.get();
  const RadiiAdvice* const advice = volume && body.advice ? &*body.advice : nullptr;
  const MeshFit* const fit = i < report.fits.size() ? &report.fits[i] : nullptr;
  const PolyhedronReport* const polyhedron =
      i < report.polyhedra.size() && !report.polyhedra[i].file.empty() ? &report.polyhedra[i] : nullptr;
  nlohmann::json link{
      {"name", body.name},
      {"file", body.file},
      {"vertices", onlyIf(volume, [&] { return volume->vertexCount(); })},
      {"vertices_unreduced",
       onlyIf(volume, [&] { return (body.isReduced() ? body.full->volume() : *volume).vertexCount(); })},
      {"r", onlyIf(volume, [&] { return volume->radii().r; })},
      {"R", onlyIf(volume, [&] { return volume->radii().R; })},
      {"advised_acceleration", onlyIf(advice, [&] { return advice->acceleration; })},
      {"advised_least_clearance", onlyIf(advice, [&] { return orNull(advice->leastClearance); })},
      {"over_cover_max", onlyIf(volume, [&] { return body.cover.max; })},
      {"over_cover_mean", onlyIf(volume, [&] { return body.cover.mean; })},
      {"hull_excess", onlyIf(fit, [&] { return fit->hullExcess; })},
      {"volume_excess", onlyIf(fit, [&] { return fit->volumeExcess; })},
      {"volume_ratio", onlyIf(fit, [&] { return orNull(fit->volumeRatio); })},
      {"polyhedron", onlyIf(polyhedron, [&] { return polyhedronJson(*polyhedron); })}};
  if (body.parts > 0) link["parts"] = body.parts;
  if (body.partOf >= 0) {
    link["part_of"] = report.geometry->bodies[static_cast<std::size_t>(body.partOf)].name;
    link["excess_max"] = body.excess;
  }
  return link;
}

nlohmann::json pairJson(const CollisionReport& report, const PairReport& pair) {
  return {{"link1", pair.link1},
          {"link2", pair.link2},
          {"obstacle", pair.links.obstacle},
          {"reason", pair.reason},
          {"srdf_reason", pair.srdfReason},
          {"checked", pair.checked},
          {"distance", orNull(pair.answer.distance)},
          {"status", toString(pair.answer.status)},
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
          {"by_parts", report.isByParts(pair)},
          {"cause", pair.cause},
          {"lipschitz", orNull(pair.lipschitz)},
          {"time", orNull(pair.time)},
          {"verdict", orNull(verdictAlong(report, pair))},
          {"min_distance", orNull(pair.minDistance)},
          {"closest", byName(pair.closest, *report.kinematics)},
          {"probability_bound", pair.probabilityBound},
          {"security_distance", pair.security},
          {"influence_distance", pair.influence}};
}

}  // namespace

std::string toJson(const CollisionReport& report) {
  nlohmann::json json;
  json["robot"] = report.robot->name;
  json["pose"] = orNull(report.pose);
  json["neutral"] = {{"colliding", report.neutral.colliding}};
  if (report.neutral.better.size() > 0)
    json["neutral"].update({{"better", byName(report.neutral.better, *report.kinematics)},
                            {"better_state", report.neutral.state},
                            {"better_colliding", report.neutral.collidingThere}});
  json["trajectory"] = trajectoryJson(report);
  json["warnings"] = report.warnings;
  json["skipped"] = report.skipped;
  json["links"] = nlohmann::json::array();
  for (std::size_t i = 0; i < report.geometry->bodies.size(); ++i)
    json["links"].push_back(linkJson(report, i));
  json["pairs"] = nlohmann::json::array();
  for (const PairReport& pair : report.pairs) json["pairs"].push_back(pairJson(report, pair));
  json["summary"] = {{"pairs_total", report.pairs.size()},
                     {"checked", report.checked},
                     {"disabled", static_cast<int>(report.pairs.size()) - report.checked},
                     {"min_distance", orNull(report.minDistance)},
                     {"margin", report.margin},
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

}  // namespace fcl_stpbv::report
