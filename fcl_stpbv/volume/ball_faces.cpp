// Faces of a ball hull, from exact signs only (ball_side.h): orders a ring, and lists all faces by their
// definition (every three points whose ball contains all others).
#include "fcl_stpbv/volume/ball_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <set>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

double touchTolerance(const std::vector<Vector3d>& points) {
  Vector3d low = points[0], high = points[0];
  double largest = 0;
  for (const Vector3d& p : points) {
    low = low.cwiseMin(p), high = high.cwiseMax(p);
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  // Coordinates that were turned and shifted are off by two or three units in their last place, and a face's
  // ball, fixed by three of them, may tilt so that the face's other points are off by several times as much.
  return 32 * std::numeric_limits<double>::epsilon() * std::max(largest, 0.5 * (high - low).maxCoeff());
}

std::array<int, 3> wideTriangle(const std::vector<Vector3d>& points, const std::vector<int>& ring) {
  const auto at = [&](std::size_t k) -> const Vector3d& { return points[detail::at(ring[k])]; };
  std::size_t second = 1, third = 2;
  if (ring.size() > 3) {
    for (std::size_t k = 1; k < ring.size(); ++k)
      if ((at(k) - at(0)).squaredNorm() > (at(second) - at(0)).squaredNorm()) second = k;
    double area = -1;
    for (std::size_t k = 1; k < ring.size(); ++k) {
      const double a = (at(second) - at(0)).cross(at(k) - at(0)).squaredNorm();
      if (a > area) area = a, third = k;
    }
  }
  if (second > third) std::swap(second, third);
  return {ring[0], ring[second], ring[third]};
}

Ring ringOf(const std::vector<Vector3d>& points, const TouchingBall& ball, int from, int to,
            std::vector<int> touched) {
  const auto at = [&](int i) -> const Vector3d& { return points[detail::at(i)]; };
  touched.erase(std::remove_if(touched.begin(), touched.end(), [&](int i) { return i == from || i == to; }),
                touched.end());
  std::sort(touched.begin(), touched.end(), [&](int i, int j) {
    const int turn = ball.turn(at(from), at(i), at(j));
    if (turn != 0) return turn > 0;
    return (at(i) - at(from)).squaredNorm() < (at(j) - at(from)).squaredNorm();
  });
  Ring ring{from, to};
  for (const int i : touched) {
    while (ring.size() > 2 && ball.turn(at(ring[ring.size() - 2]), at(ring.back()), at(i)) <= 0)
      ring.pop_back();
    ring.push_back(i);
  }
  while (ring.size() > 3 && ball.turn(at(ring[ring.size() - 2]), at(ring.back()), at(from)) <= 0)
    ring.pop_back();
  return ring;
}

namespace {

// Indices of the cloud's points, without those within the touch tolerance of an earlier point.
std::vector<int> distinct(const std::vector<Vector3d>& points) {
  const double same = touchTolerance(points);
  std::vector<int> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](int j) { return (points[at(j)] - points[i]).norm() <= same; }))
      kept.push_back(static_cast<int>(i));
  return kept;
}

}  // namespace

std::vector<Ring> facesByDefinition(const std::vector<Vector3d>& points, double radius) {
  const auto at = [&](int i) -> const Vector3d& { return points[detail::at(i)]; };
  const std::vector<int> all = distinct(points);
  std::vector<int> order = all, touched;
  const auto holdsAll = [&](const TouchingBall& ball) {
    touched.clear();
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int side = ball.side(at(order[k]));
      if (side > 0) {  // a point outside one ball is outside many, so it is tested earlier
        std::swap(order[k], order[k / 2]);
        return false;
      }
      if (side == 0) touched.push_back(order[k]);
    }
    return true;
  };
  std::set<Ring> faces;
  for (const int a : all)
    for (const int b : all)
      for (const int c : all) {
        if (b <= a || c <= a || b == c) continue;  // the ring starts with a, its smallest index
        const TouchingBall ball(at(a), at(b), at(c), radius);
        if (!ball.valid() || !holdsAll(ball)) continue;
        touched.push_back(c);  // c touches its own ball, even where rounding hides that
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        const bool isSide = std::none_of(touched.begin(), touched.end(), [&](int i) {
          return i != a && i != b && ball.turn(at(a), at(b), at(i)) <= 0;
        });
        if (!isSide) continue;
        Ring ring = ringOf(points, ball, a, b, touched);
        std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
        faces.insert(std::move(ring));
      }
  return {faces.begin(), faces.end()};
}

}  // namespace fcl_stpbv::detail
