#include "fcl_stpbv/adapter/polyhedral_witness.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_gjk.h"
#include "fcl_stpbv/adapter/posed_hulls.h"
#include "fcl_stpbv/adapter/simplex.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

// GJK on polytopes ends after finitely many steps, in practice some ten; a hundred means rounding has won.
constexpr int kMaxSteps = 100;
// Stop where the gap is at the rounding of support points of about 1, a few times 2.2e-16.
constexpr double kGapTolerance = 1e-15;
// A corner of smaller weight does not hold the witness point: it is the rounding of a point on a smaller
// feature.
constexpr double kMinWeight = 1e-12;

/// FCL's intersection test from the first direction; its simplex with the vertices behind each corner.
Simplex runFclGjk(PosedHulls& pair) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = &PosedHulls::ccdSupportA;
  ccd.support2 = &PosedHulls::ccdSupportB;
  ccd.first_dir = &PosedHulls::ccdFirstDirection;
  ccd.max_iterations = kMaxSteps / 2;
  ccd_simplex_t found;
  // The verdict it returns rests on absolute tolerances; the caller's own loop decides from the simplex.
  fcl::detail::libccd_extension::__ccdGJK(&pair, &pair, &ccd, &found);

  Simplex simplex;
  for (int i = 0; i < ccdSimplexSize(&found); ++i) {
    const ccd_support_t* corner = ccdSimplexPoint(&found, i);
    const int va = pair.loggedVertexA(corner->v1), vb = pair.loggedVertexB(corner->v2);
    simplex.add({pair.pointA(va) - pair.pointB(vb), va, vb});
  }
  return simplex;
}

bool holds(const Simplex& s, const SimplexCorner& c) {
  for (int i = 0; i < s.size; ++i) {
    const SimplexCorner& other = s.corner[static_cast<std::size_t>(i)];
    if (other.vertexA == c.vertexA && other.vertexB == c.vertexB) return true;
  }
  return false;
}

/// The distinct vertices of one body in the simplex, heaviest first; how many.
int verticesOf(const Simplex& s, int SimplexCorner::*vertex, std::array<int, 3>& out) {
  std::array<double, 3> weight{};
  int count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.size); ++i) {
    std::size_t k = 0;
    while (static_cast<int>(k) < count && out[k] != s.corner[i].*vertex) ++k;
    if (static_cast<int>(k) == count) out[k] = s.corner[i].*vertex, ++count;
    weight[k] += s.weight[i];
  }
  for (std::size_t i = 1; static_cast<int>(i) < count; ++i)
    for (std::size_t k = i; k > 0 && weight[k] > weight[k - 1]; --k) {
      std::swap(weight[k], weight[k - 1]);
      std::swap(out[k], out[k - 1]);
    }
  while (count > 1 && weight[static_cast<std::size_t>(count) - 1] < kMinWeight)
    out[static_cast<std::size_t>(--count)] = -1;
  return count;
}

}  // namespace

FCL_STPBV_VECTORIZED
PolyhedralWitness polyhedralWitness(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
                                    const Eigen::Isometry3d& poseB, const WitnessStart& start, double gap) {
  using Verdict = PolyhedralWitness::Verdict;
  PolyhedralWitness result;
  result.vertices = {{{-1, -1, -1}, {-1, -1, -1}}};
  PosedHulls pair(a, poseA, b, poseB, start.vertex);
  if (!pair.usable() || !start.direction.allFinite()) return result;

  const bool remembered = start.direction.squaredNorm() > 0;
  Vector3d n = remembered ? Vector3d(poseA.linear().transpose() * start.direction) : pair.offset();
  if (!(n.squaredNorm() > 0)) n = Vector3d(1, 0, 0);
  n.normalize();
  pair.setFirstDirection(n);

  // The distance loop of GJK on A - B: v the simplex's point nearest to the origin, n = -v/|v| the direction
  // from A to B. Any n gives the lower bound, any v the upper; they meet at the answer (docs/theory.md, 5,
  // for a polytope).
  Simplex simplex, reduced[2];
  double upper = std::numeric_limits<double>::infinity();
  simplex.add(pair.support(n));
  double lower = -simplex.corner[0].point.dot(n);
  // Where the first plane separates the hulls already, FCL's intersection test would end at that same point.
  if (!(lower > 0)) simplex = runFclGjk(pair);
  int best = 0;  // which of `reduced` holds the nearest point so far
  bool inside = false;
  for (int step = 0; step < kMaxSteps; ++step) {
    Simplex& trial = reduced[1 - best];
    const NearestPoint near = reduceToNearest(simplex, trial);
    inside = near.inside;
    const double length = near.point.norm();
    if (inside || !(length < upper)) break;  // no progress: rounding
    best = 1 - best;
    upper = length;
    n = -near.point / length;
    const double enough = std::max(kGapTolerance * (1 + upper), gap * upper);
    if (upper - lower <= enough) break;
    const SimplexCorner next = pair.support(n);
    lower = std::max(lower, -next.point.dot(n));
    if (upper - lower <= enough || holds(trial, next)) break;
    simplex.size = 0;
    for (int i = 0; i < trial.size; ++i) simplex.add(trial.corner[static_cast<std::size_t>(i)]);
    simplex.add(next);
  }

  result.supports = pair.supports();
  result.direction = poseA.linear() * n;
  if (inside || !std::isfinite(upper)) {
    if (inside) result.verdict = Verdict::overlapping;
    return result;
  }
  const double metres = 1 / pair.scale();
  result.lower = std::max(0.0, std::min(lower, upper)) * metres;
  result.upper = upper * metres;
  result.verdict = lower > 0        ? Verdict::separated
                   : upper <= 1e-12 ? Verdict::overlapping  // touching to rounding
                                    : Verdict::failed;
  const Simplex& answer = reduced[best];
  Vector3d pa(0, 0, 0), pb(0, 0, 0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(answer.size); ++i) {
    pa += answer.weight[i] * pair.pointA(answer.corner[i].vertexA);
    pb += answer.weight[i] * pair.pointB(answer.corner[i].vertexB);
  }
  const Vector3d centre = poseA * a.centre();
  result.point = {centre + poseA.linear() * (metres * pa), centre + poseA.linear() * (metres * pb)};
  const int countA = verticesOf(answer, &SimplexCorner::vertexA, result.vertices[0]);
  const int countB = verticesOf(answer, &SimplexCorner::vertexB, result.vertices[1]);
  result.feature = {a.featureOf(result.vertices[0].data(), countA),
                    b.featureOf(result.vertices[1].data(), countB)};
  return result;
}

}  // namespace fcl_stpbv
