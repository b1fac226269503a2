// What urdf_collision_report finds:
// 1. the pair list with its reasons (robot/pair_list.h);
// 2. each checked pair in the given posture or its closest one: distances of volumes, hulls and meshes,
//    gradient;
// 3. how far the links' volumes exceed their meshes, and what each collision comes from.
#include "fcl_stpbv/report/collision_report.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/report/named_posture.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/report_warnings.h"
#include "fcl_stpbv/report/tick_time.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Postures {
  Eigen::VectorXd neutral;
  std::optional<Eigen::VectorXd> asked;  // none: each pair is reported in its closest configuration
};

// Both are read before a volume is built, so that a mistake in them is told at once.
Postures readPostures(const ReportRequest& request, const Kinematics& kinematics, const Srdf* srdf) {
  Postures postures{kinematics.neutral(), std::nullopt};
  if (!request.pose.empty()) postures.asked = namedPosture("--pose", request.pose, kinematics, srdf);
  if (!request.neutral.empty())
    postures.neutral = namedPosture("--neutral", request.neutral, kinematics, srdf);
  return postures;
}

Postures load(const ReportRequest& request, RobotLoader& loader, CollisionReport& report) {
  Postures postures;
  loader.read();
  std::vector<std::string>& errors = loader.faults().errors;
  if (errors.empty())
    LoadFaults::gather(errors,
                       [&] { postures = readPostures(request, *loader.kinematics(), loader.srdf().get()); });
  loader.build();
  report.robot = loader.robot();
  report.kinematics = loader.kinematics();
  report.geometry = loader.geometry();
  report.obstacles = loader.obstacles();
  report.skipped = loader.skipped();
  report.warnings = loader.warnings();
  report.pose = request.pose;
  if (!request.polyhedra.empty()) report.polyhedra = comparePolyhedra(*report.geometry, request.polyhedra);
  return postures;
}

// What the search and the SRDF say about a pair.
PairReport said(const PairEntry& entry, const CollisionReport& report, const Srdf* srdf) {
  PairReport pair;
  pair.link1 = report.robot->links[at(entry.link1)].name;
  pair.obstacle = entry.obstacle;
  pair.link2 =
      entry.obstacle ? report.obstacles[at(entry.link2)].name : report.robot->links[at(entry.link2)].name;
  pair.reason = reasonText(entry.reason);
  if (srdf && !entry.obstacle) pair.srdfReason = srdf->reasonToSkip(pair.link1, pair.link2);
  pair.checked = entry.obstacle || (srdf ? pair.srdfReason.empty() : checkedWithoutSrdf(entry.reason));
  const bool explained = entry.reason == PairReason::adjacent || entry.reason == PairReason::rigid ||
                         entry.reason == PairReason::neverSampled || entry.reason == PairReason::neverProven;
  pair.contradictsSrdf = (pair.srdfReason == "Never" || pair.srdfReason == "Adjacent") && !explained;
  pair.minDistance = entry.minDistance;
  pair.probabilityBound = entry.probabilityBound();
  pair.security = entry.security;
  pair.influence = entry.influence;
  pair.closest = entry.closest;
  return pair;
}

// Where the volumes meet, or come closer than what they exceed their hulls by: farther apart the volumes'
// distance says enough. A contradiction is explained where it was found.
void explain(const std::vector<CheckedPair>& bodies, double margin, PairCauses& causes, PairReport& pair) {
  if (pair.answer.distance <= std::max(margin, pair.overCover1 + pair.overCover2)) {
    const PairCause found = causes.explain(bodies, pair.configuration, margin);
    pair.meshDistance = found.meshDistance;
    pair.cause = found.cause;
  }
  if (pair.cause.empty() && pair.contradictsSrdf)
    pair.cause = causes.explain(bodies, pair.closest, margin).cause;
}

void summarise(CollisionReport& report) {
  std::stable_sort(report.pairs.begin(), report.pairs.end(), [](const PairReport& a, const PairReport& b) {
    return a.checked != b.checked ? a.checked : a.answer.distance < b.answer.distance;
  });
  report.minDistance = std::numeric_limits<double>::infinity();
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked) continue;
    ++report.checked;
    report.colliding += pair.colliding;
    if (pair.colliding) ++report.causes[pair.cause];
    report.minDistance = std::min(report.minDistance, pair.answer.distance);
  }
}

}  // namespace

CollisionReport makeReport(const ReportRequest& request) {
  CollisionReport report;
  RobotLoader loader(request.files);
  const Postures postures = load(request, loader, report);
  const Srdf* srdf = loader.srdf().get();

  PairListOptions search = request.search;
  search.obstacles = report.obstacles;
  search.neutral = postures.neutral;
  report.list = pairList(report.kinematics, report.geometry, srdf, search);

  PairCauses causes(report.kinematics, report.geometry, report.obstacles, loader.sceneGeometry());
  for (const Body& body : report.geometry->bodies) report.fits.push_back(meshFit(body, causes.exact(body)));
  for (const PairEntry& entry : report.list) {
    PairReport pair = said(entry, report, srdf);
    pair.configuration = postures.asked.value_or(entry.closest);
    const std::vector<CheckedPair> bodies = bodiesOf(*report.geometry, entry);
    measurePair(report, bodies, pair);
    if (pair.answer.status == DistanceStatus::invalid)  // no answer is not clear
      throw Error(report.robot->path + ": the distance of " + pair.link1 + " and " + pair.link2 +
                  " cannot be computed; look for numbers out of all proportion");
    pair.colliding = pair.answer.distance <= search.margin;
    explain(bodies, search.margin, causes, pair);
    report.pairs.push_back(std::move(pair));
  }
  summarise(report);
  requirePairs(at(report.checked), *report.robot, countsOf(report.list));

  report.neutral =
      judgeNeutral(report.kinematics, report.geometry, report.list, postures.neutral, srdf, search.margin);
  const std::vector<std::string> warnings = reportWarnings(report, request.neutral, causes);
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  const double tick = tickTime(report, postures.asked.value_or(report.kinematics->neutral()), search.threads);
  report.usPerTick = tick * 1e6;
  report.nsPerPair = tick * 1e9 / report.checked;
  return report;
}

}  // namespace fcl_stpbv::report
