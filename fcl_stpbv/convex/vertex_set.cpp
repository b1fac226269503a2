// The loops over a polytope's vertices that each query takes: four vertices side by side in three registers,
// one for each coordinate.
#include "fcl_stpbv/convex/vertex_set.h"

#include <cmath>
#include <cstring>

#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// Coordinates of four vertices.
struct Four {
  Packed x, y, z;

  explicit Four(const Vector3d* vertices) {
    Packed a, b, c;
    std::memcpy(&a, vertices[0].data(), sizeof a);
    std::memcpy(&b, vertices[0].data() + 4, sizeof b);
    std::memcpy(&c, vertices[0].data() + 8, sizeof c);
    x = __builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 6), c, 0, 1, 2, 5);
    y = __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6);
    z = __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 5, 5, 5), c, 0, 1, 4, 7);
  }
  Packed along(const Vector3d& d) const { return d.x() * x + d.y() * y + d.z() * z; }
};

}  // namespace

// Sums need no coordinate side by side with its like: of four vertices twelve numbers are added as they come.
FCL_STPBV_VECTORIZED
Vector3d middleOf(const Vector3d* vertices, int count) {
  Packed a{}, b{}, c{};
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const double* numbers = vertices[i].data();
    Packed p, q, r;
    std::memcpy(&p, numbers, sizeof p);
    std::memcpy(&q, numbers + 4, sizeof q);
    std::memcpy(&r, numbers + 8, sizeof r);
    a += p, b += q, c += r;
  }
  Vector3d sum(a[0] + a[3] + b[2] + c[1], a[1] + b[0] + b[3] + c[2], a[2] + b[1] + c[0] + c[3]);
  for (; i < count; ++i) sum += vertices[i];
  return sum / count;
}

FCL_STPBV_VECTORIZED
double reachFrom(const Vector3d& point, const Vector3d* vertices, int count) {
  Packed most{};
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const Four four(vertices + i);
    const Packed x = four.x - point.x(), y = four.y - point.y(), z = four.z - point.z();
    most = larger(x * x + y * y + z * z, most);
  }
  double reach2 = largest(most);
  for (; i < count; ++i) reach2 = std::max(reach2, (vertices[i] - point).squaredNorm());
  return std::sqrt(reach2);
}

FCL_STPBV_VECTORIZED
int furthestAlong(const Vector3d& d, const Vector3d* vertices, int count) {
  int best = 0, i = 0;
  double most = d.dot(vertices[0]);
  if (count >= 4) {
    Packed height = Four(vertices).along(d);
    PackedBits where{0, 1, 2, 3};
    PackedBits at = where;
    for (i = 4; i + 4 <= count; i += 4) {
      const Packed next = Four(vertices + i).along(d);
      at += 4;
      const PackedBits higher = next > height;
      where = higher ? at : where;
      height = higher ? next : height;
    }
    best = static_cast<int>(where[0]), most = height[0];
    for (int k = 1; k < 4; ++k)
      if (height[k] > most || (height[k] == most && where[k] < best))
        best = static_cast<int>(where[k]), most = height[k];
  }
  for (; i < count; ++i) {
    const double next = d.dot(vertices[i]);
    if (next > most) best = i, most = next;
  }
  return best;
}

FCL_STPBV_VECTORIZED
int fromHeight(double least, const Vector3d& d, const Vector3d* vertices, int count, int* found, int room) {
  int many = 0, i = 0;
  const auto take = [&](int which) {
    if (many++ < room) found[many - 1] = which;
  };
  for (; i + 4 <= count; i += 4) {
    const Packed height = Four(vertices + i).along(d);
    if (largest(height) < least) continue;
    for (int k = 0; k < 4; ++k)
      if (!(height[k] < least)) take(i + k);
  }
  for (; i < count; ++i)
    if (!(d.dot(vertices[i]) < least)) take(i);
  return many;
}

// Asked for is the sign of w.n + chord |w|, of all w from `v`: that of (w.n) |w.n| + chord^2 w.w.
FCL_STPBV_VECTORIZED
int notBelow(const Vector3d& v, const Vector3d& n, double chord, const Vector3d* vertices, int count,
             Vector3d* found, int room) {
  const auto fourTimes = [](double number) { return Packed{} + number; };
  const Packed x = fourTimes(v.x()), y = fourTimes(v.y()), z = fourTimes(v.z()), nx = fourTimes(n.x()),
               ny = fourTimes(n.y()), nz = fourTimes(n.z()), chord2 = fourTimes(chord * chord);
  int many = 0, i = 0;
  const auto take = [&](int which) {
    if (many++ < room) found[many - 1] = vertices[which];
  };
  for (; i + 4 <= count; i += 4) {
    Four w(vertices + i);
    w.x -= x, w.y -= y, w.z -= z;
    const Packed height = nx * w.x + ny * w.y + nz * w.z,
                 sign = height * larger(height, -height) + chord2 * (w.x * w.x + w.y * w.y + w.z * w.z);
    if (largest(sign) < 0.0) continue;
    for (int k = 0; k < 4; ++k)
      if (!(sign[k] < 0.0)) take(i + k);
  }
  for (; i < count; ++i) {
    const Vector3d w = vertices[i] - v;
    const double height = n.dot(w);
    if (!(height * std::abs(height) + chord2[0] * w.squaredNorm() < 0.0)) take(i);
  }
  return many;
}

}  // namespace fcl_stpbv::detail
