// Does any pair come within the margin?
// 1. Place the links and their bounding spheres; compare the spheres of four pairs at a time.
// 2. Of the pairs left, the one that hit last comes first. Balls inside two bodies may prove a hit.
// 3. The plane that kept a pair apart last time is kept in both bodies' frames. When they have turned, what
//    the second body rises over it is bounded twice: by its sphere's radius times the turn, and by the ball
//    of radius R that holds an STP-BV and touches it at the plane (docs/performance.md).
// 4. Else the search of distance/threshold.h, or that of proximity.h for bodies that are not convex.
#include "fcl_stpbv/robot/collision_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/adapter/proximity.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/threshold.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/robot/kept_plane.h"
#include "fcl_stpbv/robot/sphere_pairs.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kLowest = std::numeric_limits<double>::lowest();

/// `v`, with 0 as the fourth number: of use in sums over all four.
Packed pack3(const Vector3d& v) { return Packed{v.x(), v.y(), v.z(), 0.0}; }

/// A body of the robot or an obstacle. The world stands behind the links as a frame of its own.
struct Placed {
  std::size_t frame;
  const fcl::CollisionGeometryd* geometry;
  Isometry3d inFrame;
  Vector3d centre;  ///< of a sphere that holds it, in its frame (m)
  double radius;    ///< of that sphere (m)
  double inner;     ///< of a ball about the same centre that it holds (m)
  bool convex;
  ConvexBody body;  ///< where it is convex; posed at the last query
};

struct Pair {
  std::size_t a, b;     ///< among the bodies
  double bend;          ///< half the second body's R; infinite where it is no STP-BV (m)
  double rounding;      ///< of their gap along a kept plane, but for the poses' (m)
  long lastHit = 0;     ///< the configuration's number
  bool kept = false;    ///< whether there is a plane, by its directions
  bool lifted = false;  ///< whether its height is known: it is looked for when it is asked for
  KeptPlane plane{};
  PairCache cache;
};

}  // namespace

class CollisionChecker::Impl {
 public:
  Impl(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
       std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles, double margin);

  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  std::string name(int pair) const { return nameOf(pairs_.at(at(pair)), *geometry_, obstacles_); }
  double margin() const { return margin_; }
  void setMargin(double margin);
  std::optional<Hit> firstHit(const ConstVector& q);
  const std::vector<Hit>& allHits(const ConstVector& q);
  double minDistance(const ConstVector& q);
  const CheckerWork& work() const { return work_; }
  void forget();

 private:
  void addBody(std::size_t frame, const fcl::CollisionGeometryd& geometry, const Isometry3d& pose,
               const Vector3d& centre, double radius);
  void addPair(const CheckedPair& pair);
  bool place(const ConstVector& q);
  void placeSpheres();
  bool isClear(const NearPair& near);
  bool isRecent(const Pair& pair) const;
  double planeGap(Pair& pair) const;
  bool searchSaysClear(Pair& pair);
  double measured(Pair& pair);
  void keepPlane(Pair& pair) const;
  void lift(Pair& pair) const;
  Hit hitOf(int pair) const { return {pair, pairs_[at(pair)]}; }
  const ConvexBody& posed(Placed& placed) const {
    placed.body.pose = state_.link[placed.frame] * placed.inFrame;
    return placed.body;
  }

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<CheckedPair> pairs_;
  std::vector<Obstacle> obstacles_;
  double margin_ = 0, largest_ = 0, slack_ = 0;  // of the margin, of all radii, of the poses' rounding (m)
  Kinematics::State state_;                      // with the world's frame as one more link
  std::vector<Placed> bodies_;
  std::vector<SphereCentre> centres_;  // of the bodies' spheres
  std::vector<Pair> checked_;
  SpherePairs near_;
  std::vector<Hit> hits_;
  CheckerWork work_;
  std::size_t closest_ = 0;  // the pair of the last least distance
};

CollisionChecker::Impl::Impl(std::shared_ptr<const Kinematics> kinematics,
                             std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                             std::vector<Obstacle> obstacles, double margin)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      pairs_(std::move(pairs)),
      obstacles_(std::move(obstacles)),
      state_(kinematics_->makeState()) {
  if (pairs_.empty())
    throw Error("CollisionChecker: no pairs are given, so that nothing could be said about collisions");
  const std::size_t world = state_.link.size();
  state_.link.push_back(Isometry3d::Identity());
  for (const Body& body : geometry_->bodies)
    addBody(at(body.link), *body.geometry, body.pose, body.centre, body.radius);
  for (const Obstacle& obstacle : obstacles_)
    addBody(world, *obstacle.geometry, obstacle.pose, obstacle.centre, obstacle.radius);
  for (const CheckedPair& pair : pairs_) addPair(pair);
  centres_.resize(bodies_.size());
  near_.resize(pairs_.size());
  hits_.reserve(pairs_.size());
  setMargin(margin);
}

void CollisionChecker::Impl::addBody(std::size_t frame, const fcl::CollisionGeometryd& geometry,
                                     const Isometry3d& pose, const Vector3d& centre, double radius) {
  Placed placed{frame, &geometry, pose, centre, radius, 0, false, {}};
  placed.convex = isConvex(geometry, placed.body);
  if (const StpBv* volume = placed.body.volume) {
    placed.centre = pose * volume->centre();
    placed.radius = volume->enclosingRadius();
    placed.inner = volume->innerRadius() + volume->radii().r;
  }
  if (!placed.centre.allFinite() || !std::isfinite(placed.radius)) {  // a half space, whose box is infinite
    placed.centre = pose.translation();
    placed.radius = kInfinity;
  } else {
    largest_ = std::max(largest_, placed.radius);
  }
  bodies_.push_back(placed);
}

void CollisionChecker::Impl::addPair(const CheckedPair& pair) {
  requireBodies(pair, *geometry_, obstacles_.size(), "CollisionChecker");
  Pair added{};
  added.a = at(pair.body);
  added.b = at(pair.other) + (pair.obstacle ? geometry_->bodies.size() : 0);
  const Placed &a = bodies_[added.a], &b = bodies_[added.b];
  added.bend = b.body.volume ? 0.5 * b.body.volume->radii().R : kInfinity;
  added.rounding = kGapRounding * (a.radius + b.radius);
  if (a.convex && b.convex) added.rounding += kGapRounding * (a.body.extent() + b.body.extent());
  if (b.body.volume) added.rounding += kGapRounding * b.body.volume->radii().R;  // 1 + u.w for |t|^2 / 2
  checked_.push_back(added);
}

void CollisionChecker::Impl::setMargin(double margin) {
  if (std::isnan(margin)) throw Error("CollisionChecker: the margin is not a number");
  margin_ = margin;
  for (std::size_t p = 0; p < checked_.size(); ++p) {
    const Pair& pair = checked_[p];
    const double reach = bodies_[pair.a].radius + bodies_[pair.b].radius + margin;
    near_.set(p, pair.a, pair.b,
              reach >= 0 ? reach : kInfinity);  // spheres say nothing about so deep an overlap
  }
}

bool CollisionChecker::Impl::place(const ConstVector& q) {
  ++work_.configurations;
  if (q.size() != kinematics_->size() || !q.allFinite()) return false;
  kinematics_->forwardPoses(q, state_);
  placeSpheres();
  constexpr double kMost = 1e-3;  // m; links so far away that rounding moves them more are nowhere
  return slack_ < kMost;
}

FCL_STPBV_VECTORIZED
void CollisionChecker::Impl::placeSpheres() {
  Packed most{};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Placed& body = bodies_[i];
    const Isometry3d& frame = state_.link[body.frame];
    const Packed c = turned(frame, pack3(body.centre)) + column(frame, 3);
    centres_[i].at = c;
    most = larger(most, larger(c, -c));
  }
  // The products of a chain of links and the poses of both bodies, each off by some units in the last place.
  slack_ = 2 * kGapRounding * (largest(most) + largest_);
}

// After more of a turn the plane tells little, and a search from the centres takes fewer steps than one from
// there.
bool CollisionChecker::Impl::isRecent(const Pair& pair) const {
  constexpr double kTurn2 = 0.01;  // (0.1 rad)^2
  return pair.kept && turnSince(pair.plane, state_.link[bodies_[pair.a].frame],
                                state_.link[bodies_[pair.b].frame]) < kTurn2;
}

double CollisionChecker::Impl::planeGap(Pair& pair) const {
  if (!pair.lifted) lift(pair);
  const Placed &a = bodies_[pair.a], &b = bodies_[pair.b];
  return gapAlong(pair.plane, state_.link[a.frame], state_.link[b.frame], centres_[pair.a], centres_[pair.b],
                  b.radius, pair.bend) -
         pair.rounding - slack_;
}

bool CollisionChecker::Impl::isClear(const NearPair& near) {
  Pair& pair = checked_[at(near.pair)];
  ++work_.near;
  const double within = bodies_[pair.a].inner + bodies_[pair.b].inner + margin_ - slack_ - pair.rounding;
  bool clear = false;
  if (!(within > 0 && near.apart2 < within * within)) {
    if (!isRecent(pair))
      pair.cache = {};
    else if (planeGap(pair) > margin_)
      return true;
    ++work_.searched;
    clear = searchSaysClear(pair);
  }
  if (clear) {
    keepPlane(pair);
  } else {
    pair.lastHit = work_.configurations;
    pair.kept = false;
    pair.cache = {};
  }
  return clear;
}

bool CollisionChecker::Impl::searchSaysClear(Pair& pair) {
  Placed &a = bodies_[pair.a], &b = bodies_[pair.b];
  const ConvexBody &one = posed(a), &other = posed(b);
  const double margin = margin_ + slack_;
  if (one.volume && other.volume)
    return isFartherThan(margin, *one.volume, one.pose, *other.volume, other.pose, &pair.cache);
  if (a.convex && b.convex && !(one.unbounded() && other.unbounded()))
    return isFartherThan(margin, one, other, &pair.cache);
  return isFartherThan(margin, *a.geometry, one.pose, *b.geometry, other.pose, {&pair.cache, nullptr});
}

// Along the normal that the pair's cache holds now.
void CollisionChecker::Impl::keepPlane(Pair& pair) const {
  const Placed &a = bodies_[pair.a], &b = bodies_[pair.b];
  const double length = pair.cache.normal.norm();
  pair.kept = a.convex && b.convex && !a.body.unbounded() && !b.body.unbounded() && length > 0.5;
  pair.lifted = false;
  if (!pair.kept) return;
  const Vector3d n = pair.cache.normal / length;
  pair.plane.outward[0] = pack3(state_.link[a.frame].linear().transpose() * n);
  pair.plane.outward[1] = pack3(state_.link[b.frame].linear().transpose() * -n);
}

void CollisionChecker::Impl::lift(Pair& pair) const {
  pair.plane.height = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const Placed& placed = bodies_[side == 0 ? pair.a : pair.b];
    ConvexBody body = placed.body;
    body.pose = placed.inFrame;
    const Vector3d outward = unpack(pair.plane.outward[side]);
    const int patch = pair.cache.patch[side];
    pair.plane.height += body.support(outward, patch) - outward.dot(placed.centre - body.pose.translation());
    if (side == 1 && body.volume)
      pair.plane.touching =
          pack3(body.pose * body.volume->surfacePoint(body.pose.linear().transpose() * outward, patch) -
                placed.centre);
  }
  pair.lifted = true;
}

std::optional<Hit> CollisionChecker::Impl::firstHit(const ConstVector& q) {
  if (!place(q)) return Hit{};
  near_.compare(centres_, slack_);
  std::sort(near_.begin(), near_.end(), [&](const NearPair& x, const NearPair& y) {
    const long hitX = checked_[at(x.pair)].lastHit, hitY = checked_[at(y.pair)].lastHit;
    return hitX != hitY ? hitX > hitY : x.pair < y.pair;
  });
  for (const NearPair& near : near_)
    if (!isClear(near)) return hitOf(near.pair);
  return std::nullopt;
}

const std::vector<Hit>& CollisionChecker::Impl::allHits(const ConstVector& q) {
  hits_.clear();
  if (!place(q)) {
    hits_.push_back({});
    return hits_;
  }
  near_.compare(centres_, slack_);
  for (const NearPair& near : near_)
    if (!isClear(near)) hits_.push_back(hitOf(near.pair));
  return hits_;
}

double CollisionChecker::Impl::measured(Pair& pair) {
  Placed &a = bodies_[pair.a], &b = bodies_[pair.b];
  const ConvexBody &one = posed(a), &other = posed(b);
  const bool convex = a.convex && b.convex && !(one.unbounded() && other.unbounded());
  Distance found;
  if (convex) {
    found = distance(one, other, &pair.cache);
  } else {
    const DistanceAnswer answer =
        distance(*a.geometry, one.pose, *b.geometry, other.pose, {&pair.cache, nullptr});
    found.status = answer.status;
    found.distance = answer.distance;
  }
  if (found.status == DistanceStatus::invalid) return kLowest;
  keepPlane(pair);
  return found.distance;
}

// From the pair that was closest last, so that the bounds of most others suffice.
double CollisionChecker::Impl::minDistance(const ConstVector& q) {
  if (!place(q)) return kLowest;
  std::size_t first = closest_;
  double least = kInfinity;
  const auto ask = [&](std::size_t p) {
    const double found = measured(checked_[p]);
    if (!(found < least)) return;
    least = found;
    closest_ = p;
  };
  ask(first);
  for (std::size_t p = 0; p < checked_.size() && least > kLowest; ++p) {
    Pair& pair = checked_[p];
    if (p == first) continue;
    const Packed d = centres_[pair.b].at - centres_[pair.a].at;
    const double apart = std::sqrt(dot(d, d));
    const double gap = apart - bodies_[pair.a].radius - bodies_[pair.b].radius - slack_;
    if (gap > least && apart < kInfinity) continue;
    if (isRecent(pair) && planeGap(pair) > least) continue;
    ask(p);
  }
  return least;
}

void CollisionChecker::Impl::forget() {
  for (Pair& pair : checked_) {
    pair.kept = false;
    pair.cache = {};
  }
}

CollisionChecker::CollisionChecker(std::shared_ptr<const Kinematics> kinematics,
                                   std::shared_ptr<const RobotGeometry> geometry,
                                   std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles,
                                   double margin)
    : impl_(std::make_unique<Impl>(std::move(kinematics), std::move(geometry), std::move(pairs),
                                   std::move(obstacles), margin)) {}
CollisionChecker::CollisionChecker(const CollisionChecker& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker::~CollisionChecker() = default;

const std::vector<CheckedPair>& CollisionChecker::pairs() const { return impl_->pairs(); }
const Kinematics& CollisionChecker::kinematics() const { return impl_->kinematics(); }
std::string CollisionChecker::name(int pair) const { return impl_->name(pair); }
double CollisionChecker::margin() const { return impl_->margin(); }
void CollisionChecker::setMargin(double margin) { impl_->setMargin(margin); }
bool CollisionChecker::collides(const ConstVector& q) { return impl_->firstHit(q).has_value(); }
std::optional<Hit> CollisionChecker::firstHit(const ConstVector& q) { return impl_->firstHit(q); }
const std::vector<Hit>& CollisionChecker::allHits(const ConstVector& q) { return impl_->allHits(q); }
double CollisionChecker::minDistance(const ConstVector& q) { return impl_->minDistance(q); }
const CheckerWork& CollisionChecker::work() const { return impl_->work(); }
void CollisionChecker::forget() { impl_->forget(); }

}  // namespace fcl_stpbv
