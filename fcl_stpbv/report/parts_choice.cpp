// 1. Of the pairs in collision, those whose meshes do not meet and whose hulls do are candidates.
// 2. Splits of their two links are tried, fewest rows first: 2, 4 or 8 parts of either or both.
// 3. The first that puts the parts' volumes farther apart than the margin is kept, for this pair.
// Whoever calls makes the report anew with the parts, since another configuration may now be the worst, and
// asks again.
#include "fcl_stpbv/report/parts_choice.h"

#include <algorithm>
#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv::report {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

// The least distance of the bodies in q, each split as far; ends with the first that is not above `enough`.
double PartsChoice::clearance(const CollisionReport& report, const LinkPair& pair, const Eigen::VectorXd& q,
                              const Split& split, double enough) {
  Kinematics::State state = report.kinematics->makeState();
  report.kinematics->forward(q, state);
  struct Placed {
    const fcl::CollisionGeometryd* geometry;
    Eigen::Isometry3d pose;
  };
  const auto bodiesOf = [&](int link, int most) {
    std::vector<Placed> placed;
    const auto add = [&](const Body& body) {
      placed.push_back({body.geometry.get(), state.link[at(body.link)] * body.pose});
    };
    const auto [first, last] = parts_.whole().of(link);
    for (int i = first; i < last; ++i) {
      const Body& whole = parts_.whole().bodies[at(i)];
      const std::vector<Body>& parts = parts_.of(i, most);
      if (parts.size() < 2)
        add(whole);
      else
        std::for_each(parts.begin(), parts.end(), add);
    }
    return placed;
  };
  const std::vector<Placed> first = bodiesOf(pair.link1, split.first);
  std::vector<Placed> second;
  if (pair.obstacle) {
    const Obstacle& obstacle = report.obstacles[at(pair.link2)];
    second.push_back({obstacle.geometry.get(), obstacle.pose});
  } else {
    second = bodiesOf(pair.link2, split.second);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Placed& a : first)
    for (const Placed& b : second) {
      least = std::min(least, distance(*a.geometry, a.pose, *b.geometry, b.pose).distance);
      if (!(least > enough)) return least;
    }
  return least;
}

bool PartsChoice::refinePair(const CollisionReport& report, const LinkPair& pair, const Eigen::VectorXd& q) {
  const bool known = byParts_.count(pair) > 0;
  const auto now = [&](int link) {
    const auto found = most_.find(link);
    return known && found != most_.end() ? found->second : 1;
  };
  const Split least{now(pair.link1), pair.obstacle ? 1 : now(pair.link2)};
  std::vector<Split> splits;
  for (const int first : {1, 2, 4, 8})
    for (const int second : {1, 2, 4, 8})
      if (first >= least.first && second >= least.second && Split(first, second) != least &&
          (!pair.obstacle || second == 1))
        splits.emplace_back(first, second);
  std::stable_sort(splits.begin(), splits.end(),
                   [](const Split& a, const Split& b) { return a.first * a.second < b.first * b.second; });
  for (const Split& split : splits) {
    if (!(clearance(report, pair, q, split, report.margin) > report.margin)) continue;
    const auto raise = [&](int link, int parts) {
      if (parts > 1) most_[link] = std::max(parts, most_[link]);
    };
    raise(pair.link1, split.first);
    if (!pair.obstacle) raise(pair.link2, split.second);
    byParts_.insert(pair);
    return true;
  }
  return false;
}

bool PartsChoice::refine(const CollisionReport& report, PairCauses& causes, const Eigen::VectorXd& neutral) {
  bool changed = false;
  for (const PairReport& pair : report.pairs) {
    const LinkPair& links = pair.links;
    if (pair.checked && pair.colliding && pair.cause == kHullOnly)
      changed = refinePair(report, links, pair.configuration) || changed;
    // In collision in the neutral posture, which would leave it unchecked.
    const bool byDefault = pair.reason == reasonText(PairReason::byDefault) ||
                           pair.reason == reasonText(PairReason::defaultClears);
    if (byDefault &&
        causes.explain(bodiesOf(*report.geometry, links), neutral, report.margin).cause == kHullOnly)
      changed = refinePair(report, links, neutral) || changed;
  }
  return changed;
}

void PartsChoice::splitAll(const CollisionReport& report, int most) {
  for (const Body& body : report.geometry->bodies)
    if (!body.file.empty()) most_[body.link] = most;
  for (const PairEntry& entry : report.list) byParts_.insert(entry);
}

}  // namespace fcl_stpbv::report
