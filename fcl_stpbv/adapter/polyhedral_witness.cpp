// FCL's witness points with a stopping criterion that proves convergence.
//
// 1. Compute a first supporting plane from the start's direction. If it separates the hulls, FCL's test would
//    end there, too.
// 2. Otherwise FCL's own GJK intersection test (fcl_gjk.h) leads to a simplex.
// 3. This library's GJK goes on from there until the duality gap is small enough (convex/gjk.h).
// 4. The simplex's vertices name the features on which the witness points lie.
#include "fcl_stpbv/adapter/polyhedral_witness.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_gjk.h"
#include "fcl_stpbv/adapter/posed_hulls.h"
#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// GJK on polytopes ends after finitely many steps, in practice about ten. A hundred steps mean that rounding
// prevents the end.
constexpr int kMaxSteps = 100;
// The gap at which to stop: the rounding of support points, which are about 1 in size. It is a few times
// 2.2e-16.
constexpr double kGapTolerance = 1e-15;
// A corner with a smaller weight does not count: the witness point lies on a smaller feature, and the weight
// is rounding.
constexpr double kMinWeight = 1e-12;

/// Runs FCL's intersection test from the first direction. Returns its simplex, with the hulls' vertices of
/// each corner.
Simplex<HullCorner> runFclGjk(PosedHulls& pair) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = &PosedHulls::ccdSupport<0>;
  ccd.support2 = &PosedHulls::ccdSupport<1>;
  ccd.first_dir = &PosedHulls::ccdFirstDirection;
  ccd.max_iterations = kMaxSteps / 2;
  ccd_simplex_t found;
  // The returned verdict depends on absolute tolerances. The caller's own loop decides from the simplex.
  fcl::detail::libccd_extension::__ccdGJK(&pair, &pair, &ccd, &found);

  Simplex<HullCorner> simplex;
  for (int i = 0; i < ccdSimplexSize(&found); ++i) {
    const ccd_support_t* corner = ccdSimplexPoint(&found, i);
    const std::array<int, 2> v{pair.loggedVertex<0>(corner->v1), pair.loggedVertex<1>(corner->v2)};
    simplex.add({pair.point(1, v[1]) - pair.point(0, v[0]), -kInfinity, v});
  }
  return simplex;
}

/// The distinct vertices of A (0) or B (1) in the simplex, those with the largest weights first. Returns
/// their number.
int verticesOf(const Simplex<HullCorner>& s, std::size_t body, std::array<int, 3>& out) {
  std::array<double, 3> weight{};
  int count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.size); ++i) {
    const int v = s.corner[i].vertex[body];
    std::size_t k = 0;
    while (static_cast<int>(k) < count && out[k] != v) ++k;
    if (static_cast<int>(k) == count) out[k] = v, ++count;
    weight[k] += s.weight[i];
  }
  for (std::size_t i = 1; static_cast<int>(i) < count; ++i)
    for (std::size_t k = i; k > 0 && weight[k] > weight[k - 1]; --k) {
      std::swap(weight[k], weight[k - 1]);
      std::swap(out[k], out[k - 1]);
    }
  while (count > 1 && weight[static_cast<std::size_t>(count) - 1] < kMinWeight) out[at(--count)] = -1;
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

  // If the first plane already separates the hulls, FCL's intersection test would end at that same point.
  Simplex<HullCorner> first;
  first.add(pair.support(n));
  if (!(first.corner[0].gap > 0)) first = runFclGjk(pair);
  const auto found = gjk(pair, first, n, 0.0, kMaxSteps, [&](double lower, double upper) {
    return upper - lower <= std::max(kGapTolerance * (1 + upper), gap * upper);
  });

  result.supports = pair.supports();
  result.direction = poseA.linear() * found.n;
  if (found.verdict == GjkResult<HullCorner>::Verdict::overlap) {
    result.verdict = Verdict::overlapping;
    return result;
  }
  if (!std::isfinite(found.upper)) return result;
  const double metres = 1 / pair.scale();
  result.lower = std::max(0.0, std::min(found.lower, found.upper)) * metres;
  result.upper = found.upper * metres;
  result.verdict = found.lower > 0        ? Verdict::separated
                   : found.upper <= 1e-12 ? Verdict::overlapping  // touching to rounding
                                          : Verdict::failed;
  const Simplex<HullCorner>& answer = found.simplex;
  const std::array<const HullGraph*, 2> hull{&a, &b};
  for (std::size_t body = 0; body < 2; ++body) {
    Vector3d p(0, 0, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(answer.size); ++i)
      p += answer.weight[i] * pair.point(body, answer.corner[i].vertex[body]);
    result.point[body] = poseA * a.centre() + poseA.linear() * (metres * p);
    const int count = verticesOf(answer, body, result.vertices[body]);
    result.feature[body] = hull[body]->featureOf(result.vertices[body].data(), count);
  }
  return result;
}

}  // namespace fcl_stpbv::detail
