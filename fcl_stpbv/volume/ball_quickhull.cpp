// Quickhull (Barber, Dobkin, Huhdanpaa 1996) with balls in place of planes:
// 1. four points far apart make the first surface; each face lists points outside its ball;
// 2. a face's farthest point enters: the faces whose balls do not hold it give way to new ones that join it
//    to their rim, and the points in their lists go to the new faces or, inside all of them, nowhere;
// 3. done when all lists are empty.
// In the space of the balls' centres step 2 cuts a ball around the point out of a convex body. What it
// cuts off is one disc, and the rim a single loop, unless it takes the middle of an arc and leaves
// both ends, or the other way round: such clouds are left to the rolling ball. Sides are decided
// exactly, in double where that is certain (quick_ball.h).
#include "fcl_stpbv/volume/ball_quickhull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "fcl_stpbv/volume/quick_ball.h"
#include "fcl_stpbv/volume/space_order.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
constexpr int kNone = -1;

class Quickhull {
 public:
  Quickhull(const std::vector<Vector3d>& points, double radius)
      : radius_(radius), same_(touchTolerance(points)), order_(spaceOrder(points)) {
    points_.reserve(order_.size());
    for (const int i : order_) points_.push_back(points[static_cast<std::size_t>(i)]);
    next_.assign(points_.size(), kNone);
    newFrom_.assign(points_.size(), kNone);
  }

  // False where the cloud needs the rolling ball.
  bool make();
  std::vector<Ring> triangles() const;
  bool mayJoin = false;
  long asked = 0;

 private:
  struct Face {
    std::array<int, 3> corner;  // counter-clockwise seen from outside
    std::array<int, 3> beside;  // the face over the side from that corner on
    QuickBall ball;
    int first = kNone;     // of the points outside that it lists
    int farthest = kNone;  // among them
    double height = 0;     // of that one
    int round = 0;         // the last round in which it was asked whether it sees a point
    bool sees = false;     // what it said
    bool isGone = false;
  };
  struct Rim {
    int from, to, beyond, within;  // a side's ends, the face that stays and the one that goes
  };

  const Vector3d& at(int i) const { return points_[static_cast<std::size_t>(i)]; }
  Face& face(int f) { return faces_[static_cast<std::size_t>(f)]; }
  int sideOf(int f, int point) {
    double height = 0;
    ++asked;
    return face(f).ball.side(at(point), &height);
  }
  int addFace(int a, int b, int c);
  bool start();
  bool enter(int f);
  bool findRim(int p, int f);
  bool isLoop();
  void list(int point, std::vector<int>& among);
  bool isSound();

  double radius_, same_;
  std::vector<int> order_;        // the cloud's indices in the order of points_
  std::vector<Vector3d> points_;  // neighbours in space are near each other
  std::vector<int> next_;         // in the list that holds the point
  std::vector<Face> faces_;
  std::vector<int> free_, waiting_, visible_, fresh_, newFrom_;
  std::vector<Rim> rim_;
  int round_ = 0;
};

int Quickhull::addFace(int a, int b, int c) {
  int f = kNone;
  if (free_.empty()) {
    f = static_cast<int>(faces_.size());
    faces_.emplace_back();
  } else {
    f = free_.back();
    free_.pop_back();
    face(f) = Face();
  }
  face(f).corner = {a, b, c};
  face(f).ball = QuickBall(at(a), at(b), at(c), radius_);
  return f;
}

// Puts a point that no face lists into the list of the first one that it is outside of; to the front with
// that one, for the next point is likely near.
void Quickhull::list(int point, std::vector<int>& among) {
  for (std::size_t k = 0; k < among.size(); ++k) {
    Face& f = face(among[k]);
    double height = 0;
    ++asked;
    if (f.ball.side(at(point), &height) <= 0) continue;
    next_[static_cast<std::size_t>(point)] = f.first;
    f.first = point;
    if (f.farthest == kNone || height > f.height) f.farthest = point, f.height = height;
    if (k > 0) std::swap(among[0], among[k]);
    return;
  }
}

bool Quickhull::start() {
  const int count = static_cast<int>(points_.size());
  const auto farthest = [&](const auto& measure) {
    int best = 0;
    double most = measure(at(0));
    for (int i = 1; i < count; ++i) {
      const double m = measure(at(i));
      if (m > most) most = m, best = i;
    }
    return best;
  };
  const int low = farthest([](const Vector3d& p) { return -p.x() - p.y() - p.z(); });
  const int a = farthest([&](const Vector3d& p) { return (p - at(low)).squaredNorm(); });
  int b = farthest([&](const Vector3d& p) { return (p - at(a)).squaredNorm(); });
  const Vector3d along = at(b) - at(a);
  int c = farthest([&](const Vector3d& p) { return along.cross(p - at(a)).squaredNorm(); });
  const Vector3d up = along.cross(at(c) - at(a));
  const int d = farthest([&](const Vector3d& p) { return std::abs(up.dot(p - at(a))); });
  const double rise = up.dot(at(d) - at(a));
  // Flatter than this, the side of the first faces' planes is rounding.
  constexpr double kFlat = 1e-9;
  if (!(std::abs(rise) > kFlat * along.norm() * up.norm())) return false;
  if (rise > 0) std::swap(b, c);
  // d is below a, b, c.
  const std::array<int, 4> first{addFace(a, b, c), addFace(a, d, b), addFace(b, d, c), addFace(c, d, a)};
  face(first[0]).beside = {first[1], first[2], first[3]};
  face(first[1]).beside = {first[3], first[2], first[0]};
  face(first[2]).beside = {first[1], first[3], first[0]};
  face(first[3]).beside = {first[2], first[1], first[0]};
  const std::array<int, 4> opposite{d, c, a, b};
  for (std::size_t k = 0; k < 4; ++k)
    if (!face(first[k]).ball.valid() || sideOf(first[k], opposite[k]) >= 0) return false;
  std::vector<int> among(first.begin(), first.end());
  for (int i = 0; i < count; ++i) list(i, among);
  waiting_.assign(first.begin(), first.end());
  return true;
}

// The faces whose balls do not hold p, from f on, and the rim around them.
bool Quickhull::findRim(int p, int f) {
  ++round_;
  const auto sees = [&](int g) {
    Face& seen = face(g);
    if (seen.round != round_) seen.round = round_, seen.sees = sideOf(g, p) > 0;
    return seen.sees;
  };
  visible_.assign(1, f);
  face(f).round = round_, face(f).sees = true;
  rim_.clear();
  for (std::size_t done = 0; done < visible_.size(); ++done) {
    const int g = visible_[done];
    for (std::size_t k = 0; k < 3; ++k) {
      const int beyond = face(g).beside[k];
      const bool isNew = face(beyond).round != round_;
      if (!sees(beyond))
        rim_.push_back({face(g).corner[k], face(g).corner[(k + 1) % 3], beyond, g});
      else if (isNew)
        visible_.push_back(beyond);
    }
  }
  return rim_.size() >= 3;
}

// Whether the rim is one loop that meets no vertex twice; newFrom_ then leads
// from each vertex to its side's new face.
bool Quickhull::isLoop() {
  bool isSimple = true;
  for (std::size_t k = 0; k < rim_.size(); ++k) {
    int& place = newFrom_[static_cast<std::size_t>(rim_[k].from)];
    isSimple = isSimple && place == kNone;
    place = static_cast<int>(k);
  }
  std::size_t length = 0;
  int k = 0;
  do {
    k = newFrom_[static_cast<std::size_t>(rim_[static_cast<std::size_t>(k)].to)];
    ++length;
  } while (k > 0 && length <= rim_.size());
  return isSimple && k == 0 && length == rim_.size();
}

bool Quickhull::enter(int f) {
  const int p = face(f).farthest;
  if (!findRim(p, f) || !isLoop()) return false;
  fresh_.clear();
  for (const Rim& side : rim_) {
    const int made = addFace(side.from, side.to, p);
    if (!face(made).ball.valid()) return false;
    fresh_.push_back(made);
    face(made).beside[0] = side.beyond;
    std::array<int, 3>& back = face(side.beyond).beside;
    for (std::size_t k = 0; k < 3; ++k)
      if (back[k] == side.within && face(side.beyond).corner[k] == side.to) back[k] = made;
  }
  for (std::size_t k = 0; k < rim_.size(); ++k) {
    const auto after = static_cast<std::size_t>(newFrom_[static_cast<std::size_t>(rim_[k].to)]);
    face(fresh_[k]).beside[1] = fresh_[after];
    face(fresh_[after]).beside[2] = fresh_[k];
  }
  for (const Rim& side : rim_) newFrom_[static_cast<std::size_t>(side.from)] = kNone;
  for (const int g : visible_) {
    for (int i = face(g).first; i != kNone;) {
      const int after = next_[static_cast<std::size_t>(i)];
      if (i != p) list(i, fresh_);
      i = after;
    }
    face(g).isGone = true;
    face(g).first = kNone;
    free_.push_back(g);
  }
  for (const int g : fresh_)
    if (face(g).first != kNone) waiting_.push_back(g);
  return true;
}

bool Quickhull::isSound() {
  const double joined =
      same_ + 1e-9 * same_;  // heights of joined faces, which are computed with other roundings
  for (Face& f : faces_) {
    if (f.isGone) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Face& over = face(f.beside[k]);
      const int from = f.corner[k], to = f.corner[(k + 1) % 3];
      if (!((at(to) - at(from)).norm() > same_)) return false;
      const int opposite = over.corner[0] + over.corner[1] + over.corner[2] - from - to;
      double height = 0;
      if (f.ball.side(at(opposite), &height) > 0) return false;
      mayJoin = mayJoin || !(height < -joined - f.ball.heightError(at(opposite)));
    }
  }
  return true;
}

bool Quickhull::make() {
  if (points_.size() < 4 || !start()) return false;
  while (!waiting_.empty()) {
    const int f = waiting_.back();
    waiting_.pop_back();
    if (face(f).first != kNone && !enter(f)) return false;
  }
  return isSound();
}

std::vector<Ring> Quickhull::triangles() const {
  std::vector<std::array<int, 3>> sorted;
  for (const Face& f : faces_) {
    if (f.isGone) continue;
    std::array<int, 3> t{};
    for (const std::size_t k : {0u, 1u, 2u}) t[k] = order_[static_cast<std::size_t>(f.corner[k])];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    sorted.push_back(t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Ring> rings;
  rings.reserve(sorted.size());
  for (const std::array<int, 3>& t : sorted) rings.emplace_back(t.begin(), t.end());
  return rings;
}

}  // namespace

QuickFaces quickhull(const std::vector<Vector3d>& points, double radius) {
  Quickhull hull(points, radius);
  if (!hull.make()) return {};
  return {hull.triangles(), hull.mayJoin, hull.asked};
}

}  // namespace fcl_stpbv::detail
