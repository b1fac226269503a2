// 1. Candidates are pairs in collision whose meshes do not meet and whose hulls do; whoever calls finds them.
// 2. Splits of their two links are tried, fewest rows first: 2, 4 or 8 parts of either or both.
// 3. The first that puts the parts' volumes farther apart than the margin is kept, for this pair.
// Whoever calls looks at all anew with the parts, since another configuration may now be the worst, and asks
// again.
#include "fcl_stpbv/report/parts_choice.h"

#include <algorithm>
#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/share_out.h"

namespace fcl_stpbv::report {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

PartsChoice::PartsChoice(PartsScene scene, const GeometryOptions& options, bool everyPair)
    : scene_(std::move(scene)),
      parts_(scene_.whole, options.cacheFolder),
      threads_(options.threads),
      progress_(options.progress) {
  const int links = static_cast<int>(scene_.kinematics->robot().links.size());
  for (int i = 0; everyPair && i < links; ++i) {
    for (int j = i + 1; j < links; ++j) byParts_.insert({i, j});
    for (int o = 0; o < static_cast<int>(scene_.obstacles.size()); ++o) byParts_.insert({i, o, true});
  }
}

// The least distance of the bodies, each split as far; ends with the first that is not above the margin.
double PartsChoice::clearance(const PartsCandidate& candidate, const Split& split) {
  const LinkPair& pair = candidate.pair;
  Kinematics::State state = scene_.kinematics->makeState();
  scene_.kinematics->forward(candidate.q, state);
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
      const std::vector<Body>* parts = most > 1 ? &parts_.of(i, most) : nullptr;
      if (!parts || parts->size() < 2)
        add(parts_.whole().bodies[at(i)]);
      else
        std::for_each(parts->begin(), parts->end(), add);
    }
    return placed;
  };
  const std::vector<Placed> first = bodiesOf(pair.link1, split.first);
  std::vector<Placed> second;
  if (pair.obstacle) {
    const Obstacle& obstacle = scene_.obstacles[at(pair.link2)];
    second.push_back({obstacle.geometry.get(), obstacle.pose});
  } else {
    second = bodiesOf(pair.link2, split.second);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Placed& a : first)
    for (const Placed& b : second) {
      least = std::min(least, distance(*a.geometry, a.pose, *b.geometry, b.pose).distance);
      if (!(least > scene_.margin)) return least;
    }
  return least;
}

// The fewest rows that clear a pair, finer than what it has; none where eight parts of both do not.
std::optional<PartsChoice::Split> PartsChoice::splitFor(const PartsCandidate& candidate) {
  const LinkPair& pair = candidate.pair;
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
  for (const Split& split : splits)
    if (clearance(candidate, split) > scene_.margin) return split;
  return std::nullopt;
}

std::set<LinkPair> PartsChoice::refine(const std::vector<PartsCandidate>& candidates) {
  // Each is looked at by itself, from what held before, so that their order does not matter.
  std::vector<std::optional<Split>> found(candidates.size());
  detail::shareOut(
      candidates.size(), threads_, [&](std::size_t i) { found[i] = splitFor(candidates[i]); },
      [&](std::size_t i) {
        if (progress_) progress_(i, candidates.size(), "parts for pairs that collide by their hulls alone");
      });
  std::set<LinkPair> changed;
  std::set<int> finer;  // links
  const auto raise = [&](int link, int parts) {
    if (parts < 2 || most_[link] >= parts) return;
    most_[link] = parts;
    finer.insert(link);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!found[i]) continue;
    const LinkPair& pair = candidates[i].pair;
    raise(pair.link1, found[i]->first);
    if (!pair.obstacle) raise(pair.link2, found[i]->second);
    byParts_.insert(pair);
    changed.insert(pair);
  }
  for (const LinkPair& pair : byParts_)
    if (finer.count(pair.link1) > 0 || (!pair.obstacle && finer.count(pair.link2) > 0)) changed.insert(pair);
  return changed;
}

void PartsChoice::splitAll(int most) {
  for (const Body& body : parts_.whole().bodies)
    if (!body.file.empty()) most_[body.link] = most;
  parts_.prepare(most_, threads_, progress_);
}

}  // namespace fcl_stpbv::report
