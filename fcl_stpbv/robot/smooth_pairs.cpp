// Chooses the primitives that get a smooth cover, so that every pair has a smooth body: greedy weighted
// vertex cover (Chvatal 1979).
// 1. Cover the body with the least excess per open pair that it settles, until no pair is open.
// 2. Remove covers that are no longer needed, the largest excess first.
#include <algorithm>
#include <limits>
#include <numeric>

#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/primitive_cover.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

// A body that is not smooth, and the bodies that it meets in pairs without a smooth body.
struct FlatBody {
  Body* body;
  PrimitiveCover cover;  // without a volume if the body must stay flat
  std::vector<std::size_t> others;
  std::size_t open = 0;  // number of these that are not covered
  bool covered = false;

  double loss() const { return cover.excess.max; }
};

PrimitiveCover coverOf(const Body& body) {
  return within("the smooth cover of " + body.name,
                [&] { return primitiveCover(*body.geometry, body.radii); });
}

class Choice {
 public:
  Choice(const std::vector<CheckedPair>& pairs, RobotGeometry& robot, RobotGeometry* scene) {
    const std::size_t bodies = robot.bodies.size();
    node_.assign(bodies + (scene ? scene->bodies.size() : 0), kSmooth);
    for (const CheckedPair& pair : pairs) {
      requireBodies(pair, robot, node_.size() - bodies, "coverPrimitives");
      const std::size_t a = nodeOf(at(pair.body), robot.bodies[at(pair.body)]);
      const std::size_t b = nodeOf(at(pair.other) + (pair.obstacle ? bodies : 0),
                                   (pair.obstacle ? *scene : robot).bodies[at(pair.other)]);
      if (a == kSmooth || b == kSmooth) continue;
      flat_[a].others.push_back(b);
      flat_[b].others.push_back(a);
      ++flat_[a].open;
      ++flat_[b].open;
    }
  }

  void make() {
    while (coverNext()) continue;
    takeBack();
    for (FlatBody& flat : flat_)
      if (flat.covered) put(flat);
  }

 private:
  static constexpr std::size_t kSmooth = std::numeric_limits<std::size_t>::max();

  std::size_t nodeOf(std::size_t index, Body& body) {
    if (body.volume) return kSmooth;
    if (node_[index] == kSmooth) {
      node_[index] = flat_.size();
      flat_.push_back({&body, coverOf(body), {}, 0, false});
    }
    return node_[index];
  }

  // Covers the body whose cover costs least per pair that it settles. @returns false if no pair is open,
  // or none that a cover could settle.
  bool coverNext() {
    double least = kInfinity;
    FlatBody* best = nullptr;
    for (FlatBody& flat : flat_) {
      if (flat.covered || !flat.cover.volume || flat.open == 0) continue;
      const double loss = flat.loss() / static_cast<double>(flat.open);
      if (loss < least) least = loss, best = &flat;
    }
    if (!best) return false;
    best->covered = true;
    for (const std::size_t other : best->others) --flat_[other].open;
    return true;
  }

  void takeBack() {
    std::vector<std::size_t> order(flat_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return flat_[a].loss() > flat_[b].loss(); });
    for (const std::size_t i : order) {
      FlatBody& flat = flat_[i];
      if (flat.covered && flat.loss() > 0 &&
          std::all_of(flat.others.begin(), flat.others.end(),
                      [&](std::size_t other) { return flat_[other].covered; }))
        flat.covered = false;
    }
  }

  static void put(const FlatBody& flat) {
    Body& body = *flat.body;
    body.primitive = body.geometry;
    body.volume = flat.cover.volume;
    body.geometry = std::make_shared<StpBvGeometry>(body.volume);
    body.cover = flat.cover.excess;
    body.centre = body.pose * body.volume->centre();
    body.radius = body.volume->enclosingRadius();
  }

  std::vector<std::size_t> node_;  // index in flat_ of each body, the scene's after the robot's
  std::vector<FlatBody> flat_;
};

}  // namespace

void coverPrimitives(const std::vector<CheckedPair>& pairs, RobotGeometry& robot, RobotGeometry* scene) {
  Choice(pairs, robot, scene).make();
}

}  // namespace fcl_stpbv
