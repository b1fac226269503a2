// The normals that remain in a cutting-plane search over directions: a convex polygon in the plane of the
// points z + u x + v y (gnomonic projection), in numbers of any precision.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace fcl_stpbv::test {

template <class Real>
class NormalPolygonOf {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;

  /// All normals n around the unit vector z for which |n.x| and |n.y| are at most `half` times n.z.
  NormalPolygonOf(const Vector3& z, Real half)
      : z_(z),
        x_(z.unitOrthogonal()),
        y_(z.cross(x_)),
        corners_{{-half, -half}, {half, -half}, {half, half}, {-half, half}} {}

  /// Keeps the normals n with g.n >= 0. @returns false if no area is left.
  bool cut(const Vector3& g) {
    const auto side = [&](const Vector2& c) { return g.dot(z_ + c.x() * x_ + c.y() * y_); };
    std::vector<Vector2> kept;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Vector2 &from = corners_[k], &to = corners_[(k + 1) % corners_.size()];
      const Real f = side(from), t = side(to);
      if (f >= 0) kept.push_back(from);
      if ((f < 0) != (t < 0)) kept.push_back(from + (to - from) * (f / (f - t)));
    }
    if (kept.size() < 3) return false;
    corners_ = kept;
    Real area = 0;
    Vector2 sum(0, 0);
    size_ = 0;
    for (std::size_t k = 1; k + 1 < corners_.size(); ++k) {
      const Vector2 p = corners_[k] - corners_[0], q = corners_[k + 1] - corners_[0];
      const Real w = p.x() * q.y() - p.y() * q.x();
      area += w;
      sum += w * (p + q) / 3;
      size_ = std::max<Real>({size_, p.norm(), q.norm()});
    }
    if (!(area > 0)) return false;
    centroid_ = corners_[0] + sum / area;
    return true;
  }

  /// The normal at the centroid, with the length that the projection gives it.
  Vector3 centre() const { return z_ + centroid_.x() * x_ + centroid_.y() * y_; }
  /// Distance of the first corner to the farthest one, after a cut.
  Real size() const { return size_; }

 private:
  using Vector2 = Eigen::Matrix<Real, 2, 1>;

  Vector3 z_, x_, y_;
  std::vector<Vector2> corners_;
  Vector2 centroid_{0, 0};
  Real size_ = 0;
};

using NormalPolygon = NormalPolygonOf<long double>;

}  // namespace fcl_stpbv::test
