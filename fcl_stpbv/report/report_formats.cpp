// A collision report as CSV and SRDF.
#include "fcl_stpbv/report/report_formats.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/report/along_trajectory.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

std::string cellOf(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// Whether shapes of the robot itself were left out, not only shapes of the scene.
bool lacksShapes(const CollisionReport& report) {
  return std::any_of(report.skipped.begin(), report.skipped.end(),
                     [&](const std::string& shape) { return shape.find(report.robot->path) == 0; });
}

// The pairs that need no check. Pairs that did not collide without some of the shapes are not among them.
std::vector<Srdf::Pair> leftOut(const CollisionReport& report, bool defaultToo) {
  std::vector<PairEntry> list = report.list;
  if (lacksShapes(report))
    list.erase(std::remove_if(list.begin(), list.end(),
                              [](const PairEntry& entry) {
                                return entry.reason == PairReason::neverSampled ||
                                       entry.reason == PairReason::neverProven;
                              }),
               list.end());
  return toSrdf(*report.robot, list, defaultToo);
}

}  // namespace

std::string toCsv(const CollisionReport& report) {
  std::string text =
      "link1,link2,reason,srdf_reason,checked,cause,distance,mesh_distance,hull_distance,over_cover1,over_"
      "cover2,min_distance,"
      "point1_x,point1_y,point1_z,point2_x,point2_y,point2_z,normal_x,normal_y,normal_z";
  text += report.trajectory ? ",time,verdict\n" : "\n";
  const std::string rest(report.trajectory ? 18 : 16, ',');
  if (report.trajectory)
    text += ",," + cellOf("trajectory: " + trajectoryVerdict(report)) + ",,0" + rest + "\n";
  for (const std::string& shape : report.skipped)
    text += ",," + cellOf("left out: " + shape) + ",,0" + rest + "\n";
  for (const PairReport& pair : report.pairs) {
    text += cellOf(pair.link1) + "," + cellOf(pair.link2) + "," + cellOf(pair.reason) + "," +
            cellOf(pair.srdfReason) + "," + (pair.checked ? "1" : "0") + "," + pair.cause;
    for (double value : {pair.answer.distance, pair.meshDistance, pair.hullDistance, pair.overCover1,
                         pair.overCover2, pair.minDistance})
      text += "," + (std::isfinite(value) ? toDecimal(value) : std::string());
    for (const Eigen::Vector3d& v : {pair.answer.points[0], pair.answer.points[1], pair.answer.normal})
      for (int i = 0; i < 3; ++i) text += "," + toDecimal(v[i]);
    if (report.trajectory)
      text += "," + (std::isfinite(pair.time) ? toDecimal(pair.time) : std::string()) + "," +
              verdictAlong(report, pair);
    text += "\n";
  }
  return text;
}

std::string toSrdfText(const CollisionReport& report, bool defaultToo) {
  std::vector<std::string> comments;
  comments.reserve(report.skipped.size());
  for (const std::string& skipped : report.skipped) comments.push_back("Left out, not checked: " + skipped);
  if (lacksShapes(report))
    comments.emplace_back("So pairs that did not collide without these shapes are left to be checked.");
  return withPairs(report.srdf.get(), report.robot->name, leftOut(report, defaultToo), comments);
}

std::string srdfChange(const CollisionReport& report, bool defaultToo) {
  Srdf after = report.srdf ? *report.srdf : Srdf{};
  const auto isFound = [](const Srdf::Pair& pair) { return pair.reason != "User"; };
  after.disabled.erase(std::remove_if(after.disabled.begin(), after.disabled.end(), isFound),
                       after.disabled.end());
  for (const Srdf::Pair& pair : leftOut(report, defaultToo)) after.disabled.push_back(pair);
  const SkipReasons before(report.srdf.get()), now(&after);
  std::size_t pairs = 0, leftOutBefore = 0, leftOutNow = 0;
  for (const PairReport& pair : report.pairs) {
    if (pair.links.obstacle) continue;
    ++pairs;
    leftOutBefore += !before.of(pair.link1, pair.link2).empty();
    leftOutNow += !now.of(pair.link1, pair.link2).empty();
  }
  return (report.srdf ? std::to_string(leftOutBefore) + " of " + counted(pairs, "pair") + " left out before, "
                      : "") +
         std::to_string(leftOutNow) + (report.srdf ? " now" : " of " + counted(pairs, "pair") + " left out");
}

}  // namespace fcl_stpbv::report
