// Corners of a tilted patch at a margin from its edges, as seen from above.
// 1. Hull of the points (convex_polygon.h), clipped by its edges moved inwards (Sutherland and Hodgman 1974):
//    which edges make the corners.
// 2. Two lines along a and b, both moved inwards by m, meet m (|a| b - |b| a) / |a x b| from where they met.
//    Seen from above, |a x b| is the sine between the edges times that of the patch's slope.
// 3. As long as every edge keeps a length, the corners are right whatever the tilt.
#include "fcl_stpbv/posture/support_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/convex_polygon.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A patch that is nearer to upright than 3 degrees bears nothing: its margin would be more than 20 times as
// wide along it.
constexpr double kUpright = 0.05;

// A corner of a clipped polygon and the edge of the whole one along whose line it goes on, -1 for none.
struct ClippedCorner {
  Vector2d at;
  int next;
};

// A convex polygon, counter-clockwise, without what is nearer than `margin` to its edges.
std::vector<ClippedCorner> clipped(const std::vector<Vector2d>& hull, double margin) {
  std::vector<ClippedCorner> kept;
  for (const Vector2d& p : hull) kept.push_back({p, -1});
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d& a = hull[i];
    const Vector2d along = (hull[(i + 1) % hull.size()] - a).normalized();
    const auto depth = [&](const Vector2d& p) { return cross(along, p - a) - margin; };
    std::vector<ClippedCorner> cut;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const Vector2d &p = kept[k].at, &q = kept[(k + 1) % kept.size()].at;
      const double dp = depth(p), dq = depth(q);
      if (dp >= 0) cut.push_back(kept[k]);
      if ((dp < 0) != (dq < 0))
        cut.push_back({p + dp / (dp - dq) * (q - p), dp < 0 ? kept[k].next : static_cast<int>(i)});
    }
    kept = std::move(cut);
  }
  return kept;
}

// Without corners that stand out by less than a nanometre, whose edges are next to parallel.
std::vector<Vector2d> plainHull(std::vector<Vector2d> points) {
  constexpr double kFlat = 1e-9;
  std::vector<Vector2d> hull = convexPolygon(std::move(points));
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
  if (!(margin > 0)) {
    for (const Vector3d& p : points) points_.push_back({p, -1, -1, 0});
    corners_ = static_cast<int>(points.size());
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
  const int n = static_cast<int>(hull.size());
  const std::vector<ClippedCorner> kept = n < 3 ? std::vector<ClippedCorner>{} : clipped(hull, margin_);
  if (kept.size() < 3) refuseNarrow();
  for (int i = 0; i < n; ++i) {
    const Vector2d along = (hull[at((i + 1) % n)] - hull[at(i)]).normalized();
    edges_.push_back({along.x() * u_ + along.y() * v_, -1, -1, 1});
  }
  corners_ = static_cast<int>(kept.size());
  for (int k = 0; k < corners_; ++k)
    addPoint(hull, kept[at((k + corners_ - 1) % corners_)].next, kept[at(k)].next);
  for (int k = 0; k < corners_; ++k) {
    const int first = points_[at(k)].first, second = points_[at(k)].second;
    edges_[at(first)].to = edges_[at(second)].from = k;
    for (int between = (first + 1) % n; between != second; between = (between + 1) % n) {
      Edge& edge = edges_[at(between)];
      edge.sign = -1;
      edge.from = addPoint(hull, first, between);
      edge.to = addPoint(hull, between, second);
    }
  }
  for (const Edge& edge : edges_)
    if (edge.from < 0 || edge.to < 0) refuseNarrow();
}

int SupportPatch::addPoint(const std::vector<Vector2d>& hull, int first, int second) {
  constexpr double kParallel = 1e-6;
  if (first < 0 || second < 0 || first == second) refuseNarrow();
  const auto along = [&](int edge) -> Vector2d {
    const Vector3d& t = edges_[at(edge)].local;
    return {u_.dot(t), v_.dot(t)};
  };
  const Vector2d a = along(first), b = along(second);
  const Vector2d &p = hull[at(first)], &q = hull[at(second)];
  const double sine = cross(a, b);
  if (sine < kParallel && (first + 1) % static_cast<int>(hull.size()) != second) refuseNarrow();
  const Vector2d meet =
      (first + 1) % static_cast<int>(hull.size()) == second ? q : p + cross(q - p, b) / sine * a;
  points_.push_back({centre_ + meet.x() * u_ + meet.y() * v_, first, second, sine});
  return static_cast<int>(points_.size()) - 1;
}

std::vector<Vector3d> SupportPatch::flatCorners() const {
  std::vector<Vector3d> corners;
  for (int k = 0; k < corners_; ++k) {
    const Point& p = points_[at(k)];
    corners.push_back(p.local);
    if (p.first >= 0)
      corners.back() += margin_ / p.sine * (edges_[at(p.second)].local - edges_[at(p.first)].local);
  }
  return corners;
}

void SupportPatch::place(const Eigen::Isometry3d& link, const Eigen::Matrix3d& world) {
  world_ = world;
  for (Point& p : points_) p.carried = link * p.local;
  if (edges_.empty()) return;
  for (Edge& edge : edges_) {
    edge.turned = link.linear() * edge.local;
    edge.seen = (world * edge.turned).head<2>();
    edge.length = edge.seen.norm();
  }
  normal_ = link.linear() * u_.cross(v_);
  const double cosine = world.row(2).dot(normal_);
  const bool steep = std::abs(cosine) < kUpright;  // there a parabola, so that nothing is divided by 0
  upright_ = steep ? cosine * cosine / (2 * kUpright) + kUpright / 2 : std::abs(cosine);
  uprightSlope_ = steep ? cosine / kUpright : cosine < 0 ? -1 : 1;
}

Vector2d SupportPatch::spread(const Point& p) const {
  const Edge &a = edges_[at(p.first)], &b = edges_[at(p.second)];
  return a.length * b.seen - b.length * a.seen;
}

Vector2d SupportPatch::corner(const Point& p) const {
  const Vector2d seen = (world_ * p.carried).head<2>();
  return p.first < 0 ? seen : Vector2d(seen + margin_ / (upright_ * p.sine) * spread(p));
}

namespace {

// Change of an edge's direction seen from above, and of its length.
template <class Edge>
std::pair<Vector2d, double> changeOf(const Edge& edge, const Eigen::Matrix3d& world,
                                     const Vector3d& angular) {
  const Vector2d rate = (world * angular.cross(edge.turned)).template head<2>();
  return {rate, edge.length > 0 ? edge.seen.dot(rate) / edge.length : 0.0};
}

}  // namespace

Vector2d SupportPatch::cornerRate(const Point& p, const Twist& twist) const {
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
  if (row == static_cast<int>(edges_.size())) {
    const double cosine = world_.row(2).dot(normal_);
    return cosine * cosine - kUpright * kUpright;
  }
  const Edge& edge = edges_[at(row)];
  if (!(edge.length > 0)) return 0;
  return edge.sign * edge.seen.dot(corner(points_[at(edge.to)]) - corner(points_[at(edge.from)])) /
         edge.length;
}

double SupportPatch::roomRate(int row, const Twist& twist) const {
  if (row == static_cast<int>(edges_.size()))
    return 2 * world_.row(2).dot(normal_) * world_.row(2).dot(twist.angular.cross(normal_));
  const Edge& edge = edges_[at(row)];
  if (!(edge.length > 0)) return 0;
  const Point &from = points_[at(edge.from)], &to = points_[at(edge.to)];
  const Vector2d span = corner(to) - corner(from), along = edge.seen / edge.length;
  const auto [turn, shorter] = changeOf(edge, world_, twist.angular);
  return edge.sign * (along.dot(cornerRate(to, twist) - cornerRate(from, twist)) +
                      span.dot(turn - shorter * along) / edge.length);
}

}  // namespace fcl_stpbv::detail
