// Finds the pairs of features:
// 1. Each vertex of one body against the box, in the box's frame. If both are boxes, also in the other order.
// 2. Edges against edges, if they are not parallel, face each other, and have their lines' nearest points
//    inside both.
// Pairs that are farther apart than the reach are left out.
#include "tools/bench/control/manifold.h"

#include <cmath>

namespace fcl_stpbv::benchmark {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool isBox(const Solid& s) { return s.corners.size() == 8; }

/// Pairs of vertices and a box. Corner 7 of the box is the one with all coordinates positive.
void vertexPairs(const std::vector<Vector3d>& vertices, const Isometry3d& pose, const Solid& box,
                 const Isometry3d& poseBox, double reach, bool boxFirst, std::vector<FeaturePair>& found) {
  const Vector3d half = box.corners[7];
  const Isometry3d toBox = poseBox.inverse() * pose;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3d x = toBox * vertices[i], inside = x.cwiseMin(half).cwiseMax(-half), away = x - inside;
    const double d = away.norm();
    // A vertex inside the box has no direction; the other vertices keep the pair apart.
    if (!(d > 0) || d > reach) continue;
    const Vector3d n = poseBox.linear() * (away / d), at = poseBox * x, on = poseBox * inside;
    const int key = static_cast<int>(i) + (boxFirst ? 1000 : 0);
    found.push_back(boxFirst ? FeaturePair{d, n, on, at, key} : FeaturePair{d, -n, at, on, key});
  }
}

void edgePairs(const Solid& a, const Isometry3d& poseA, const Solid& b, const Isometry3d& poseB, double reach,
               std::vector<FeaturePair>& found) {
  const auto each = [](const auto& use) {
    for (int i = 0; i < 8; ++i)
      for (int bit = 1; bit < 8; bit *= 2)
        if (!(i & bit)) use(i, i | bit);
  };
  each([&](int a1, int a2) {
    const Vector3d p = poseA * a.corners[static_cast<std::size_t>(a1)],
                   u = poseA * a.corners[static_cast<std::size_t>(a2)] - p;
    each([&](int b1, int b2) {
      const Vector3d q = poseB * b.corners[static_cast<std::size_t>(b1)],
                     v = poseB * b.corners[static_cast<std::size_t>(b2)] - q, w = p - q;
      const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
      // If the edges are parallel, their ends against the other body are enough.
      if (det < 1e-9 * uu * vv) return;
      const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
      if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return;
      const Vector3d first = p + s * u, second = q + t * v, between = second - first;
      const double d = between.norm();
      // Only edges that face each other, with the bodies' centres on either side.
      if (!(d > 0) || d > reach || between.dot(first - poseA.translation()) <= 0 ||
          between.dot(second - poseB.translation()) >= 0)
        return;
      found.push_back({d, between / d, first, second, 2000 + 64 * (8 * a1 + a2) + 8 * b1 + b2});
    });
  });
}

}  // namespace

void featurePairs(const Solid& a, const Isometry3d& poseA, const Solid& b, const Isometry3d& poseB,
                  double reach, std::vector<FeaturePair>& found) {
  vertexPairs(a.corners, poseA, b, poseB, reach, false, found);
  if (!isBox(a)) return;
  vertexPairs(b.corners, poseB, a, poseA, reach, true, found);
  edgePairs(a, poseA, b, poseB, reach, found);
}

}  // namespace fcl_stpbv::benchmark
