// proof_boxes: number of boxes of joint values that a proof needs to show that two links never meet, with the
// joints' levers alone and with planes fixed to a link between them (docs/proofs.md).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Taken {
  bool proven = false, collides = false;
  long boxes = 0;
  double seconds = 0;
};

// The bound without planes: the distance at the middle minus the largest change by each joint's lever.
Taken byLevers(const ProofScene& scene, const PairEntry& entry, long most) {
  PairSearch search(scene.kinematics, scene.geometry, entry);
  const std::vector<int>& coordinates = search.coordinates();
  const Eigen::Map<const Eigen::VectorXd> levers(search.lipschitz().data(),
                                                 static_cast<Eigen::Index>(search.lipschitz().size()));
  std::vector<JointBox> open = unproven(scene, entry).open;
  Eigen::VectorXd q = scene.kinematics->neutral();
  Taken taken;
  const Clock::time_point start = Clock::now();
  while (!open.empty() && taken.boxes < most) {
    JointBox box = std::move(open.back());
    open.pop_back();
    ++taken.boxes;
    const Eigen::VectorXd change = levers.cwiseProduct(box.upper - box.lower) / 2;
    for (std::size_t k = 0; k < coordinates.size(); ++k)
      q[coordinates[k]] = (box.lower + box.upper)[static_cast<Eigen::Index>(k)] / 2;
    const double d = search.distance(q);
    taken.collides = d <= 0;
    if (taken.collides) break;
    if (d - change.sum() > 0) continue;
    Eigen::Index widest;
    change.maxCoeff(&widest);
    JointBox other = box;
    box.upper[widest] = other.lower[widest] = (box.lower + box.upper)[widest] / 2;
    open.push_back(std::move(box));
    open.push_back(std::move(other));
  }
  taken.seconds = since(start);
  taken.proven = open.empty() && !taken.collides;
  return taken;
}

Taken byPlanes(const ProofScene& scene, const PairEntry& entry, long most) {
  const Clock::time_point start = Clock::now();
  const PairProof proof = provePair(scene, entry, unproven(scene, entry).open, most);
  return {proof.proven(), proof.collision.has_value(), proof.boxes, since(start)};
}

// Share of the random descents in the time of the whole list, compared with the proofs at its start.
void timeList(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry) {
  for (const int descents : {0, PairListOptions().randomDescents}) {
    PairListOptions search;
    search.randomDescents = descents;
    const Clock::time_point start = Clock::now();
    const std::vector<PairEntry> list = pairList(kinematics, geometry, nullptr, search);
    const double seconds = since(start);
    const auto tried = std::count_if(list.begin(), list.end(), [](const PairEntry& entry) {
      return entry.reason == PairReason::neverSampled;
    });
    std::printf("the list with %d random descents: %.2f s; %td pairs found clear and not proven\n", descents,
                seconds, tried);
  }
}

struct Arguments {
  std::string urdf;
  std::vector<std::string> packagePath;
  long before = 300000, boxes = 20000;
  int descents = 500;
};

void measure(const Arguments& a, benchmark::Measurement& result) {
  const auto robot = std::make_shared<const RobotModel>(loadUrdf(a.urdf));
  GeometryOptions options;
  options.packagePath = a.packagePath;
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*robot, options));
  const auto kinematics = std::make_shared<const Kinematics>(robot);
  timeList(kinematics, geometry);
  PairListOptions search;
  search.proofBoxes = 0;
  search.randomDescents = a.descents;
  Clock::time_point start = Clock::now();
  const std::vector<PairEntry> list = pairList(kinematics, geometry, nullptr, search);
  std::printf("%s: %s; %.1f s for samples and descents\n", robot->name.c_str(), countsOf(list).c_str(),
              since(start));
  const ProofScene scene = proofScene(kinematics, geometry, {}, 0);
  std::vector<double> fewer, faster, fewerOfMany, perBox;
  std::vector<long> before, now;
  std::size_t pairs = 0, oldProven = 0, newProven = 0, collide = 0;
  double oldSeconds = 0, newSeconds = 0;
  std::printf("%-44s %10s %10s %10s %10s\n", "pair", "levers", "s", "planes", "s");
  for (const PairEntry& entry : list) {
    if (entry.reason != PairReason::neverSampled) continue;
    ++pairs;
    const Taken levers = byLevers(scene, entry, a.before), planes = byPlanes(scene, entry, a.boxes);
    const auto shown = [](const Taken& t) { return t.proven ? "" : t.collides ? "x" : ">"; };
    std::printf("%-44s %10s %10.3f %10s %10.4f\n",
                (robot->links[static_cast<std::size_t>(entry.link1)].name + " - " +
                 robot->links[static_cast<std::size_t>(entry.link2)].name)
                    .c_str(),
                (shown(levers) + std::to_string(levers.boxes)).c_str(), levers.seconds,
                (shown(planes) + std::to_string(planes.boxes)).c_str(), planes.seconds);
    oldProven += levers.proven;
    newProven += planes.proven;
    collide += planes.collides || levers.collides;
    oldSeconds += levers.seconds;
    newSeconds += planes.seconds;
    perBox.push_back(1e6 * planes.seconds / static_cast<double>(planes.boxes));
    if (levers.proven) before.push_back(levers.boxes);
    if (planes.proven) now.push_back(planes.boxes);
    if (!levers.proven || !planes.proven) continue;
    fewer.push_back(static_cast<double>(levers.boxes) / static_cast<double>(planes.boxes));
    if (levers.boxes < 100) continue;
    fewerOfMany.push_back(fewer.back());
    faster.push_back(levers.seconds / planes.seconds);
  }
  std::printf(
      "of %zu pairs found clear: levers prove %zu within %ld boxes (%.1f s), planes %zu within %ld (%.1f s), "
      "%zu collide\n",
      pairs, oldProven, a.before, oldSeconds, newProven, a.boxes, newSeconds, collide);
  std::printf(
      "both prove %zu: median %.0f times fewer boxes; the %zu that levers take 100 boxes or more for: median "
      "%.0f "
      "times fewer, %.0f times faster; %.0f us a box\n",
      fewer.size(), benchmark::median(fewer), fewerOfMany.size(), benchmark::median(fewerOfMany),
      benchmark::median(faster), benchmark::median(perBox));
  result.about = {{"robot", robot->name},
                  {"pairs", pairs},
                  {"most_boxes_of_levers", a.before},
                  {"most_boxes_of_planes", a.boxes},
                  {"proven_by_levers", oldProven},
                  {"proven_by_planes", newProven},
                  {"hardest_proof", now.empty() ? 0 : *std::max_element(now.begin(), now.end())},
                  {"fewer_boxes_median", std::round(benchmark::median(fewerOfMany))},
                  {"fewer_boxes_pairs", fewerOfMany.size()},
                  {"less_time_median", std::round(benchmark::median(faster))},
                  {"us_a_box", std::round(benchmark::median(perBox))}};
  for (const long boxes : before) result.rows.push_back({{"bound", "levers"}, {"boxes", boxes}});
  for (const long boxes : now) result.rows.push_back({{"bound", "planes"}, {"boxes", boxes}});
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Boxes that proofs take, by levers and by planes", "proof_boxes");
  Arguments a;
  app.option("ROBOT", a.urdf, "The robot's URDF").required();
  app.option("--package-path", a.packagePath, "Folder that holds packages").repeated();
  app.option("--before", a.before, "Most boxes of the levers for a pair").whole(1).shown();
  app.option("--boxes", a.boxes, "Most boxes of the planes for a pair").whole(1).shown();
  app.option("--descents", a.descents, "Random descents for a pair before that").whole().shown();
  return benchmark::runBenchmark(app, argc, argv, "proof_boxes",
                                 [&](benchmark::Measurement& result) { measure(a, result); });
}
