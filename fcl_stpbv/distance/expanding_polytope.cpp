#include "fcl_stpbv/distance/expanding_polytope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/distance/crown.h"
#include "fcl_stpbv/distance/polytope_search.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Where the polytope is this much of the depth from the surface, a maximum is likely to be next to it.
constexpr double kNear = 0.03;

/// Tilt from the start's normal of those whose points the polytope begins with (rad).
constexpr double kRing = 0.8;

/// Normals of one maximum found twice differ by less (rad).
constexpr double kSame = 1e-7;

/// The difference's point furthest against the sample's normal.
Vector3d furthest(const Sample& s) { return s.core * s.n + s.across; }

/// Three unit vectors across `n`, a third of a turn apart.
std::array<Vector3d, 3> around(const Vector3d& n) {
  const Vector3d e = n.unitOrthogonal(), f = std::sqrt(0.75) * n.cross(e);
  return {e, f - 0.5 * e, -f - 0.5 * e};
}

class Search {
 public:
  Search(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Polytope::Origin origin, Sample& x,
         Work& work)
      : pair_(pair), polytope_(corner, origin), x_(x), work_(work) {}

  /// Takes in the point of the maximum in `x`.
  bool addTop() {
    if (!add(furthest(x_))) return false;
    top_ = polytope_.lastPoint();
    return true;
  }

  bool add(const Vector3d& p) { return polytope_.sound() && polytope_.expand(p); }

  /// Expands where the surface is nearest; true once nothing is nearer than the maximum in `x`.
  bool run(double& bound) {
    bool proven = false;
    expandAtNearest(polytope_, [&](const Polytope::Face& nearest) {
      // The polytope lies inside the difference, so with the origin inside it no direction leads out sooner.
      bound = -std::max(0.0, std::min(least_, nearest.distance));
      proven = -x_.core - nearest.distance <= pair_.gapRounding();
      if (proven) return false;
      if (nearest.has(top_) && -x_.core - nearest.distance <= kClose * nearest.distance &&
          isAlone(pair_, x_, nearest.distance)) {
        putAside(nearest);
        return true;
      }
      return expandToVertex(nearest) || expandToSurface(nearest);
    });
    return proven;
  }

 private:
  /// Far from the surface vertices will do, even such as the tables name; they are the cheapest points of the
  /// difference.
  bool expandToVertex(const Polytope::Face& nearest) {
    if (!(nearest.distance > 0.0)) return false;
    const Vector3d vertex = unpack(pair_.differenceAgainst(-nearest.normal));
    return nearest.normal.dot(vertex) > (1.0 + kNear) * nearest.distance && polytope_.expand(vertex);
  }

  /// False where the cores turn out to be apart.
  bool expandToSurface(const Polytope::Face& nearest) {
    Sample trial = pair_.sampleFrom(-nearest.normal, {-1, -1}, work_.steps);
    if (trial.core > 0.0) {
      x_ = trial;
      return false;
    }
    const Vector3d point = furthest(trial);
    const double open = -trial.core - nearest.distance;
    Vector3d ignored;
    const bool top = open <= kNear * nearest.distance && settle(pair_, trial, ignored, work_);
    const bool another = top && (trial.n - x_.n).squaredNorm() > kSame * kSame;
    const bool better = trial.core > x_.core;
    if (better) x_ = trial;
    if (open <= pair_.gapRounding() || (top && open <= kClose * nearest.distance) ||
        !((another && better && addTop()) || polytope_.expand(point)))
      putAside(nearest);
    return true;
  }

  void putAside(const Polytope::Face& nearest) {
    least_ = std::min(least_, nearest.distance);
    polytope_.putAside();
  }

  const BodyPair& pair_;
  Polytope polytope_;
  Sample& x_;
  Work& work_;
  Polytope::Index top_ = Polytope::kNone;                   // point of the maximum in `x`
  double least_ = std::numeric_limits<double>::infinity();  // distance of the faces done with
};

}  // namespace

FCL_STPBV_VECTORIZED
bool expandPolytope(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Sample& x, double& bound,
                    Work& work) {
  return Search(pair, corner, Polytope::Origin::inside, x, work).run(bound);
}

FCL_STPBV_VECTORIZED
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, Work& work) {
  const bool top = pair.isStationary(x);
  if (top && crownProves(pair, x, bound)) return true;
  const std::array<Vector3d, 3> m = around(x.n);
  std::array<Vector3d, 4> corner;
  for (std::size_t i = 0; i < 3; ++i) corner[i] = unpack(pair.differenceAgainst(x.n - kRing * m[i]));
  corner[3] = unpack(pair.differenceAgainst(-x.n));
  Search search(pair, corner, Polytope::Origin::anywhere, x, work);
  const Corners known = cornersAround(pair, x);
  for (std::size_t i = 0; i < known.count; ++i) search.add(unpack(known.point[i]));
  if (top)
    search.addTop();
  else if (known.count == 0)
    search.add(vertexDifference(pair, x.n));
  if (search.run(bound)) return true;
  const auto from = [&](const Vector3d& n) { return furthest(pair.sampleFrom(n, {-1, -1}, work.steps)); };
  return Search(pair, {from(m[0]), from(m[1]), from(m[2]), from(-x.n)}, Polytope::Origin::anywhere, x, work)
      .run(bound);
}

}  // namespace fcl_stpbv
