// Depth of overlapping cores: EPA (convex/epa.h) on the difference of two
// STP-BVs, and a search from many starts.
//
// 1. If the certificate proves a maximum to be the global one, nothing else is needed (certificate.h).
// 2. Otherwise a polytope grows from points around it (EPA). Far from the surface, vertices from the
//    direction tables are added. Near it, the support points of the smooth surface and the maxima of the
//    patches there are added.
// 3. A face at the maximum that cannot have a wider gap beyond it is removed from the search. The rest of the
//    polytope bounds the depth, using the curvature of the cores beyond each face.
// 4. If rounding stops the polytope, the result is the best of the maxima from a fixed set of normals,
//    without a bound.
#include "fcl_stpbv/distance/overlap.h"

#include <algorithm>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/distance/box_axes.h"
#include "fcl_stpbv/distance/certificate.h"
#include "fcl_stpbv/distance/vertex_gjk.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// If a face is within this fraction of the depth from the surface, a maximum is likely to be next to it.
constexpr double kNear = 0.03;

/// If the same maximum is found twice, its two normals differ by less than this (rad).
constexpr double kSame = 1e-7;

/// The point of the difference that is furthest against the sample's normal.
Vector3d furthest(const Sample& s) { return s.core * s.n + s.across; }

/// EPA on the difference of two STP-BVs, started around a maximum of the gap.
class CoreEpa {
 public:
  CoreEpa(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Polytope::Origin origin, Sample& x,
          SearchWork& work)
      : pair_(pair),
        rounding_(4.0 * pair.gapRounding()),
        polytope_(corner, origin, pair.a().radii().rho + pair.b().radii().rho),
        x_(x),
        work_(work) {}

  /// Adds the point of the maximum in `x`.
  bool addTop(const LocalMaximum& around) {
    if (!add(furthest(x_))) return false;
    top_ = polytope_.lastPoint();
    around_ = around;
    return true;
  }

  bool add(const Vector3d& p) { return polytope_.sound() && polytope_.expand(p); }

  /// Expands the nearest face repeatedly. True once no face is nearer than the maximum in `x`.
  bool run(double& bound) {
    bool proven = false;
    expandAtNearest(polytope_, [&](const Polytope::Face& nearest) {
      // The polytope lies inside the difference. So if the origin is inside the polytope, the depth along
      // every direction is at least the distance of the nearest face.
      bound = std::min(bound, -std::min({least_, nearest.depth, -x_.core - pair_.gapRounding()}));
      proven = -x_.core - nearest.depth <= rounding_;
      if (proven) return false;
      if (nearest.has(top_) && around_.holdsBeyond(nearest.normal, polytope_.leastAlong(nearest))) {
        polytope_.putAside();
        return true;
      }
      return expandToVertex(nearest) || expandToSurface(nearest);
    });
    return proven;
  }

 private:
  /// Expands with a vertex difference from the direction tables, which is the cheapest point of the
  /// difference. It suffices far from the surface. Near the surface it suffices if it is farther than the
  /// depth: then no wider gap exists along that normal.
  bool expandToVertex(const Polytope::Face& nearest) {
    if (!(nearest.depth > 0.0)) return false;
    const Vector3d vertex = unpack(pair_.differenceAgainst(-nearest.normal));
    const double far = nearest.normal.dot(vertex);
    return (far > (1.0 + kNear) * nearest.depth || far > -x_.core) && polytope_.expand(vertex);
  }

  /// Expands with a point of the smooth surface, or with a new maximum near it. False if the cores are apart.
  bool expandToSurface(const Polytope::Face& nearest) {
    Sample trial = pair_.sampleFrom(-nearest.normal, {-1, -1}, work_.steps);
    if (trial.core > 0.0) {
      x_ = trial;
      return false;
    }
    const Vector3d point = furthest(trial);
    const double open = -trial.core - nearest.depth;
    Vector3d ignored;
    // Next to the known maximum, settle() would find the same one again.
    const bool another = !nearest.has(top_) && open <= kNear * nearest.depth &&
                         settle(pair_, trial, ignored, work_) &&
                         (trial.n - x_.n).squaredNorm() > kSame * kSame;
    const bool better = trial.core > x_.core;
    if (better) x_ = trial;
    if (open <= rounding_ ||
        !((another && better && addTop(localMaximum(pair_, x_))) || polytope_.expand(point)))
      putAside(nearest);
    return true;
  }

  void putAside(const Polytope::Face& nearest) {
    least_ = std::min(least_, nearest.depth);
    polytope_.putAside();
  }

  const BodyPair& pair_;
  double rounding_;  // of a gap, and of the depth of a face, a sum of several gaps (m)
  Polytope polytope_;
  Sample& x_;
  SearchWork& work_;
  Polytope::Index top_ = Polytope::kNone;  // the point of the maximum
  LocalMaximum around_;                    // the region around it without a wider gap
  double least_ = kInfinity;               // least depth of the faces put aside (m)
};

/// Keeps the few best starts. Their normals are far apart, so that they do not all lead to the same maximum.
class Starts {
 public:
  void offer(const Sample& s) {
    constexpr double kNeighbours = 0.97;  // cosine of 14 degrees
    for (int i = 0; i < count_; ++i) {
      Sample& kept = sample_[at(i)];
      if (kept.n.dot(s.n) > kNeighbours) {
        if (s.core > kept.core) kept = s;
        return;
      }
    }
    if (count_ < kKept) {
      sample_[at(count_++)] = s;
      return;
    }
    const auto worst = std::min_element(sample_.begin(), sample_.end(),
                                        [](const Sample& p, const Sample& q) { return p.core < q.core; });
    if (s.core > worst->core) *worst = s;
  }
  Sample* begin() { return sample_.data(); }
  Sample* end() { return sample_.data() + count_; }

 private:
  static constexpr int kKept = 4;
  std::array<Sample, kKept> sample_;
  int count_ = 0;
};

constexpr int kFaces =
    64;  // face normals tried per body; a body with more faces is round, and its faces are small

}  // namespace

FCL_STPBV_VECTORIZED
bool expandPolytope(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Sample& x, double& bound,
                    SearchWork& work) {
  return CoreEpa(pair, corner, Polytope::Origin::inside, x, work).run(bound);
}

FCL_STPBV_VECTORIZED
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, SearchWork& work) {
  const bool top = pair.isStationary(x);
  const WidestProof proof = top ? proveWidest(pair, x) : WidestProof{cornersAround(pair, x), {}};
  if (proof.proven) {
    bound = proof.bound;
    return true;
  }
  const FeatureCorners& known = proof.corners;
  const std::array<Vector3d, 4> normal = normalsAround(x.n);
  std::array<Vector3d, 4> corner;
  for (std::size_t i = 0; i < 4; ++i) corner[i] = unpack(pair.differenceAgainst(normal[i]));
  CoreEpa search(pair, corner, Polytope::Origin::anywhere, x, work);
  for (std::size_t i = 0; i < known.count; ++i) search.add(unpack(known.point[i]));
  if (top)
    search.addTop(proof.around);
  else if (known.count == 0)
    search.add(vertexDifference(pair, x.n));
  if (search.run(bound)) return true;
  // The points were in one plane, or rounding stopped their polytope. Start from points of the smooth
  // surfaces, whose difference has a volume.
  const auto along = [&](const Vector3d& n) { return furthest(pair.sampleFrom(-n, {-1, -1}, work.steps)); };
  const auto place = [](const Vector3d& p) -> const Vector3d& { return p; };
  return spanVolume(Matrix3d::Identity(), pair.gapRounding(), along, place, corner.data()) &&
         CoreEpa(pair, corner, Polytope::Origin::anywhere, x, work).run(bound);
}

FCL_STPBV_VECTORIZED
Sample shallowStart(const BodyPair& pair) {
  const PatchTable &a = pair.tablesA().patches, &b = pair.tablesB().patches;
  Packed along = unnormalizedOr(pair.centreDifference(), Packed{1, 0, 0, 0}).unit();
  std::array<int, 2> patch = pair.near(unpack(along));
  double widest = dot(along, pair.vertexDifference(patch));
  const auto offer = [&](const Packed& n, const Packed& pointA, const Packed& pointB, int onA, int onB) {
    const double gap = dot(n, pointB - pointA);
    if (gap > widest) widest = gap, along = n, patch = {onA, onB};
  };
  for (const int face : pair.tablesA().shallowFaces) {
    const Packed n = pack(a.face(face).normal);
    const int vertex = pair.tablesB().vertexNear[unpack(pair.opposite(n))];
    offer(n, pack(a.face(face).anchor), pair.pose().placed(pack(b.vertex(vertex).point)), face, vertex);
  }
  for (const int face : pair.tablesB().shallowFaces) {
    const Packed n = -(pair.pose().rotation * pack(b.face(face).normal));
    const int vertex = pair.tablesA().vertexNear[unpack(n)];
    offer(n, pack(a.vertex(vertex).point), pair.pose().placed(pack(b.face(face).anchor)), vertex, face);
  }
  return Sample::unevaluated(unpack(along), patch);
}

FCL_STPBV_VECTORIZED
Sample boxStart(const BodyPair& pair) {
  const BoxAxes axes(pair);
  int ignored = 0;
  return pair.sampleFrom(axes.normal(axes.least()), {-1, -1}, ignored);
}

void leastPenetration(const BodyPair& pair, Sample& x, SearchWork& work) {
  constexpr std::array<int, 2> kNoHint{-1, -1};
  Starts starts;
  int ignored = 0;
  const auto tryNormal = [&](const Vector3d& n, const std::array<int, 2>& hint) {
    starts.offer(pair.sampleFrom(n, hint, ignored));
  };
  starts.offer(x);
  for (int code = 0; code < 27; ++code) {
    const int i = code % 3 - 1, j = code / 3 % 3 - 1, k = code / 9 - 1;
    const Vector3d d(i, j, k);
    if (code == 13) continue;
    tryNormal(d.normalized(), kNoHint);
    tryNormal(pair.pose().rotation * d.normalized(), kNoHint);
  }
  const StpBv &a = pair.a(), &b = pair.b();
  const int strideA = 1 + a.faceCount() / kFaces, strideB = 1 + b.faceCount() / kFaces;
  for (int f = 0; f < a.faceCount(); f += strideA)
    tryNormal(a.patch(a.facePatch(f)).axis, {a.facePatch(f), -1});
  for (int f = 0; f < b.faceCount(); f += strideB)
    tryNormal(-(pair.pose().rotation * b.patch(b.facePatch(f)).axis), {-1, b.facePatch(f)});

  for (Sample& start : starts) {
    ascend(pair, start, work);
    if (start.core > x.core) x = start;
  }
}

}  // namespace fcl_stpbv::detail
