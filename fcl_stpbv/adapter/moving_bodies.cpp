// Branch and bound over both hierarchies, to find the two elements that may meet first. Two parts stay apart
// 1. at least for the time that they need to approach each other at their largest speed;
// 2. as long as the plane of the present distance stays between them (for example a floor and everything on
//    it);
// 3. for two elements, also as long as the plane of their own distance stays between them (for example a wall
//    beside the floor).
// Parts that stay apart longer than two elements already found are skipped.
#include "fcl_stpbv/adapter/moving_bodies.h"

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
using Part = PosedGeometry::Part;

constexpr double kSettled = kInfinity;

Cover shorter(const Cover& p, const Cover& q) {
  return {std::min(p.before, q.before), std::min(p.after, q.after)};
}

/// Visitor of descend() that finds the elements that may meet first.
class FirstToMeet {
 public:
  /// `known`: a time for which any two elements stay apart.
  FirstToMeet(const MovingNow& now, double most, const Cover& known)
      : now_(now), known_(known), met_{most, most}, left_{most, most} {}

  /// The time for which all elements stay apart.
  Cover least() const { return shorter(met_, left_); }

  double bound(const Part& a, const Part& b) {
    const double gap = gapOf(now_.pair, a, b, kSettled);
    if (leaveOut(bySpeed(gap))) return kSettled;
    const auto reachA = [&](const Vector3d& d) { return reachOf(a, 0, d); };
    const auto reachB = [&](const Vector3d& d) { return reachOf(b, 1, d); };
    return leaveOut(byPlane(now_.normal, reachA, reachB, boxRounding(a, b))) ? kSettled : gap;
  }

  bool skip(double gap) { return leaveOut(bySpeed(gap)); }

  bool leaves(const Part& a, const Part& b) {
    std::array<ConvexBody, 2> body;
    if (!now_.pair.first.body(a, body[0]) || !now_.pair.second.body(b, body[1])) return false;
    const auto reachA = [&](const Vector3d& d) { return reachOf(body[0], 0, d); };
    const auto reachB = [&](const Vector3d& d) { return reachOf(body[1], 1, d); };
    const double rounding = body[0].rounding + body[1].rounding;
    Cover cover = byPlane(now_.normal, reachA, reachB, rounding);
    if (leaveOut(cover)) return false;
    if (++queries_ <= kQueries) {
      const Distance own = distance(body[0], body[1]);
      if (own.status != DistanceStatus::invalid)
        cover = longer(cover, longer(bySpeed(own.lower), byPlane(own.normal, reachA, reachB, rounding)));
    } else {
      cover = longer(cover, bySpeed(gapOf(now_.pair, a, b, kSettled)));
    }
    met_ = shorter(met_, longer(cover, known_));
    return false;
  }

 private:
  // Distance queries of two elements; more would cost more than they gain.
  static constexpr int kQueries = 256;
  // Share of `met_` from which on parts are left out, because fine meshes have many similar elements.
  static constexpr double kEnough = 0.5;

  double most() const { return std::max(met_.before, met_.after); }
  bool leaveOut(const Cover& cover) {
    if (!(cover.before >= kEnough * met_.before && cover.after >= kEnough * met_.after)) return false;
    left_ = shorter(left_, cover);
    return true;
  }

  Cover bySpeed(double gap) const {
    return speedCover(gap - now_.margin, now_.speed, now_.acceleration, most(), now_.slack);
  }
  /// The cover from the gap along `n` between what both bodies reach.
  template <typename ReachA, typename ReachB>
  Cover byPlane(const Vector3d& n, const ReachA& reachA, const ReachB& reachB, double rounding) const {
    const double gap = -reachB(Vector3d(-n)) - reachA(n) - now_.margin;
    return planeCover(n, gap, reachA, now_.velocity[0], reachB, now_.velocity[1], most(),
                      now_.slack + rounding);
  }

  /// How far a part, or an element, reaches from `about` along `d`, of any length (m).
  double reachOf(const Part& part, std::size_t which, const Vector3d& d) const {
    if (part.body) return reachOf(*part.body, which, d);
    return part.box.reach(now_.pair.toWorld.transpose() * d) +
           d.dot(now_.pose * part.box.centre - now_.about);
  }
  double reachOf(const ConvexBody& body, std::size_t which, const Vector3d& d) const {
    return body.reach(d, now_.about, now_.point[which]);
  }

  const MovingNow& now_;
  const Cover known_;
  Cover met_, left_;  // `met_`: of the elements that were examined; `left_`: of the parts that were left out
  int queries_ = 0;
};

}  // namespace

Cover elementCover(const MovingNow& now, double most, const Cover& known) {
  if (!now.pair.valid || !(now.normal.squaredNorm() > 0)) return known;
  const Part a = now.pair.first.whole(), b = now.pair.second.whole();
  FirstToMeet first(now, most, known);
  if (!first.skip(first.bound(a, b))) descend(now.pair, a, b, first);
  return longer(known, first.least());
}

}  // namespace fcl_stpbv::detail
