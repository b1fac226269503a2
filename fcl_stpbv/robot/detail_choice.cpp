// A greedy choice from coarse to fine.
// 1. Try the details in turn, coarse first: finer levels, then 2, 4 and 8 parts. Take the first detail with
//    which one finer link alone meets some need. Give it to the link that meets the most needs with it.
//    Repeat until no single link helps.
// 2. Give the first need that two finer links meet together the details with the fewest rows. Go on with 1.
// 3. The remaining needs are not met by the finest bodies.
// A pair uses convex parts only if a need of that pair requires them.
#include "fcl_stpbv/robot/detail_choice.h"

#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv::detail {
namespace {

// Whether two primitives, covered or not, are of the same kind and size.
bool samePrimitive(const Body& a, const Body& b) {
  const auto shape = [](const Body& body) {
    Shape found;
    const fcl::CollisionGeometryd& geometry = body.primitive ? *body.primitive : *body.geometry;
    shapeOf(geometry, found);
    return found;
  };
  const Shape x = shape(a), y = shape(b);
  return x.kind == y.kind && x.margin == y.margin && x.radius == y.radius && x.half == y.half &&
         x.size == y.size;
}

// Whether two bodies are the same mesh or primitive at the same place. Levels may differ only in how it is
// covered.
bool sameShape(const Body& a, const Body& b) {
  return a.link == b.link && a.pose.matrix() == b.pose.matrix() && a.file == b.file && a.scale == b.scale &&
         (!a.file.empty() || samePrimitive(a, b));
}

void requireSameShapes(const DetailChoice::Levels& levels) {
  if (levels.empty()) throw Error("modelForScene: no level of bodies was given");
  for (const auto& level : levels) {
    bool same = level->bodies.size() == levels[0]->bodies.size();
    for (std::size_t i = 0; same && i < level->bodies.size(); ++i) {
      const Body &a = level->bodies[i], &b = levels[0]->bodies[i];
      same = sameShape(a, b) && a.partOf < 0;
    }
    if (!same) throw Error("modelForScene: each level must have the same links' whole bodies");
  }
}

}  // namespace

DetailChoice::DetailChoice(std::shared_ptr<const Kinematics> kinematics, Levels levels,
                           std::vector<Obstacle> obstacles, const SceneModelOptions& options, bool everyPair)
    : kinematics_(std::move(kinematics)),
      levels_((requireSameShapes(levels), std::move(levels))),
      obstacles_(std::move(obstacles)),
      parts_(levels_.back(), options.cacheFolder),
      ownShapes_(levels_.back()),
      options_(options) {
  for (Detail level = 1; level < this->levels(); ++level) ladder_.push_back(level);
  for (const int most : {2, 4, 8}) ladder_.push_back(inParts(most));
  const int links = static_cast<int>(kinematics_->robot().links.size());
  for (int i = 0; everyPair && i < links; ++i) {
    for (int j = i + 1; j < links; ++j) byParts_.insert({i, j});
    for (int o = 0; o < static_cast<int>(obstacles_.size()); ++o) byParts_.insert({i, o, true});
  }
}

DetailChoice::Detail DetailChoice::detailOf(int link) const {
  const auto found = detail_.find(link);
  return found == detail_.end() ? 0 : found->second;
}

DetailChoice::Details DetailChoice::detailsOf(const LinkPair& pair) const {
  const Detail most = byParts_.count(pair) > 0 ? std::numeric_limits<Detail>::max() : levels() - 1;
  return {std::min(detailOf(pair.link1), most), pair.obstacle ? 0 : std::min(detailOf(pair.link2), most)};
}

// The details of a pair after one of its links became as fine as `detail`. If these are parts, the pair is
// checked by parts: then the other link has all of its own detail too.
DetailChoice::Details DetailChoice::raised(const LinkPair& pair, int link, Detail detail) const {
  Details details = detailsOf(pair);
  if (detail >= levels()) details = {detailOf(pair.link1), pair.obstacle ? 0 : detailOf(pair.link2)};
  Detail& one = link == pair.link1 ? details.first : details.second;
  one = std::max(one, detail);
  return details;
}

std::vector<const Body*> DetailChoice::bodiesOf(int link, Detail detail) {
  const RobotGeometry& level = *levels_[at(std::min(detail, levels() - 1))];
  const auto [first, last] = level.of(link);
  std::vector<const Body*> bodies;
  for (int i = first; i < last; ++i) {
    const std::vector<Body>* parts = detail < levels() ? nullptr : &parts_.of(i, mostParts(detail));
    if (!parts || parts->size() < 2)
      bodies.push_back(&level.bodies[at(i)]);
    else
      for (const Body& part : *parts) bodies.push_back(&part);
  }
  return bodies;
}

bool DetailChoice::meets(const SceneNeed& need, Details details) {
  Kinematics::State state = kinematics_->makeState();
  kinematics_->forward(need.q, state);
  const auto poseOf = [&](const Body& body) -> Eigen::Isometry3d {
    return state.link[at(body.link)] * body.pose;
  };
  const auto apart = [&](const Body& a, const fcl::CollisionGeometryd& geometry,
                         const Eigen::Isometry3d& pose) {
    const DistanceAnswer found = fcl_stpbv::distance(*a.geometry, poseOf(a), geometry, pose);
    return found.status != DistanceStatus::invalid &&
           found.distance > need.clearance;  // without a valid answer, nothing is known
  };
  for (const Body* a : bodiesOf(need.pair.link1, details.first)) {
    if (need.pair.obstacle) {
      const Obstacle& obstacle = obstacles_[at(need.pair.link2)];
      if (!apart(*a, *obstacle.geometry(), obstacle.pose())) return false;
      continue;
    }
    for (const Body* b : bodiesOf(need.pair.link2, details.second))
      if (!apart(*a, *b->geometry, poseOf(*b))) return false;
  }
  return true;
}

bool DetailChoice::meets(const SceneNeed& need) { return meets(need, detailsOf(need.pair)); }

bool DetailChoice::meets(OpenNeed& open, Details details) {
  const auto [found, isNew] = open.met.emplace(details, false);
  if (isNew) found->second = mayMeet(open, details) && meets(open.need, details);
  return found->second;
}

// Parts contain the link's own shapes, and finding them takes seconds. So a need is first tested with these
// shapes in place of the parts: if they are too near, no parts meet it.
bool DetailChoice::mayMeet(OpenNeed& open, Details details) {
  const auto possible = [&](Details bounds) {
    const auto [found, isNew] = open.met.emplace(bounds, false);
    if (!isNew) return found->second;
    const auto given = [&](int link, Detail detail) {
      return detail == kOwn ? std::vector<const Body*>() : bodiesOf(link, detail);
    };
    const LinkPair& pair = open.need.pair;
    const auto first = given(pair.link1, bounds.first);
    const auto second = pair.obstacle ? first : given(pair.link2, bounds.second);
    found->second =
        !ownShapes_.rulesOut(open.need, *kinematics_, obstacles_, bounds.first == kOwn ? nullptr : &first,
                             bounds.second == kOwn ? nullptr : &second);
    return found->second;
  };
  return (details.first < levels() || possible({kOwn, details.second})) &&
         (details.second < levels() || possible({details.first, kOwn}));
}

void DetailChoice::raise(int link, Detail detail) {
  Detail& now = detail_[link];
  if (now >= detail) return;
  const bool wholeToo = now + 1 < levels();  // whether the whole body also becomes another one
  now = detail;
  for (const LinkPair& pair : byParts_)
    if (pair.link1 == link || (!pair.obstacle && pair.link2 == link)) changed_.insert(pair);
  if (!wholeToo) return;
  for (int other = 0; other < static_cast<int>(kinematics_->robot().links.size()); ++other)
    if (other != link) changed_.insert({link, other});
  for (int o = 0; o < static_cast<int>(obstacles_.size()); ++o) changed_.insert({link, o, true});
}

void DetailChoice::take(const LinkPair& pair, Details details) {
  if (std::max(details.first, details.second) >= levels() && byParts_.insert(pair).second)
    changed_.insert(pair);
  raise(pair.link1, details.first);
  if (!pair.obstacle) raise(pair.link2, details.second);
}

// Makes the one link as fine as `detail` that meets the most needs with it. @returns false if no link meets
// any.
bool DetailChoice::refineOneLink(std::vector<OpenNeed>& open, Detail detail) {
  std::vector<std::pair<bool, bool>> met(open.size());
  const auto tries = [&](OpenNeed& o, int link) {
    const Details details = raised(o.need.pair, link, detail);
    return details != detailsOf(o.need.pair) && meets(o, details);
  };
  shareOut(open.size(), options_.threads, [&](std::size_t i) {
    const LinkPair& pair = open[i].need.pair;
    met[i] = {tries(open[i], pair.link1), !pair.obstacle && tries(open[i], pair.link2)};
  });
  std::map<int, int> needs;  // number of needs met, by link
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (met[i].first) ++needs[open[i].need.pair.link1];
    if (met[i].second) ++needs[open[i].need.pair.link2];
  }
  if (needs.empty()) return false;
  const int best = std::max_element(needs.begin(), needs.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  for (std::size_t i = 0; i < open.size(); ++i) {
    const LinkPair& pair = open[i].need.pair;
    if ((met[i].first && pair.link1 == best) || (met[i].second && pair.link2 == best))
      take(pair, raised(pair, best, detail));
  }
  return true;
}

// Takes the details of both links that meet a need with the fewest rows. @returns false if the finest do not
// meet it.
bool DetailChoice::refineBothLinks(OpenNeed& open) {
  const LinkPair& pair = open.need.pair;
  const Details now{detailOf(pair.link1), pair.obstacle ? 0 : detailOf(pair.link2)};
  std::vector<Details> all;
  std::vector<Detail> ladder = ladder_;
  ladder.insert(ladder.begin(), 0);
  for (const Detail a : ladder)
    for (const Detail b : ladder)
      if (a >= now.first && b >= now.second && (!pair.obstacle || b == 0)) all.emplace_back(a, b);
  std::stable_sort(all.begin(), all.end(), [&](const Details& a, const Details& b) {
    const auto rows = [&](const Details& d) { return mostParts(d.first) * mostParts(d.second); };
    return rows(a) < rows(b);
  });
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Details& details) { return meets(open, details); });
  if (found == all.end()) return false;
  take(pair, *found);
  return true;
}

// A finer body need not lie within the coarse one, so all needs are checked again at the end. The exact
// shapes are queried only if whole bodies meet, because bodies take a tenth of the time.
std::set<LinkPair> DetailChoice::refine(const std::vector<SceneNeed>& needs) {
  changed_.clear();
  std::vector<char> hopeless(needs.size());
  std::vector<OpenNeed> open;
  const auto gather = [&] {
    std::vector<char> settled(needs.size());
    shareOut(needs.size(), options_.threads,
             [&](std::size_t i) { settled[i] = hopeless[i] || meets(needs[i]); });
    for (std::size_t i = 0; i < needs.size(); ++i) {
      if (settled[i]) continue;
      OpenNeed need{needs[i], i, {{detailsOf(needs[i].pair), false}}};
      const Details finestWhole{levels() - 1, needs[i].pair.obstacle ? 0 : levels() - 1};
      if (!meets(need, finestWhole) && ownShapes_.rulesOut(needs[i], *kinematics_, obstacles_))
        hopeless[i] = 1;
      else
        open.push_back(std::move(need));
    }
    return !open.empty();
  };
  while (gather()) {
    const std::size_t all = open.size();
    while (!open.empty()) {
      if (options_.progress) options_.progress(all - open.size(), all, "needs that whole bodies do not meet");
      bool finer = false;
      for (std::size_t k = 0; !finer && k < ladder_.size(); ++k) finer = refineOneLink(open, ladder_[k]);
      while (!finer && !open.empty() && !refineBothLinks(open.front())) {  // no detail meets the need
        hopeless[open.front().index] = 1;
        open.erase(open.begin());
      }
      open.erase(std::remove_if(open.begin(), open.end(),
                                [&](OpenNeed& o) { return meets(o, detailsOf(o.need.pair)); }),
                 open.end());
    }
  }
  return std::move(changed_);
}

void DetailChoice::splitAll(int most) {
  std::map<int, int> links;
  for (const Body& body : parts_.whole().bodies)
    if (!body.file.empty()) links[body.link] = most;
  parts_.prepare(links, options_.threads, options_.progress);
  for (const auto& [link, parts] : links) detail_[link] = inParts(parts);
}

std::shared_ptr<const RobotGeometry> DetailChoice::geometry() {
  std::map<int, int> most;
  for (const auto& [link, detail] : detail_)
    if (mostParts(detail) > 1) most[link] = mostParts(detail);
  RobotGeometry all = parts_.geometry(most, byParts_);
  int whole = 0;  // index of the whole body, which is the same at every level
  for (Body& body : all.bodies) {
    if (body.partOf >= 0) continue;
    const int parts = body.parts;
    body = levels_[at(std::min(detailOf(body.link), levels() - 1))]->bodies[at(whole++)];
    body.parts = parts;
  }
  return std::make_shared<const RobotGeometry>(std::move(all));
}

}  // namespace fcl_stpbv::detail
