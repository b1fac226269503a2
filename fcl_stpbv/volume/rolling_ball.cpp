// Rolls a ball over a cloud (paper, IV.A, Algorithm 1; after Bernardini and others 1999):
// 1. let the ball touch a first, a second and a third point: the first face;
// 2. over each open edge pivot the ball to the point it meets next (point_tree.h);
// 3. stop when no edge is open; check that each face's ball holds its neighbours, else list the faces by
// their
//    definition (ball_faces.h); join faces on one ball (join_faces.cpp).
// Sides are decided by one exact predicate (ball_side.h), so that faces found from different edges agree.
// Angles only order the points to try, but are rounded: where they defeat the roll a small cloud's faces are
// listed by their definition (ball_faces.h).
#include "fcl_stpbv/volume/rolling_ball.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/join_faces.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/open_edges.h"
#include "fcl_stpbv/volume/point_tree.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
constexpr double kDiametral = 1 + 1e-9;  // the edge's own ends must not fall out by rounding

class Roller {
 public:
  Roller(const std::vector<Vector3d>& points, double radius)
      : points_(points),
        radius_(radius),
        curvature_(std::isinf(radius) ? 0 : 1 / radius),
        tree_(points),
        isVertex_(points.size(), 0),
        faceAt_(points.size(), -1),
        open_(points.size()) {
    Vector3d low = points[0], high = points[0];
    for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    extent_ = (high - low).norm();
    same_ = touchTolerance(points);
  }

  void roll();
  std::vector<Ring> faces;
  std::vector<int> loneVertices;  // one or two points that carry no face

 private:
  const Vector3d& at(int i) const { return points_[static_cast<std::size_t>(i)]; }

  // The ball resting on one point, on two, and on three: the start of the roll.
  int touchFirst(const Vector3d& direction, Vector3d* normal) const;
  int touchSecond(int a, const Vector3d& normal) const;
  int touchThird(int a, int b, const Vector3d& across) const;

  // Angle by which the ball, resting on a and b with its normal turned towards `across`, rolls until it
  // leaves p; negative where it never does.
  double leavingAngle(int a, int b, const Vector3d& across, int p) const;
  // The same from the ball at rest, for a point so close to a or b that its own angle is lost in rounding.
  double angleOf(const TouchingBall& ball, int a, int b, const Vector3d& across) const;
  Ring pivot(int a, int b, const Vector3d& across, int candidate, bool lone);
  bool claim(const Ring& ring);
  int leftOnTheWay(int a, int b, const Vector3d& across, double rest);
  void removeTwins(int i);
  bool isLone(int a, int b) const;
  bool start();
  int addFace(Ring ring);
  Vector3d normalAt(int face, int vertex) const {
    return balls_[static_cast<std::size_t>(face)].normalAt(at(vertex));
  }

  const std::vector<Vector3d>& points_;
  double radius_, curvature_, extent_ = 0, same_ = 0;
  PointTree tree_;
  std::vector<char> isVertex_;
  std::vector<TouchingBall> balls_;
  // Faces in lists by their smallest vertex, with which their rings start.
  std::vector<int> faceAt_, nextFace_;
  std::vector<std::vector<char>> matched_;  // per face and corner: the other side is known
  struct Open {
    int face, corner;
  };
  OpenEdges open_;
  std::vector<Open> waiting_;
  mutable std::vector<int> near_;
};

// Moves the ball, holding all points, against `direction` from around them until one stops it; `normal`
// becomes the ball's normal there. With q = p - centre, split into q.d along the direction d and a vector t
// across it, the point p stops it at depth q.d + kappa t^2 / (1 + sqrt(1 - kappa^2 t^2)) below the farthest
// place: no large number in it.
int Roller::touchFirst(const Vector3d& direction, Vector3d* normal) const {
  const Vector3d centre = minimumEnclosingBall(points_).centre;
  int best = -1;
  double deepest = 0;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    if (tree_.isRemoved(i)) continue;
    const Vector3d q = at(i) - centre, across = q - q.dot(direction) * direction;
    const double t = curvature_ * across.norm(), root = std::sqrt(std::max(0.0, 1 - t * t));
    const double depth = q.dot(direction) + across.norm() * t / (1 + root);
    if (best >= 0 && depth <= deepest) continue;
    best = i, deepest = depth;
    *normal = curvature_ * across + root * direction;
  }
  return best;
}

// Tilts the ball about `a` in some direction; returns the point that stops it, the farther one of two.
int Roller::touchSecond(int a, const Vector3d& normal) const {
  const Vector3d aside = normal.unitOrthogonal();
  int best = -1;
  double bestAngle = 0, bestLength = 0;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    if (i == a || tree_.isRemoved(i)) continue;
    const Vector3d q = at(i) - at(a);
    const double x = q.dot(normal), y = q.dot(aside), s = std::hypot(x, y), length = q.norm();
    if (s == 0) continue;
    double angle = std::atan2(y, x) - std::acos(std::max(-1.0, -0.5 * curvature_ * length * length / s));
    while (angle < 0) angle += kTwoPi;
    const bool tie = best >= 0 && std::abs(angle - bestAngle) < 1e-14;
    if (best < 0 || (tie ? length > bestLength : angle < bestAngle))
      best = i, bestAngle = angle, bestLength = length;
  }
  return best;
}

double Roller::leavingAngle(int a, int b, const Vector3d& across, int p) const {
  // In long double: near the smallest radius the arc cosine loses half of its digits.
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Vector edge = (at(b) - at(a)).cast<long double>(), q = (at(p) - at(a)).cast<long double>();
  const Vector w = across.cast<long double>();
  const long double length = edge.norm(), curvature = curvature_, half = curvature * length / 2;
  const Vector u = edge / length;
  const long double constant = curvature / 2 * (q.squaredNorm() - length * q.dot(u));
  const long double scale = std::sqrt(std::max(0.0L, 1 - half * half));
  const long double x = scale * q.dot(w), y = scale * q.dot(u.cross(w)), s = std::hypot(x, y);
  if (s <= std::abs(constant) || s < 1e-14L * length) return -1;
  double angle = static_cast<double>(std::atan2(y, x) - std::acos(-constant / s));
  while (angle < 0) angle += kTwoPi;
  // A point that leaves at once may come out a rounding behind; none stays for a whole turn but a rounding.
  return angle > kTwoPi - 1e-8 ? 0 : angle;
}

double Roller::angleOf(const TouchingBall& ball, int a, int b, const Vector3d& across) const {
  const Vector3d side = (at(b) - at(a)).normalized().cross(across);
  const double angle = std::atan2(ball.normal().dot(side), ball.normal().dot(across));
  return angle < -1e-8 ? angle + kTwoPi : std::max(0.0, angle);
}

int Roller::touchThird(int a, int b, const Vector3d& across) const {
  int best = -1;
  double bestAngle = 0;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    if (i == a || i == b || tree_.isRemoved(i)) continue;
    const double angle = leavingAngle(a, b, across, i);
    if (angle < 0 || (best >= 0 && angle >= bestAngle)) continue;
    if (!TouchingBall(at(b), at(a), at(i), radius_).valid()) continue;
    best = i, bestAngle = angle;
  }
  return best;
}

// Whether a point lies in the ball over the edge as diameter. Only such points can leave the rolling ball and
// come back into it within half a turn, and only where there is one can two vertices be joined by two edges.
bool Roller::isLone(int a, int b) const {
  if (curvature_ == 0) return true;
  std::vector<int> found;
  tree_.within(0.5 * (at(a) + at(b)), 0.5 * (at(b) - at(a)).norm() * kDiametral, &found, 3);
  return found.size() <= 2;
}

// A point that the ball leaves before it has rolled by `rest` and that is back inside by then; -1 where there
// is none. Such a point is out for less than the whole roll: if for less than half a turn it is one of those
// `aside` of the edge, else it is out in the middle of the roll.
int Roller::leftOnTheWay(int a, int b, const Vector3d& across, double rest) {
  const Vector3d edge = at(b) - at(a), u = edge.normalized(), side = u.cross(across);
  std::vector<int> aside;
  tree_.within(at(a) + 0.5 * edge, 0.5 * edge.norm() * kDiametral, &aside);
  const double sine = std::sin(rest), cosine = std::cos(rest), margin = 1e-9 * edge.norm();
  int left = -1;
  double first = rest - 1e-8;  // later ones are still outside at the end
  for (const int i : aside) {
    if (i == a || i == b) continue;
    // A point is highest over the ball when the normal points at it across the edge; most points do not lie
    // in the wedge that the normal sweeps.
    const Vector3d q = at(i) - at(a);
    const double x = q.dot(across), y = q.dot(side);
    if (rest < 3 && (y < -margin || x * sine - y * cosine < -margin)) continue;
    const double angle = leavingAngle(a, b, across, i);
    if (angle >= 0 && angle < first) left = i, first = angle;
  }
  if (left >= 0 || rest < 0.5 * kTwoPi - 1e-6) return left;
  const double half = 0.5 * curvature_ * edge.norm();
  const Vector3d middle = -half * u + std::sqrt(std::max(0.0, 1 - half * half)) *
                                          (std::cos(0.5 * rest) * across + std::sin(0.5 * rest) * side);
  const double tolerance = 4e-15 * extent_;
  const PointTree::Highest top = tree_.highest(at(a), middle, curvature_, tolerance, &near_);
  return top.height > tolerance ? top.index : -1;
}

// Rolls over the edge a -> b away from the face on its left and returns the face where the ball comes to
// rest. `across` is the unit part of the ball's normal across the edge, `candidate` any point it may come to
// rest on; `lone` is isLone(a, b).
Ring Roller::pivot(int a, int b, const Vector3d& across, int candidate, bool lone) {
  std::vector<int> sent;
  for (int round = 0; round < 10000; ++round) {
    const TouchingBall ball(at(b), at(a), at(candidate), radius_);
    if (!ball.valid()) break;
    // What double precision can get wrong in a height over this ball.
    const double tolerance = extent_ * (2e-15 + 4 * ball.normalError());
    // Any point outside leaves the ball before the present candidate does; one close by is quickly found.
    PointTree::Highest top = tree_.highestBeside(round % 2 == 0 ? a : b, at(b), ball.normal(), curvature_);
    if (top.height <= tolerance) top = tree_.highest(at(b), ball.normal(), curvature_, tolerance, &near_);
    if (top.height > tolerance) {
      candidate = top.index;
      continue;
    }
    int outside = -1;
    long double height = 0;
    std::vector<int> touched{b, a, candidate};
    for (const int i : near_) {
      if (i == a || i == b || i == candidate) continue;
      const int side = ball.side(at(i));
      if (side == 0) touched.push_back(i);
      if (side > 0 && (outside < 0 || ball.height(at(i)) > height)) outside = i, height = ball.height(at(i));
    }
    if (outside < 0 && !lone) {
      const double rest = leavingAngle(a, b, across, candidate);
      outside = leftOnTheWay(a, b, across, rest >= 0 ? rest : angleOf(ball, a, b, across));
      // The side of a ball is decided exactly, an angle is not: among near-duplicates it may send the ball
      // back and forth. Where it has been sent once and has not stayed there is no rest.
      if (std::find(sent.begin(), sent.end(), outside) != sent.end()) outside = -1;
      sent.push_back(outside);
    }
    if (outside >= 0) {
      candidate = outside;
      continue;
    }
    touched.erase(std::remove_if(touched.begin(), touched.end(), [&](int i) { return tree_.isRemoved(i); }),
                  touched.end());
    Ring ring = ringOf(points_, ball, b, a, std::move(touched));
    if (claim(ring)) return ring;
    const auto alive = std::find_if(ring.begin() + 2, ring.end(), [&](int i) { return !tree_.isRemoved(i); });
    if (alive == ring.end()) break;
    candidate = *alive;
  }
  throw Error(
      "the rolling ball found no rest: the cloud's coordinates are too close to degenerate for double "
      "precision");
}

// Points closer to i than rounding vanish into it.
void Roller::removeTwins(int i) {
  std::vector<int> twins;
  tree_.within(at(i), same_, &twins);
  for (const int j : twins)
    if (j != i) tree_.remove(j);
}

// Makes the ring's points vertices. False where one of them has vanished into another.
bool Roller::claim(const Ring& ring) {
  for (const int i : ring) {
    if (tree_.isRemoved(i)) return false;
    if (isVertex_[static_cast<std::size_t>(i)]) continue;
    removeTwins(i);
    isVertex_[static_cast<std::size_t>(i)] = 1;
  }
  return true;
}

int Roller::addFace(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  int& first = faceAt_[static_cast<std::size_t>(ring[0])];
  for (int f = first; f >= 0; f = nextFace_[static_cast<std::size_t>(f)]) {
    const Ring& known = faces[static_cast<std::size_t>(f)];
    if (known[1] == ring[1] && known[2] == ring[2]) return f;
  }
  const std::array<int, 3> t = wideTriangle(points_, ring);
  const int face = static_cast<int>(faces.size());
  nextFace_.push_back(first);
  first = face;
  balls_.emplace_back(at(t[0]), at(t[1]), at(t[2]), radius_);
  const int corners = static_cast<int>(ring.size());
  for (int k = 0; k < corners; ++k) {
    const int next = ring[static_cast<std::size_t>((k + 1) % corners)];
    open_.add(ring[static_cast<std::size_t>(k)], next, face, k);
    waiting_.push_back({face, k});
  }
  matched_.emplace_back(ring.size(), 0);
  faces.push_back(std::move(ring));
  return face;
}

// Finds a first face; false where the cloud has none (one point, two points, or collinear ones).
bool Roller::start() {
  // Points nearer to each other than rounding can tell may be touched in the wrong order: then come from
  // elsewhere, along a spiral that has no special relation to any cloud made by hand.
  constexpr int kTries = 64;
  constexpr double kGolden = 2.399963229728653;  // rad, from one to the next
  for (int k = 0; k < kTries; ++k) {
    const double z = 0.7643977126843163 - 1.7 * k / kTries, side = std::sqrt(1 - z * z);
    const Vector3d d(side * std::cos(kGolden * k - 0.6), side * std::sin(kGolden * k - 0.6), z);
    Vector3d normal;
    const int a = touchFirst(d, &normal);
    removeTwins(a);
    const int b = touchSecond(a, normal);
    if (b < 0) {
      loneVertices = {a};
      return false;
    }
    removeTwins(b);
    // Where the ball rests once it has been tilted from a onto b.
    const Vector3d edge = at(b) - at(a), u = edge.normalized(), aside = normal.unitOrthogonal();
    const double x = edge.dot(normal), y = edge.dot(aside), s = std::hypot(x, y);
    const double angle =
        std::atan2(y, x) - std::acos(std::max(-1.0, -0.5 * curvature_ * edge.squaredNorm() / s));
    const Vector3d tilted = std::cos(angle) * normal + std::sin(angle) * aside;
    const Vector3d across = (tilted - tilted.dot(u) * u).normalized();
    const int c = touchThird(a, b, across);
    if (c < 0) {
      loneVertices = {a, b};
      return false;
    }
    try {
      addFace(pivot(a, b, across, c, isLone(a, b)));
      return true;
    } catch (const Error&) {  // the edge from a to b is none
    }
  }
  throw Error(
      "no first face found: the cloud's coordinates are too close to degenerate for double precision");
}

void Roller::roll() {
  if (!start()) return;
  while (!waiting_.empty()) {
    const Open h = waiting_.back();
    waiting_.pop_back();
    auto& isMatched = matched_[static_cast<std::size_t>(h.face)][static_cast<std::size_t>(h.corner)];
    if (isMatched) continue;
    const Ring ring = faces[static_cast<std::size_t>(h.face)];
    const std::size_t k = static_cast<std::size_t>(h.corner);
    const int a = ring[k], b = ring[(k + 1) % ring.size()], c = ring[(k + 2) % ring.size()];

    const bool lone = isLone(a, b);
    int face = lone ? open_.face(b, a) : -1;  // only one edge can join them there
    if (face < 0) {
      const Vector3d u = (at(b) - at(a)).normalized(), m = normalAt(h.face, a);
      face = addFace(pivot(a, b, (m - m.dot(u) * u).normalized(), c, lone));
    }
    const auto close = [&](int from, int to, int owner) {
      const int corner = open_.close(from, to, owner);
      if (corner >= 0) matched_[static_cast<std::size_t>(owner)][static_cast<std::size_t>(corner)] = 1;
      return corner >= 0;
    };
    if (!close(b, a, face) || !close(a, b, h.face) || faces.size() > 2 * points_.size() + 4)
      throw Error(
          "the rolling ball's faces do not close: the cloud's coordinates are too close to degenerate for "
          "double precision");
  }
}

}  // namespace

double flatRadius(const std::vector<Vector3d>& points) {
  Vector3d low = points[0], high = points[0];
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double extent = (high - low).norm();
  return extent > 0 ? 1e15 * extent : 1;
}

namespace {

RolledHull hullOf(const std::vector<Vector3d>& points, std::vector<Ring> faces, std::vector<int> lone,
                  double radius) {
  RolledHull hull;
  hull.faces = joinFaces(points, std::move(faces), radius);
  hull.vertices = std::move(lone);
  for (const Ring& ring : hull.faces) hull.vertices.insert(hull.vertices.end(), ring.begin(), ring.end());
  std::sort(hull.vertices.begin(), hull.vertices.end());
  hull.vertices.erase(std::unique(hull.vertices.begin(), hull.vertices.end()), hull.vertices.end());
  return hull;
}

}  // namespace

RolledHull rollBall(const std::vector<Vector3d>& points, double radius) {
  if (std::isinf(radius)) radius = flatRadius(points);
  Roller roller(points, radius);
  try {
    roller.roll();
  } catch (const Error&) {
    if (points.size() > kMostByDefinition) throw;
    RolledHull hull = hullByDefinition(points, radius);
    if (hull.faces.empty()) throw;
    return hull;
  }
  return hullOf(points, std::move(roller.faces), std::move(roller.loneVertices), radius);
}

RolledHull hullByDefinition(const std::vector<Vector3d>& points, double radius) {
  return hullOf(points, facesByDefinition(points, radius), {}, radius);
}

}  // namespace fcl_stpbv::detail
