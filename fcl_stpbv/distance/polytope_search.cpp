#include "fcl_stpbv/distance/polytope_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Climbs both vertex graphs to the vertices furthest along `d` and, in the second body's frame, `e`, side by
/// side: neither waits for the other.
void climb(const StpBv& a, const Vector3d& d, int& i, const StpBv& b, const Vector3d& e, int& j) {
  const Eigen::Vector3f up = d.cast<float>(), down = e.cast<float>();
  const float level = StpBv::kLevel * up.lpNorm<1>();
  for (int step = a.vertexCount() + b.vertexCount(); step > 0; --step) {
    const int overA = a.uphill(i, up, level), overB = b.uphill(j, down, level);
    if (overA == i && overB == j) break;
    i = overA;
    j = overB;
  }
}

/// Up to four points of the difference of the two bodies, reduced to those that span the point nearest the
/// origin.
class Simplex {
 public:
  int count = 0;
  std::array<Vector3d, 4> w{Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0)};

  void add(const Vector3d& p) { w[static_cast<std::size_t>(count++)] = p; }

  bool holds(const Vector3d& p) const {
    for (int i = 0; i < count; ++i)
      if (w[static_cast<std::size_t>(i)] == p) return true;
    return false;
  }

  /// Nearest point to the origin; false when the points surround it.
  bool nearest(Vector3d& v) {
    switch (count) {
      case 1:
        v = w[0];
        return true;
      case 2:
        v = segment(w[0], w[1]);
        return true;
      case 3:
        v = triangle(w[0], w[1], w[2]);
        return true;
      default:
        return tetrahedron(v);
    }
  }

 private:
  void set(const Vector3d& p) {
    w[0] = p;
    count = 1;
  }
  void set(const Vector3d& p, const Vector3d& q) {
    w[0] = p;
    w[1] = q;
    count = 2;
  }

  // Points by value: they may be those of `w`, which is overwritten.
  Vector3d segment(Vector3d p, Vector3d q) {
    const Vector3d e = q - p;
    const double t = -p.dot(e), length2 = e.squaredNorm();
    if (t <= 0.0 || !(length2 > 0.0)) {
      set(p);
      return p;
    }
    if (t >= length2) {
      set(q);
      return q;
    }
    set(p, q);
    return p + (t / length2) * e;
  }

  /// Regions of a triangle by the signs of its barycentric coordinates (Ericson, Real-Time Collision
  /// Detection, 5.1.5).
  Vector3d triangle(Vector3d a, Vector3d b, Vector3d c) {
    const Vector3d ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0.0 && d2 <= 0.0) return set(a), a;
    const double d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0.0 && d4 <= d3) return set(b), b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return set(a, b), a + d1 / (d1 - d3) * ab;
    const double d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0.0 && d5 <= d6) return set(c), c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return set(a, c), a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
      return set(b, c), b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    w[0] = a;
    w[1] = b;
    w[2] = c;
    count = 3;
    const Vector3d normal = ab.cross(ac);  // better conditioned than the sum of three terms
    return normal * (normal.dot(a) / normal.squaredNorm());
  }

  /// The last point is the new one, so the nearest point lies on one of the three faces with it.
  bool tetrahedron(Vector3d& v) {
    const Vector3d first = w[0], second = w[1], third = w[2], last = w[3];
    Simplex best;
    double least = -1.0;
    const auto face = [&](const Vector3d& p, const Vector3d& q, const Vector3d& opposite) {
      const Vector3d normal = (p - last).cross(q - last);
      if (-normal.dot(last) * normal.dot(opposite - last) > 0.0) return;  // the origin is on the inner side
      const Vector3d candidate = triangle(p, q, last);
      const double length2 = candidate.squaredNorm();
      if (least >= 0.0 && length2 >= least) return;
      least = length2;
      v = candidate;
      best = *this;
    };
    face(first, second, third);
    face(second, third, first);
    face(third, first, second);
    if (least < 0.0) return false;
    *this = best;
    return true;
  }
};

Vector3d difference(const BodyPair& pair, int i, int j) { return unpack(pair.vertexDifference({i, j})); }

/// Nears the simplex to the origin until its features are those that face each other.
void descend(const BodyPair& pair, Simplex& simplex, Vector3d& v, VertexSearch& result) {
  constexpr int kIterations = 20;
  constexpr double kGap =
      1e-5;  // relative; which features face each other is settled long before their distance
  int &i = result.vertex[0], &j = result.vertex[1];
  simplex.nearest(v);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double v2 = v.squaredNorm();
    if (!(v2 > 1e-24)) return;
    climb(pair.a(), v, i, pair.b(), pair.opposite(v), j);
    const Vector3d w = difference(pair, i, j);
    if (v2 - v.dot(w) <= kGap * v2 || simplex.holds(w)) break;
    simplex.add(w);
    if (!simplex.nearest(v)) {
      result.surrounded = true;
      result.corner = simplex.w;
      return;
    }
  }
  result.apart = true;
  result.n = v.normalized();
}

}  // namespace

FCL_STPBV_VECTORIZED
VertexSearch searchVertices(const BodyPair& pair, const Vector3d& n) {
  // The support vertices along `n`, and of either body the one beside it that is next.
  const StpBv &a = pair.a(), &b = pair.b();
  const Vector3d m = pair.opposite(n);
  VertexSearch result;
  int &i = result.vertex[0], &j = result.vertex[1];
  i = a.vertexNear(n);
  j = b.vertexNear(m);
  climb(a, n, i, b, m, j);
  Simplex simplex;
  simplex.add(difference(pair, i, j));
  simplex.add(difference(pair, a.beside(i, n.cast<float>(), 1.0f), j));
  simplex.add(difference(pair, i, b.beside(j, m.cast<float>(), 1.0f)));
  Vector3d v = n;
  descend(pair, simplex, v, result);
  return result;
}

FCL_STPBV_VECTORIZED
Vector3d vertexDifference(const BodyPair& pair, const Vector3d& n) {
  const Vector3d m = pair.opposite(n);
  int i = pair.a().vertexNear(n), j = pair.b().vertexNear(m);
  climb(pair.a(), n, i, pair.b(), m, j);
  return difference(pair, i, j);
}

}  // namespace fcl_stpbv
