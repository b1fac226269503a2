// Corners of a tilted patch at a margin from its edges, in the projection along z:
// 1. Move two lines along a and b inwards by m. Their intersection then moves by m (|a| b - |b| a) / |a x b|.
//    In the projection, |a x b| is the sine of the angle between the edges times the cosine of the patch's
//    tilt.
// 2. So the length of each edge falls linearly with m, and the edges vanish one after the other. The
//    neighbours of an edge that has vanished then meet. When no more edge can vanish, m is the radius of the
//    largest circle.
// 3. As long as that radius is at least the margin, the corners are correct for any tilt, and they move
//    continuously when an edge vanishes.
#include "fcl_stpbv/posture/support_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/convex_polygon.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A patch within 3 degrees of upright is not allowed: along the patch its margin would be more than 20 times
// as wide.
constexpr double kUpright = 0.05;

// The convex hull, without corners that stand out by less than a nanometre: their edges are nearly parallel.
std::vector<Vector2d> plainHull(const std::vector<Vector2d>& points) {
  constexpr double kFlat = 1e-9;
  std::vector<Vector2d> hull;
  for (const int i : convexPolygon(points)) hull.push_back(points[at(i)]);
  for (std::size_t k = 0; hull.size() > 2 && k < hull.size();) {
    const std::size_t n = hull.size();
    const Vector2d &before = hull[(k + n - 1) % n], &after = hull[(k + 1) % n];
    if (cross(hull[k] - before, after - before) <= kFlat * (after - before).norm())
      hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(k));
    else
      ++k;
  }
  return hull;
}

[[noreturn]] void refuseNarrow() {
  throw Error("a contact is narrower than twice the margin; give a smaller margin");
}

}  // namespace

SupportPatch::SupportPatch(const std::vector<Vector3d>& points, double margin) {
  requireNumber("a contact's margin", margin, 0, 1e9);
  if (!(margin > 0)) {
    for (const Vector3d& p : points) points_.push_back({p});
    return;
  }
  if (points.size() < 3) refuseNarrow();
  for (const Vector3d& p : points) centre_ += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += (p - centre_) * (p - centre_).transpose();
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  u_ = axes.col(2);
  v_ = axes.col(1);
  const Vector3d normal = u_.cross(v_);
  std::vector<Vector2d> flat;
  margin_ = margin;
  for (const Vector3d& p : points) {
    flat.emplace_back(u_.dot(p - centre_), v_.dot(p - centre_));
    margin_ = std::max(margin_, margin + std::abs(normal.dot(p - centre_)));
  }
  const std::vector<Vector2d> hull = plainHull(flat);
  if (hull.size() < 3) refuseNarrow();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    edges_.push_back({hull[i], along, along.x() * u_ + along.y() * v_});
  }
  points_.resize(edges_.size());
  choose();
  if (!(radius_ > margin_)) refuseNarrow();
}

SupportPatch::Meeting SupportPatch::meeting(int first, int second) const {
  const Edge &a = edges_[at(first)], &b = edges_[at(second)];
  const double sine = cross(a.along, b.along);
  return {b.from - cross(a.along, b.from - a.from) / sine * b.along,
          (a.length * b.along - b.length * a.along) / (upright_ * sine), sine};
}

// Lets the edges vanish one after the other. The edges that are left at the margin make the corners.
void SupportPatch::choose() {
  constexpr double kParallel = 1e-6;
  std::vector<int> left, kept;
  for (int i = 0; i < static_cast<int>(edges_.size()); ++i) left.push_back(i);
  for (;;) {
    const std::size_t n = left.size();
    std::size_t next = 0;
    radius_ = kInfinity;
    for (std::size_t k = 0; k < n; ++k) {
      const Meeting from = meeting(left[(k + n - 1) % n], left[k]), to = meeting(left[k], left[(k + 1) % n]);
      const Vector2d& along = edges_[at(left[k])].along;
      const double length = along.dot(to.at - from.at), shrinks = along.dot(from.way - to.way);
      if (!(shrinks > 0 && length < radius_ * shrinks)) continue;
      radius_ = length / shrinks;
      next = k;
    }
    if (kept.empty() && radius_ > margin_) kept = left;
    around_ = {left[(next + n - 1) % n], left[next], left[(next + 1) % n]};
    const auto sine = [&](std::size_t i, std::size_t j) {
      return cross(edges_[at(around_[i])].along, edges_[at(around_[j])].along);
    };
    if (n == 3 || sine(0, 2) < kParallel) {
      pull_ = {sine(1, 2), std::max(0.0, sine(2, 0)), sine(0, 1)};
      break;
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(next));
  }
  if (kept.empty()) kept = std::move(left);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const int first = kept[k], second = kept[(k + 1) % kept.size()], n = static_cast<int>(edges_.size());
    const Meeting meet = meeting(first, second);
    const Vector3d local = centre_ + meet.at.x() * u_ + meet.at.y() * v_;
    for (int i = first; i != second; i = (i + 1) % n) points_[at(i)] = {local, first, second, meet.sine};
  }
}

std::vector<Vector3d> SupportPatch::flatCorners() const {
  SupportPatch flat = *this;
  flat.upright_ = 1;
  for (Edge& edge : flat.edges_) edge.length = 1;
  if (!edges_.empty()) flat.choose();
  std::vector<Vector3d> corners;
  for (std::size_t i = 0; i < flat.points_.size(); ++i) {
    const Point& p = flat.points_[i];
    if (p.first < 0)
      corners.push_back(p.local);
    else if (at(p.first) == i)  // the first of the corners at one place
      corners.push_back(p.local +
                        margin_ / p.sine * (edges_[at(p.second)].local - edges_[at(p.first)].local));
  }
  return corners;
}

void SupportPatch::place(const Eigen::Isometry3d& link, const Eigen::Matrix3d& world) {
  world_ = world;
  const auto carry = [&] {
    for (Point& p : points_) p.carried = link * p.local;
  };
  if (edges_.empty()) return carry();
  for (Edge& edge : edges_) {
    edge.turned = link.linear() * edge.local;
    edge.seen = (world * edge.turned).head<2>();
    edge.length = edge.seen.norm();
  }
  normal_ = link.linear() * u_.cross(v_);
  const double cosine = world.row(2).dot(normal_);
  // Near upright a parabola replaces |cosine|, so that nothing is divided by 0.
  const bool steep = std::abs(cosine) < kUpright;
  upright_ = steep ? cosine * cosine / (2 * kUpright) + kUpright / 2 : std::abs(cosine);
  uprightSlope_ = steep ? cosine / kUpright : cosine < 0 ? -1 : 1;
  choose();
  carry();
}

Vector2d SupportPatch::spread(const Point& p) const {
  const Edge &a = edges_[at(p.first)], &b = edges_[at(p.second)];
  return a.length * b.seen - b.length * a.seen;
}

Vector2d SupportPatch::corner(int i) const {
  const Point& p = points_[at(i)];
  const Vector2d seen = (world_ * p.carried).head<2>();
  return p.first < 0 ? seen : Vector2d(seen + margin_ / (upright_ * p.sine) * spread(p));
}

namespace {

// Rates of change of an edge's direction seen from above, and of the edge's length.
template <class Edge>
std::pair<Vector2d, double> changeOf(const Edge& edge, const Eigen::Matrix3d& world,
                                     const Vector3d& angular) {
  const Vector2d rate = (world * angular.cross(edge.turned)).template head<2>();
  return {rate, edge.length > 0 ? edge.seen.dot(rate) / edge.length : 0.0};
}

}  // namespace

Vector2d SupportPatch::cornerRate(int i, const Twist& twist) const {
  const Point& p = points_[at(i)];
  Vector2d rate = (world_ * (twist.linear + twist.angular.cross(p.carried))).head<2>();
  if (p.first < 0) return rate;
  const Edge &a = edges_[at(p.first)], &b = edges_[at(p.second)];
  const auto [da, shorterA] = changeOf(a, world_, twist.angular);
  const auto [db, shorterB] = changeOf(b, world_, twist.angular);
  const double steeper = uprightSlope_ * world_.row(2).dot(twist.angular.cross(normal_));
  const Vector2d change = shorterA * b.seen + a.length * db - shorterB * a.seen - b.length * da;
  return rate + margin_ / (upright_ * p.sine) * (change - steeper / upright_ * spread(p));
}

double SupportPatch::room(int row) const {
  if (row == 0) return radius_ - margin_;
  const double cosine = world_.row(2).dot(normal_);
  return cosine * cosine - kUpright * kUpright;
}

// The circle's centre is at its best place, so to first order its motion on the patch does not change the
// radius. Seen from above, the distances of a centre that stays change with the edges' lengths and the slope
// of the patch.
double SupportPatch::roomRate(int row, const Twist& twist) const {
  const double steeper = world_.row(2).dot(twist.angular.cross(normal_));
  if (row == 1) return 2 * world_.row(2).dot(normal_) * steeper;
  double length = 0, shorter = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Edge& edge = edges_[at(around_[k])];
    length += pull_[k] * edge.length;
    shorter += pull_[k] * changeOf(edge, world_, twist.angular).second;
  }
  return radius_ * (uprightSlope_ * steeper / upright_ - (length > 0 ? shorter / length : 0));
}

}  // namespace fcl_stpbv::detail
