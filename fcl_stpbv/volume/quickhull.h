// Quickhull (Barber, Dobkin, Huhdanpaa 1996) with any kind of surface through three points in place of
// planes:
// 1. four points far apart make the first faces; each lists points outside its surface;
// 2. add the farthest point of a face: all faces that it is outside of are replaced by new ones, which
//    connect it to their rim. The points in their lists are moved to the new faces, or dropped if they are
//    inside all;
// 3. stop when all lists are empty.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace fcl_stpbv::detail {

/// Indices of the points along Morton's curve through their bounding box. Of several equal points only the
/// first one is included.
std::vector<int> spaceOrder(const std::vector<Eigen::Vector3d>& points);

/// `Surface` is made from three points, counter-clockwise seen from outside, and a length (m). Its `valid()`
/// is false if the points make no surface. Its `side(p, &height)` returns 1 if p is outside, so that p enters
/// the hull, otherwise 0 or -1. It also sets p's height (m). The three points stay where they are as long as
/// the hull lives.
template <class Surface>
class Quickhull {
 public:
  struct Face {
    std::array<int, 3> corner;  // counter-clockwise seen from outside
    std::array<int, 3> beside;  // beside[k]: the face over the side that starts at corner[k]
    Surface surface;
    int first = kNone;     // the first point in the face's list of points outside
    int farthest = kNone;  // the farthest point in that list
    double height = 0;     // of the point `farthest`
    int round = 0;         // the last round in which a point was tested against the surface
    bool sees = false;     // result of that test: the point is outside
    bool isGone = false;
  };

  Quickhull(const std::vector<Eigen::Vector3d>& points, double length)
      : length_(length), order_(spaceOrder(points)) {
    points_.reserve(order_.size());
    for (const int i : order_) points_.push_back(points[static_cast<std::size_t>(i)]);
    next_.assign(points_.size(), kNone);
    newFrom_.assign(points_.size(), kNone);
  }

  /// False if the points are coplanar or a rim is not a single loop; another method is then needed.
  bool make();

  /// The faces. After make() those that are not gone form the hull.
  std::vector<Face>& faces() { return faces_; }
  const std::vector<Face>& faces() const { return faces_; }
  /// at(): a corner's point. original(): the corner's index in the cloud.
  const Eigen::Vector3d& at(int corner) const { return points_[static_cast<std::size_t>(corner)]; }
  int original(int corner) const { return order_[static_cast<std::size_t>(corner)]; }
  /// Number of point-side tests, a measure of the work.
  long asked() const { return asked_; }

 private:
  using Vector3d = Eigen::Vector3d;
  static constexpr int kNone = -1;
  struct Rim {
    // The ends of a side, the face beyond it, which stays, and the face within, which goes.
    int from, to, beyond, within;
  };

  Face& face(int f) { return faces_[static_cast<std::size_t>(f)]; }
  int sideOf(int f, int point) {
    double height = 0;
    ++asked_;
    return face(f).surface.side(at(point), &height);
  }
  int addFace(int a, int b, int c);
  bool start();
  bool enter(int f);
  bool findRim(int p, int f);
  bool isLoop();
  void list(int point, std::vector<int>& among);

  double length_;
  std::vector<int> order_;        // the index in the cloud of each of points_
  std::vector<Vector3d> points_;  // sorted so that neighbours in space are near each other
  std::vector<int> next_;         // for each point: the next one in the same list
  std::vector<Face> faces_;
  std::vector<int> free_, waiting_, visible_, fresh_, newFrom_;
  std::vector<Rim> rim_;
  int round_ = 0;
  long asked_ = 0;
};

template <class Surface>
int Quickhull<Surface>::addFace(int a, int b, int c) {
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
  face(f).surface = Surface(at(a), at(b), at(c), length_);
  return f;
}

// Puts a point into the list of the first face that it is outside of. That face moves to the front of the
// order, because the next point is likely near.
template <class Surface>
void Quickhull<Surface>::list(int point, std::vector<int>& among) {
  for (std::size_t k = 0; k < among.size(); ++k) {
    Face& f = face(among[k]);
    double height = 0;
    ++asked_;
    if (f.surface.side(at(point), &height) <= 0) continue;
    next_[static_cast<std::size_t>(point)] = f.first;
    f.first = point;
    if (f.farthest == kNone || height > f.height) f.farthest = point, f.height = height;
    if (k > 0) std::swap(among[0], among[k]);
    return;
  }
}

template <class Surface>
bool Quickhull<Surface>::start() {
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
  // If the cloud is flatter than this, only rounding decides on which side of the first faces' planes a point
  // lies.
  constexpr double kFlat = 1e-9;
  if (!(std::abs(rise) > kFlat * along.norm() * up.norm())) return false;
  if (rise > 0) std::swap(b, c);
  // Now d is below the plane of a, b, c.
  const std::array<int, 4> first{addFace(a, b, c), addFace(a, d, b), addFace(b, d, c), addFace(c, d, a)};
  face(first[0]).beside = {first[1], first[2], first[3]};
  face(first[1]).beside = {first[3], first[2], first[0]};
  face(first[2]).beside = {first[1], first[3], first[0]};
  face(first[3]).beside = {first[2], first[1], first[0]};
  const std::array<int, 4> opposite{d, c, a, b};
  for (std::size_t k = 0; k < 4; ++k)
    if (!face(first[k]).surface.valid() || sideOf(first[k], opposite[k]) >= 0) return false;
  std::vector<int> among(first.begin(), first.end());
  for (int i = 0; i < count; ++i) list(i, among);
  waiting_.assign(first.begin(), first.end());
  return true;
}

// Finds all faces that p is outside of, starting with f, and the rim around them.
template <class Surface>
bool Quickhull<Surface>::findRim(int p, int f) {
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

// Whether the rim is one loop that meets no vertex twice. If it is, newFrom_ leads from each vertex to the
// new face over the side that starts there.
template <class Surface>
bool Quickhull<Surface>::isLoop() {
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

template <class Surface>
bool Quickhull<Surface>::enter(int f) {
  const int p = face(f).farthest;
  if (!findRim(p, f) || !isLoop()) return false;
  fresh_.clear();
  for (const Rim& side : rim_) {
    const int made = addFace(side.from, side.to, p);
    if (!face(made).surface.valid()) return false;
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

template <class Surface>
bool Quickhull<Surface>::make() {
  if (points_.size() < 4 || !start()) return false;
  while (!waiting_.empty()) {
    const int f = waiting_.back();
    waiting_.pop_back();
    if (face(f).first != kNone && !enter(f)) return false;
  }
  return true;
}

}  // namespace fcl_stpbv::detail
