// What urdf_collision_report finds:
// 1. the pair list with its reasons (robot/pair_list.h);
// 2. each checked pair in the given posture or its closest one: distances of
//    volumes, hulls and meshes, gradient;
// 3. with --parts, both again, with those links split that need it (robot/detail_choice.h);
// 4. how far the links' volumes exceed their meshes, and what each collision comes from.
#include "fcl_stpbv/report/collision_report.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/along_trajectory.h"
#include "fcl_stpbv/report/asked_postures.h"
#include "fcl_stpbv/report/kept_list.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/report_warnings.h"
#include "fcl_stpbv/report/tick_time.h"
#include "fcl_stpbv/robot/detail_choice.h"
#include "fcl_stpbv/robot/pair_list_again.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

AskedPostures load(const ReportRequest& request, RobotLoader& loader, CollisionReport& report) {
  AskedPostures postures;
  loader.read();
  std::vector<std::string>& errors = loader.faults().errors;
  if (errors.empty())
    LoadFaults::gather(errors,
                       [&] { postures = readPostures(request, *loader.kinematics(), loader.srdf().get()); });
  loader.build();
  report.robot = loader.robot();
  report.kinematics = loader.kinematics();
  report.srdf = loader.srdf();
  report.geometry = loader.geometry();
  report.obstacles = loader.obstacles();
  report.meshFiles = loader.meshFiles();
  report.skipped = loader.skipped();
  report.warnings = loader.warnings();
  report.warnings.insert(report.warnings.end(), postures.warnings.begin(), postures.warnings.end());
  report.pose = request.pose;
  return postures;
}

// `srdf` is null if there is none.
bool isChecked(const PairEntry& entry, const CollisionReport& report, const SkipReasons* srdf) {
  if (entry.obstacle || !srdf) return entry.obstacle || checkedWithoutSrdf(entry.reason);
  const auto& links = report.robot->links;
  return srdf->of(links[at(entry.link1)].name, links[at(entry.link2)].name).empty();
}

// What the search and the SRDF say about a pair.
PairReport said(const PairEntry& entry, const CollisionReport& report, const SkipReasons* srdf) {
  PairReport pair;
  pair.links = entry;
  std::tie(pair.link1, pair.link2) = report.namesOf(entry);
  pair.reason = reasonText(entry.reason);
  if (srdf && !entry.obstacle) pair.srdfReason = srdf->of(pair.link1, pair.link2);
  pair.checked = isChecked(entry, report, srdf);
  pair.minDistance = entry.minDistance;
  pair.probabilityBound = entry.probabilityBound();
  pair.security = entry.security;
  pair.influence = entry.influence;
  pair.closest = entry.closest;
  return pair;
}

bool isWithinLimits(const Eigen::VectorXd& q, const Kinematics& kinematics) {
  return (kinematics.lower().array() <= q.array() && q.array() <= kinematics.upper().array()).all();
}

// Whether the SRDF leaves out as never or adjacent what collides, by the search or in the configuration of
// the measured `pair`.
bool contradictsSrdf(PairReason reason, const PairReport& pair) {
  if (pair.srdfReason != "Never" && pair.srdfReason != "Adjacent") return false;
  if (reason == PairReason::adjacent || reason == PairReason::rigid) return false;
  const bool never = reason == PairReason::neverSampled || reason == PairReason::neverProven;
  return pair.colliding || !never;
}

// Compares what was said with the distance that is measured now. A posture or a motion may show a collision
// that the search missed.
void judge(double margin, const Kinematics& kinematics, PairEntry& entry, PairReport& pair) {
  pair.colliding |= pair.answer.distance <= margin;
  if (pair.answer.distance < pair.minDistance) {
    pair.minDistance = pair.answer.distance;
    pair.closest = pair.configuration;
  }
  if (pair.colliding && entry.reason == PairReason::neverSampled &&
      isWithinLimits(pair.configuration, kinematics)) {
    entry.reason = PairReason::sometimes;
    pair.reason = reasonText(entry.reason);
  }
  pair.contradictsSrdf = contradictsSrdf(entry.reason, pair);
}

// Measures the meshes if the volumes meet, or if they are closer than the amounts by which they exceed their
// hulls. If they are farther apart, the volumes' distance says enough. A contradiction to the SRDF is
// explained in the configuration where it was found.
void explain(const std::vector<CheckedPair>& bodies, double margin, PairCauses& causes, PairReport& pair) {
  if (pair.colliding || pair.answer.distance <= std::max(margin, pair.overCover1 + pair.overCover2)) {
    const PairCause found = causes.explain(bodies, pair.configuration, margin);
    pair.meshDistance = found.meshDistance;
    pair.cause = found.cause;
  }
  if (pair.contradictsSrdf && (pair.cause.empty() || pair.configuration != pair.closest))
    pair.cause = causes.explain(bodies, pair.closest, margin).cause;
}

void summarise(CollisionReport& report) {
  std::stable_sort(report.pairs.begin(), report.pairs.end(), [](const PairReport& a, const PairReport& b) {
    return std::make_tuple(!a.checked, !a.stopsTrajectory, a.answer.distance) <
           std::make_tuple(!b.checked, !b.stopsTrajectory, b.answer.distance);
  });
  report.minDistance = kInfinity;
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked) continue;
    ++report.checked;
    report.colliding += pair.colliding;
    if (pair.colliding) ++report.causes[pair.cause];
    report.minDistance = std::min(report.minDistance, pair.answer.distance);
  }
}

// Computes the pair list, and every pair in its configuration, with the bodies in report.geometry. If the
// report already has them, only the `changed` pairs are computed again.
void examine(const ReportRequest& request, const PairListOptions& search, const AskedPostures& postures,
             const Srdf* srdf, PairCauses& causes, const std::set<LinkPair>& changed, VolumeCache& cache,
             CollisionReport& report) {
  std::map<LinkPair, PairReport> kept;
  for (PairReport& pair : report.pairs)
    if (changed.count(pair.links) == 0) kept.emplace(pair.links, std::move(pair));
  report.list = report.list.empty()
                    ? keptPairList(report.kinematics, report.geometry, srdf, search, cache)
                    : pairListAgain(report.kinematics, report.geometry, srdf, search, report.list, changed);
  const SkipReasons reasons(srdf);
  report.pairs.clear();
  for (const PairEntry& entry : report.list)
    report.pairs.push_back(said(entry, report, srdf ? &reasons : nullptr));
  if (request.trajectory.empty())
    for (PairReport& pair : report.pairs) pair.configuration = postures.asked.value_or(pair.closest);
  else
    followPairs(postures.trajectory, request.trajectory, report);
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    PairReport& pair = report.pairs[i];
    const std::vector<CheckedPair> bodies = bodiesOf(*report.geometry, pair.links);
    measurePair(report, bodies, pair);
    if (pair.answer.status == DistanceStatus::invalid)  // without an answer the pair is not known to be clear
      throw Error(report.robot->path + ": the distance of " + pair.link1 + " and " + pair.link2 +
                  " cannot be computed; look for numbers out of all proportion");
    judge(search.margin, *report.kinematics, report.list[i], pair);
    const auto known = kept.find(pair.links);
    if (known != kept.end() && known->second.colliding == pair.colliding &&
        known->second.configuration == pair.configuration) {
      pair.meshDistance = known->second.meshDistance;
      pair.cause = known->second.cause;
    } else {
      explain(bodies, search.margin, causes, pair);
    }
  }
}

// Pairs whose hulls meet although their meshes do not: in the configuration in which the pair is reported,
// and in the neutral posture if the pair list leaves the pair out because it collides there.
std::vector<SceneNeed> hullOnly(const CollisionReport& report, PairCauses& causes,
                                const Eigen::VectorXd& neutral) {
  std::vector<SceneNeed> needs;
  for (const PairReport& pair : report.pairs) {
    if (pair.checked && pair.colliding && pair.cause == kHullOnly)
      needs.push_back({pair.links, pair.configuration, report.margin});
    const bool byDefault = pair.reason == reasonText(PairReason::byDefault) ||
                           pair.reason == reasonText(PairReason::defaultClears);
    if (byDefault &&
        causes.explain(bodiesOf(*report.geometry, pair.links), neutral, report.margin).cause == kHullOnly)
      needs.push_back({pair.links, neutral, report.margin});
  }
  return needs;
}

// Bounds the meshes' distances from above. The volumes contain the meshes, and within each volume's excess of
// its witness point there is a point of the mesh.
void boundMeshDistances(const RobotGeometry* scene, PairCauses& causes, VolumeCache& cache,
                        CollisionReport& report) {
  const auto fitOf = [&](const Body& body) {
    return meshFit(
        body, [&]() -> const ExactBody& { return causes.exact(body); }, cache);
  };
  for (const Body& body : report.geometry->bodies) report.fits.push_back(fitOf(body));
  std::vector<double> excess;
  for (const MeshFit& fit : report.fits) excess.push_back(fit.volumeExcess);
  if (scene)
    for (const Body& body : scene->bodies) excess.push_back(fitOf(body).volumeExcess);
  for (PairReport& pair : report.pairs)
    if (pair.answer.distance > 0)
      pair.meshDistanceMost = pair.answer.upper + excess[at(pair.body1)] + excess[at(pair.body2)];
}

std::vector<CheckedPair> rowsOf(const CollisionReport& report, const RobotGeometry& geometry) {
  std::vector<CheckedPair> rows;
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked) continue;
    const std::vector<CheckedPair> bodies = bodiesOf(geometry, pair.links);
    rows.insert(rows.end(), bodies.begin(), bodies.end());
  }
  return rows;
}

}  // namespace

CollisionReport makeReport(const ReportRequest& request) {
  CollisionReport report;
  RobotLoader loader(request.files);
  const AskedPostures postures = load(request, loader, report);
  const Srdf* srdf = loader.srdf().get();
  PairListOptions search = request.search;
  search.obstacles = report.obstacles;
  search.neutral = postures.neutral;
  report.margin = search.margin;

  const std::shared_ptr<const RobotGeometry> whole = report.geometry;
  const bool split = request.partsAuto || request.partsAll > 1;
  const GeometryOptions& options = request.files.geometry;
  DetailChoice parts(report.kinematics, {whole}, report.obstacles,
                     {options.cacheFolder, options.threads, options.progress},
                     request.partsAll > 1 || request.partsForAllPairs);
  VolumeCache cache(options.cacheFolder);
  PairCauses causes(report.kinematics, whole, report.obstacles, loader.sceneGeometry(), &cache);
  const auto examineAgain = [&](const std::set<LinkPair>& changed) {
    report.geometry = parts.geometry();
    causes.use(report.geometry);
    examine(request, search, postures, srdf, causes, changed, cache, report);
  };
  if (request.partsAll > 1) parts.splitAll(request.partsAll);
  examineAgain({});
  constexpr int kMostRefinements = 3;  // into two, four and eight parts
  for (int k = 0; request.partsAuto && k < kMostRefinements; ++k) {
    const std::set<LinkPair> changed = parts.refine(hullOnly(report, causes, postures.neutral));
    if (changed.empty()) break;
    examineAgain(changed);
  }
  if (!request.polyhedra.empty()) report.polyhedra = comparePolyhedra(*report.geometry, request.polyhedra);
  boundMeshDistances(loader.sceneGeometry().get(), causes, cache, report);
  summarise(report);
  if (!request.mayCheckNothing) requirePairs(at(report.checked), *report.robot, countsOf(report.list));

  report.neutral = keptNeutral(report.kinematics, report.geometry, report.list, srdf, search, cache);
  const std::vector<std::string> warnings = reportWarnings(report, request.neutral);
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  const auto tick = [&](const std::shared_ptr<const RobotGeometry>& geometry,
                        const std::vector<CheckedPair>& rows, double handOver) {
    ConstraintOptions constraints;
    constraints.obstacles = report.obstacles;
    constraints.handOver = handOver;
    return tickCost(report.kinematics, geometry, rows, constraints,
                    postures.asked.value_or(report.kinematics->neutral()));
  };
  constexpr double kNever = kInfinity;
  report.usPerTick = tick(report.geometry, closestBodies(report), kNever).usPerTick;
  report.nsPerPair = report.usPerTick * 1e3 / std::max(1, report.checked);
  if (split) {
    report.wholeCost = tick(whole, rowsOf(report, *whole), kNever);
    const std::vector<CheckedPair> rows = rowsOf(report, *report.geometry);
    report.partsCost = tick(report.geometry, rows, kNever);
    report.handOverCost = tick(report.geometry, rows, kHandOver);
  }
  return report;
}

}  // namespace fcl_stpbv::report
