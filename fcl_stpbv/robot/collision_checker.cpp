// Checks whether any pair comes within the margin:
// 1. Place the links and their bounding spheres; compare the spheres of four pairs at a time.
// 2. Check the remaining pairs one by one, those that collided most recently first (pair_verdict.cpp).
#include "fcl_stpbv/robot/collision_checker.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/checker_impl.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kLowest = std::numeric_limits<double>::lowest();

}  // namespace

bool CollisionChecker::Impl::place(const ConstVector& q) {
  ++work_.configurations;
  if (q.size() != kinematics_->size() || !q.allFinite()) return false;
  kinematics_->forwardPoses(q, state_, placing_);
  placeSpheres();
  slack_ = 2 * rounding_.most(q);
  constexpr double kMost = 1e-3;  // m; where rounding may move links by more, nothing is known
  return slack_ < kMost;
}

FCL_STPBV_VECTORIZED
void CollisionChecker::Impl::placeSpheres() {
  for (const std::size_t i : placed_) {
    const PlacedBody& body = bodies_[i];
    const Isometry3d& frame = state_.link[body.frame];
    centres_[i].at = turned(frame, pack3(body.centre)) + column(frame, 3);
  }
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

// Starts with the pair that was closest last, so that bounds suffice for most other pairs.
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
    KeptPair& pair = checked_[p];
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
  for (KeptPair& pair : checked_) {
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
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;
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
