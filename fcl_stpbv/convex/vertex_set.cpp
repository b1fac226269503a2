// The loops over a polytope's vertices that every query runs. Four vertices are processed at a time, in three
// registers, one for each coordinate.
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
  using Two = double __attribute__((vector_size(16)));
  Packed x, y, z;

  explicit Four(const Vector3d* vertices) {
    // Loads two numbers at a time into the half of the register where they stay, so no shuffle crosses
    // halves.
    const double* numbers = vertices[0].data();
    const auto twos = [&](int i, int k) {
      Two low, high;
      std::memcpy(&low, numbers + i, sizeof low);
      std::memcpy(&high, numbers + k, sizeof high);
      return __builtin_shufflevector(low, high, 0, 1, 2, 3);
    };
    const Packed xy = twos(0, 6), zx = twos(2, 8), yz = twos(4, 10);
    x = __builtin_shufflevector(xy, zx, 0, 5, 2, 7);
    y = __builtin_shufflevector(xy, yz, 1, 4, 3, 6);
    z = __builtin_shufflevector(zx, yz, 0, 5, 2, 7);
  }
  Packed along(const Vector3d& d) const { return d.x() * x + d.y() * y + d.z() * z; }
};

}  // namespace

FCL_STPBV_VECTORIZED
Spread spreadAbout(const Vector3d& point, const Vector3d* vertices, int count) {
  Packed most{}, sumX{}, sumY{}, sumZ{};
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const Four four(vertices + i);
    const Packed x = four.x - point.x(), y = four.y - point.y(), z = four.z - point.z();
    most = larger(x * x + y * y + z * z, most);
    sumX += four.x, sumY += four.y, sumZ += four.z;
  }
  const Packed sum = sums(sumX, sumY, sumZ, sumZ);
  Spread all{unpack(sum), largest(most)};
  for (; i < count; ++i) {
    all.middle += vertices[i];
    all.reach = std::max(all.reach, (vertices[i] - point).squaredNorm());
  }
  return {all.middle / count, std::sqrt(all.reach)};
}

FCL_STPBV_VECTORIZED
int furthestAlong(const Vector3d& d, const Vector3d* vertices, int count) {
  int best = 0, i = 0;
  double most = d.dot(vertices[0]);
  if (count >= 4) {
    Packed height = Four(vertices).along(d);
    PackedBits where{0, 1, 2, 3};
    const auto take = [&](const Packed& next, const PackedBits& at) {
      const PackedBits higher = next > height;
      where = higher ? at : where;
      height = higher ? next : height;
    };
    PackedBits at = where + 4;
    // Two groups of four are compared with each other first, which need not wait for the earlier groups.
    for (i = 4; i + 8 <= count; i += 8, at += 8) {
      const Packed one = Four(vertices + i).along(d), other = Four(vertices + i + 4).along(d);
      const PackedBits later = other > one;
      take(later ? other : one, later ? at + 4 : at);
    }
    for (; i + 4 <= count; i += 4, at += 4) take(Four(vertices + i).along(d), at);
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

// With w from `v` to a vertex, the sign of w.n + chord |w| decides. It is that of (w.n) |w.n| + chord^2 w.w.
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
  const auto signOf = [&](Four w) {
    w.x -= x, w.y -= y, w.z -= z;
    const Packed height = nx * w.x + ny * w.y + nz * w.z, size = fromBits(bitsOf(height) & ~kSign);
    return height * size + chord2 * (w.x * w.x + w.y * w.y + w.z * w.z);
  };
  const auto takeOf = [&](const Packed& sign, int first) {
    for (int k = 0; k < 4; ++k)
      if (!(sign[k] < 0.0)) take(first + k);
  };
  for (; i + 8 <= count; i += 8) {
    const Packed one = signOf(Four(vertices + i)), other = signOf(Four(vertices + i + 4));
    if (largest(larger(one, other)) < 0.0) continue;
    takeOf(one, i), takeOf(other, i + 4);
  }
  for (; i < count; ++i) {
    const Vector3d w = vertices[i] - v;
    const double height = n.dot(w);
    if (!(height * std::abs(height) + chord2[0] * w.squaredNorm() < 0.0)) take(i);
  }
  return many;
}

}  // namespace fcl_stpbv::detail
