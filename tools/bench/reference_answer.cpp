// Reference answers. STP-BVs: test/reference/reference.h, with the library's normal as a rough direction.
// Polyhedra:
// 1. The library's witness names a feature of each body.
// 2. The nearest points of the features' affine spans are computed by Gram and Schmidt in long double.
// 3. The gap between the planes across the distance, over all vertices, proves the result.
#include "tools/bench/reference_answer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/polyhedral_witness.h"

namespace fcl_stpbv::benchmark {

using namespace detail;

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::Vector3L;

namespace {

Vector3L place(const Isometry3d& pose, const Vector3d& p) {
  return pose.linear().cast<long double>() * p.cast<long double>() + pose.translation().cast<long double>();
}

Vector3L vertex(const HullGraph& hull, const Isometry3d& pose, int v) {
  return place(pose, hull.point(v) + hull.centre());
}

/// The difference b - a of the nearest points of two affine spans.
Vector3L spanDifference(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b) {
  std::vector<Vector3L> axes;
  for (const std::vector<Vector3L>* points : {&a, &b})
    for (std::size_t i = 1; i < points->size(); ++i)
      axes.push_back(((*points)[i] - points->front()).normalized());
  // Gram and Schmidt, the longest remainder first.
  constexpr long double kSpan = 1e-12L;  // edges that are parallel span one direction less
  Vector3L rest = b[0] - a[0];
  const auto longer = [](const Vector3L& p, const Vector3L& q) { return p.squaredNorm() < q.squaredNorm(); };
  for (int i = 0; i < 3 && !axes.empty(); ++i) {
    const Vector3L longest = *std::max_element(axes.begin(), axes.end(), longer);
    if (longest.norm() <= kSpan) break;
    const Vector3L u = longest.normalized();
    for (Vector3L& axis : axes) axis -= u.dot(axis) * u;
    rest -= u.dot(rest) * u;
  }
  return rest;
}

std::vector<Vector3L> corners(const HullGraph& hull, const Isometry3d& pose,
                              const std::array<int, 3>& which) {
  std::vector<Vector3L> points;
  for (const int v : which)
    if (v >= 0) points.push_back(vertex(hull, pose, v));
  return points;
}

}  // namespace

Truth smoothTruth(const Bodies& bodies, const Isometry3d& a, const Isometry3d& b) {
  const StpBv &volumeA = bodies.a->volume(), &volumeB = bodies.b->volume();
  Truth truth;
  const Distance start = distance(volumeA, a, volumeB, b);  // any rough direction will do
  const Radii ra = volumeA.radii(), rb = volumeB.radii();
  if (start.status != DistanceStatus::exact || start.distance < -0.99 * (ra.r + rb.r)) return truth;
  const auto placed = [](const StpBv& v, const Isometry3d& pose) {
    return test::referenceBody(v.vertices(), v.radii().r, v.radii().R, pose);
  };
  const test::ReferenceDistance reference =
      referenceDistance(placed(volumeA, a), placed(volumeB, b), start.normal.cast<long double>());
  truth.distance = reference.distance;
  truth.normal = reference.normal;
  truth.proven = std::abs(reference.gap) < 1e-17L;
  return truth;
}

Truth polyhedralTruth(const Bodies& bodies, const Isometry3d& a, const Isometry3d& b) {
  const HullGraph &hullA = bodies.a->hull(), &hullB = bodies.b->hull();
  const PolyhedralWitness w = polyhedralWitness(hullA, a, hullB, b);
  Truth truth;
  if (w.verdict != PolyhedralWitness::Verdict::separated) return truth;
  const Vector3L difference =
      spanDifference(corners(hullA, a, w.vertices[0]), corners(hullB, b, w.vertices[1]));
  truth.distance = difference.norm();
  truth.normal = difference / truth.distance;
  // The distance of the spans is at most that of the features. So it is the distance only together with the
  // planes' gap.
  long double lowest = HUGE_VALL, highest = -HUGE_VALL;
  for (int v = 0; v < hullA.vertexCount(); ++v)
    highest = std::max(highest, truth.normal.dot(vertex(hullA, a, v)));
  for (int v = 0; v < hullB.vertexCount(); ++v)
    lowest = std::min(lowest, truth.normal.dot(vertex(hullB, b, v)));
  // The gap is a lower bound for any normal. The witness gives an upper bound, up to rounding of doubles.
  const long double gap = lowest - highest;
  truth.proven = std::abs(gap - truth.distance) < 1e-17L &&
                 std::abs(truth.distance - static_cast<long double>(w.upper)) < 1e-14L;
  return truth;
}

Errors errorsOf(const Answer& answer, const Truth& truth) {
  const Vector3L normal = answer.direction().cast<long double>();
  return {static_cast<double>(std::abs(static_cast<long double>(answer.distance) - truth.distance)),
          static_cast<double>((normal - truth.normal).norm())};
}

}  // namespace fcl_stpbv::benchmark
