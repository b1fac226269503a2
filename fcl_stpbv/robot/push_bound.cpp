// Bounds how far the joints push one point along a normal, with interval bounds on products of exponentials
// (docs/proofs.md).
// 1. If the plane's link is at rest, a point x of a body goes to E_1 E_2 ... E_m x. E_i is the motion about
//    joint i's axis in the middle of the box. The motion of the outermost joint m is applied first, so all
//    axes and the normal n are those of the middle.
// 2. One turn by t moves a point y, with r = y - origin, along n by
//    sin(t) (n x a).r - (1 - cos(t)) (n.r - (n.a)(a.r)) (Rodrigues). push() bounds this over the box. The
//    terms up to second order in the sines are exact; the terms of higher order are bounded.
#include "fcl_stpbv/robot/push_bound.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Weight of the linear part of a push when the coordinate to cut is chosen. A cut halves the linear part,
// while the other parts fall to a quarter.
constexpr double kLinearShare = 0.5;

// Number of joints whose two directions are both tried, if it is not clear which one pushes most: at most 2^8
// corners.
constexpr int kCorners = 8, kCornersOfMany = 4;

// Largest number of joints for which the third order is computed joint by joint, which takes the cube of
// their number.
constexpr std::size_t kThirdOrder = 24;

bool hasThirdOrder(std::size_t joints) { return joints <= kThirdOrder; }

}  // namespace

void PushBound::prepare(const Vector3d& n, const BodySide& side) {
  const std::size_t m = side.joints.size();
  turned_.resize(m);
  tilt_.resize(m);
  way_.resize(m);
  flat_.resize(m);
  coupled_.resize(m * m);
  coupling_.resize(m * m);
  bulged_.resize(m * m);
  bulging_.resize(m * m);
  if (hasThirdOrder(m)) {
    tripled_.resize(m * m * m);
    tripling_.resize(m * m * m);
  }
  lever_.resize(m);
  reach_.resize(m);
  moved_.resize(m + 1);
  share_.resize(m);
  bestShare_.resize(m);
  slope_.resize((m + 1) * m);
  double way = 0;
  const BoxJoint* outer = nullptr;
  for (std::size_t i = m; i-- > 0;) {
    const BoxJoint& joint = side.joints[i].joint;
    turned_[i] = joint.slides ? Vector3d(Vector3d::Zero()) : Vector3d(n.cross(joint.axis));
    tilt_[i] = turned_[i].norm();
    if (joint.slides) {
      way += joint.half;
    } else {
      if (outer) way += (outer->origin - joint.origin).norm();
      outer = &joint;
    }
    way_[i] = way;
  }
  const auto cross = [&](const Vector3d& v, std::size_t l, Vector3d& crossed, double& size) {
    const BoxJoint& joint = side.joints[l].joint;
    crossed = v.cross(joint.axis);
    size = joint.slides ? std::abs(v.dot(joint.axis)) : crossed.norm();
  };
  for (std::size_t i = 0; i < m; ++i) {
    flat_[i] = n - n.dot(side.joints[i].joint.axis) * side.joints[i].joint.axis;
    for (std::size_t l = i + 1; l < m; ++l) {
      const std::size_t at = i * m + l;
      cross(turned_[i], l, coupled_[at], coupling_[at]);
      cross(flat_[i], l, bulged_[at], bulging_[at]);
      for (std::size_t k = l + 1; k < m && hasThirdOrder(m); ++k)
        cross(coupled_[at], k, tripled_[at * m + k], tripling_[at * m + k]);
    }
  }
}

// Upper bound on how far the joints push the point x along n; share_ receives each joint's part.
double PushBound::push(const Vector3d& n, const BodySide& side, const Vector3d& x) {
  const std::size_t m = side.joints.size();
  double fromOuter = -1;
  moved_[m] = 0;
  for (std::size_t i = m; i-- > 0;) {
    const OutwardJoint& o = side.joints[i];
    if (o.joint.slides) {
      moved_[i] = moved_[i + 1] + o.joint.half;
      continue;
    }
    const Vector3d r = x - o.joint.origin;
    if (fromOuter < 0) fromOuter = r.norm();
    lever_[i] = o.joint.axis.cross(r).norm();
    reach_[i] = std::min(lever_[i] + moved_[i + 1], fromOuter + way_[i]);
    moved_[i] = moved_[i + 1] + o.chord * reach_[i];
  }
  std::fill(share_.begin(), share_.end(), 0.0);
  product_.assign(m * m, 0);
  double rest = 0, uncapped = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const OutwardJoint& o = side.joints[i];
    if (o.joint.slides) {
      slope_[i] = o.joint.half * n.dot(o.joint.axis);
      share_[i] += kLinearShare * std::abs(slope_[i]);
      uncapped += std::abs(slope_[i]);
      continue;
    }
    const Vector3d r = x - o.joint.origin;
    slope_[i] = o.sine * turned_[i].dot(r);
    double inwards = 0;
    for (std::size_t l = i + 1; l < m; ++l)
      inwards += along(side, l, bulged_[i * m + l], bulging_[i * m + l], x);
    inwards = std::min(inwards, tilt_[i] * moved_[i + 1]) - flat_[i].dot(r);
    double others = o.bulge * std::max(0.0, inwards);
    share_[i] += kLinearShare * std::abs(slope_[i]) + others;
    double total = std::abs(slope_[i]) + others;
    for (std::size_t l = i + 1; l < m; ++l) {
      const double more = couple(side, i, l, x);
      const double both = std::abs(product_[i * m + l]) + more;
      others += more;
      total += both;
      share_[i] += both / 2;
      share_[l] += both / 2;
    }
    uncapped += total;
    const double most = o.chord * tilt_[i] * reach_[i];
    rest += total <= most ? others : most;
    if (total <= most) continue;
    slope_[i] = 0;
    std::fill_n(product_.begin() + static_cast<std::ptrdiff_t>(i * m), m, 0.0);
  }
  const double sum = rest + mostAtCorners(0, m, hasThirdOrder(m) ? kCorners : kCornersOfMany);
  return shared_ ? std::min(sum, uncapped - together(n, side, x)) : sum;
}

// Upper bound on how far joint l moves x along a direction after the joints further out have moved. `turned`
// is the direction's cross product with the joint's axis, and `size` its length. For a joint that slides,
// `size` is the direction's part along the axis.
double PushBound::along(const BodySide& side, std::size_t l, const Vector3d& turned, double size,
                        const Vector3d& x) const {
  const OutwardJoint& o = side.joints[l];
  if (o.joint.slides) return o.joint.half * size;
  const double exact = o.sine * std::abs(turned.dot(x - o.joint.origin)) +
                       size * (o.bulge * lever_[l] + o.chord * moved_[l + 1]);
  return std::min(exact, size * o.chord * reach_[l]);
}

// How much the push of joint i changes because joint l, further out, has moved the point x. product_ receives
// the part that is proportional to the sines of both. The result bounds all other parts.
double PushBound::couple(const BodySide& side, std::size_t i, std::size_t l, const Vector3d& x) {
  const OutwardJoint &o = side.joints[i], &outer = side.joints[l];
  const std::size_t m = side.joints.size(), at = i * m + l;
  if (outer.joint.slides) {
    product_[at] = o.sine * outer.joint.half * turned_[i].dot(outer.joint.axis);
    return 0;
  }
  const Vector3d r = x - outer.joint.origin;
  const Vector3d& axis = outer.joint.axis;
  product_[at] = o.sine * outer.sine * coupled_[at].dot(r);
  const double moved = coupling_[at] * moved_[l + 1];
  double further = hasThirdOrder(m) ? 0 : moved;
  for (std::size_t k = l + 1; k < m && hasThirdOrder(m); ++k)
    further += along(side, k, tripled_[at * m + k], tripling_[at * m + k], x);
  const double inwards = std::abs(turned_[i].dot(r) - turned_[i].dot(axis) * axis.dot(r)) + moved;
  const double more = o.sine * (outer.bulge * inwards + outer.sine * std::min(further, moved));
  const double most = o.sine * coupling_[at] * outer.chord * reach_[l];
  if (std::abs(product_[at]) + more <= most) return more;
  product_[at] = 0;
  return most;
}

// Maximum of the sum over joints k from i on of (slope s_k + the sum over l > k of product s_k s_l), with
// each s from -1 to 1. It is linear in each s, so it is largest at a corner. The slopes are in slope_ from i
// m on. If a slope outweighs its products, s has its sign. For up to `tries` of the other joints both signs
// are tried. The remaining joints get a bound.
double PushBound::mostAtCorners(std::size_t i, std::size_t m, int tries) {
  if (i == m) return 0;
  const double* slope = &slope_[i * m];
  double* next = &slope_[(i + 1) * m];
  double coupled = 0;
  for (std::size_t l = i + 1; l < m; ++l) coupled += std::abs(product_[i * m + l]);
  const bool decided = std::abs(slope[i]) >= coupled;
  if (!decided && tries == 0) {
    std::copy(slope + i + 1, slope + m, next + i + 1);
    return std::abs(slope[i]) + coupled + mostAtCorners(i + 1, m, tries);
  }
  double best = -kInfinity;
  for (const double sign : {1.0, -1.0}) {
    if (decided && sign * slope[i] < 0) continue;
    for (std::size_t l = i + 1; l < m; ++l) next[l] = slope[l] + sign * product_[i * m + l];
    best = std::max(best, sign * slope[i] + mostAtCorners(i + 1, m, decided ? tries : tries - 1));
    if (decided) break;
  }
  return best;
}

// What is saved where one coordinate moves several joints: their linear parts then add up with their signs,
// once sin(t) is taken as t with an error of at most half - sin(half), which grows with half: past a quarter
// turn, too, where the most that sin(t) itself can be is 1.
double PushBound::together(const Vector3d& n, const BodySide& side, const Vector3d& x) const {
  const std::size_t m = side.joints.size();
  double saved = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const int slot = side.joints[i].joint.slot;
    const auto same = [&](std::size_t l) { return side.joints[l].joint.slot == slot; };
    bool firstOfSlot = true;
    for (std::size_t l = 0; l < i; ++l) firstOfSlot &= !same(l);
    if (!firstOfSlot) continue;
    double half = 0, apart = 0, slope = 0, beyondSlope = 0;
    for (std::size_t l = i; l < m; ++l) {
      if (!same(l)) continue;
      const OutwardJoint& o = side.joints[l];
      const double along = o.joint.slides ? n.dot(o.joint.axis) : turned_[l].dot(x - o.joint.origin);
      half = std::max(half, o.joint.half / std::abs(o.joint.rate));  // too small where the rate is subnormal
      slope += o.outwardRate * along;
      apart += (o.joint.slides ? o.joint.half : o.sine) * std::abs(along);
      if (!o.joint.slides) beyondSlope += (o.joint.half - std::sin(o.joint.half)) * std::abs(along);
    }
    saved += std::max(0.0, apart - (half * std::abs(slope) + beyondSlope));
  }
  return saved;
}

}  // namespace fcl_stpbv::detail
