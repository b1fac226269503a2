#include "fcl_stpbv/distance/expanding_polytope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/polytope.h"
#include "fcl_stpbv/distance/polytope_search.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Where the polytope is this much of the depth from the surface, a maximum is likely to be next to it.
constexpr double kNear = 0.03;

/// Where it is this near, the maximum that its normal leads to is the only one there.
constexpr double kClose = 1e-3;

/// Tilt of the normals of points that the polytope gets at first around a maximum, and further off (rad).
constexpr double kRing = 0.4;

/// Normals of one maximum found twice differ by less (rad).
constexpr double kSame = 1e-7;

/// The difference's point furthest against the sample's normal.
Vector3d furthest(const Sample& s) { return s.core * s.n + s.across; }

/// Three unit vectors across `n`, a third of a turn apart.
std::array<Vector3d, 3> around(const Vector3d& n) {
  const Vector3d e = n.unitOrthogonal(), f = std::sqrt(0.75) * n.cross(e);
  return {e, f - 0.5 * e, -f - 0.5 * e};
}

/// The points supporting normals a little off a maximum: what the polytope would find last, and with them it
/// is close to the surface there.
std::array<Vector3d, 3> pointsAround(const BodyPair& pair, const Sample& top, Work& work) {
  // A tilt that no radius of curvature turns into more than a part of that.
  const double tilt =
      std::sqrt(0.5 * kClose * std::abs(top.core) / (pair.a().radii().rho + pair.b().radii().rho));
  std::array<Vector3d, 3> points = around(top.n);
  for (Vector3d& m : points)
    m = furthest(pair.sampleFrom((top.n + tilt * m).normalized(), top.patch, work.steps));
  return points;
}

/// Three points around a maximum, as many off it and one behind: the faces between them close a surface
/// around the origin.
struct Crown {
  std::array<Vector3d, 3> top, ring;
  Vector3d behind;

  /// Whether all faces but the one between the top's points are at least `depth` from the origin, and so no
  /// direction leads out of the body sooner but through that one. Nothing else is asked of the points: a
  /// closed surface whose faces all have the origin on their inner side is met by every ray from it.
  bool holds(double depth) const {
    const auto beyond = [&](const Vector3d& p, const Vector3d& q, const Vector3d& r) {
      const Packed corner = pack(p), normal = cross(pack(q) - corner, pack(r) - corner);
      const double height = dot(normal, corner);
      return height > 0.0 && height * height >= depth * depth * dot(normal, normal);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      if (!beyond(top[i], top[j], ring[k]) || !beyond(ring[j], top[i], ring[k]) ||
          !beyond(ring[i], ring[j], behind))
        return false;
    }
    return true;
  }

  /// Distance from the origin of the face between the top's points.
  double topDistance() const { return -(top[1] - top[0]).cross(top[2] - top[0]).normalized().dot(top[0]); }
};

class Search {
 public:
  Search(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Polytope::Origin origin, Sample& x,
         Work& work)
      : pair_(pair), polytope_(corner, origin), x_(x), work_(work) {}

  /// Takes in the points around a maximum; the face between them needs no look.
  void addTop(const std::array<Vector3d, 3>& points) {
    for (const Vector3d& p : points) add(p);
    least_ = std::min(least_, polytope_.putLastAside());
  }

  void add(const Vector3d& p) {
    if (polytope_.sound()) polytope_.expand(p);
  }

  /// Expands where the surface is nearest; true once nothing is nearer than the maximum in `x`.
  bool run(double& bound) {
    while (polytope_.sound()) {
      const Polytope::Face nearest = polytope_.nearest();
      // The polytope lies inside the difference, so with the origin inside it no direction leads out sooner.
      bound = -std::max(0.0, std::min(least_, nearest.distance));
      if (-x_.core - nearest.distance <= pair_.gapRounding()) return true;
      if (expandToVertex(nearest)) continue;
      if (!expandToSurface(nearest)) return false;
    }
    return false;
  }

 private:
  /// Far from the surface vertices will do; they are the cheapest points of the difference.
  bool expandToVertex(const Polytope::Face& nearest) {
    if (!(nearest.distance > 0.0)) return false;
    const Vector3d vertex = vertexDifference(pair_, -nearest.normal);
    return nearest.normal.dot(vertex) > (1.0 + kNear) * nearest.distance && polytope_.expand(vertex);
  }

  /// False where the cores turn out to be apart.
  bool expandToSurface(const Polytope::Face& nearest) {
    Sample trial = pair_.sampleFrom(-nearest.normal, {-1, -1}, work_.steps);
    if (trial.core > 0.0) return false;
    const Vector3d point = furthest(trial);
    const double open = -trial.core - nearest.distance;
    Vector3d ignored;
    const bool top = open <= kNear * nearest.distance && settle(pair_, trial, ignored, work_);
    const bool another = top && (trial.n - x_.n).squaredNorm() > kSame * kSame;
    if (trial.core > x_.core) x_ = trial;
    if (open <= pair_.gapRounding() || (top && open <= kClose * nearest.distance) ||
        !polytope_.expand(point)) {
      least_ = std::min(least_, nearest.distance);
      polytope_.putAside();
    } else if (another) {
      addTop(pointsAround(pair_, trial, work_));
    }
    return true;
  }

  const BodyPair& pair_;
  Polytope polytope_;
  Sample& x_;
  Work& work_;
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
  // Three points off the normal and one behind; beside the points around a maximum at the normal they make
  // sides flat enough not to come nearer to the origin than the top does, on most bodies.
  const std::array<Vector3d, 3> m = around(x.n);
  Crown crown;
  for (std::size_t i = 0; i < 3; ++i)
    crown.ring[i] = vertexDifference(pair, (x.n - kRing * m[i]).normalized());
  crown.behind = vertexDifference(pair, -x.n);
  const bool top = pair.isStationary(x);
  if (top) {
    crown.top = pointsAround(pair, x, work);
    const double depth = -x.core - pair.gapRounding();
    if (crown.holds(depth)) {
      bound = -std::max(0.0, std::min(crown.topDistance(), depth));
      return true;
    }
  }
  Search search(pair, {crown.ring[0], crown.ring[1], crown.ring[2], crown.behind}, Polytope::Origin::anywhere,
                x, work);
  if (top)
    search.addTop(crown.top);
  else
    search.add(vertexDifference(pair, x.n));
  if (search.run(bound)) return true;
  const auto from = [&](const Vector3d& n) { return furthest(pair.sampleFrom(n, {-1, -1}, work.steps)); };
  return Search(pair, {from(m[0]), from(m[1]), from(m[2]), from(-x.n)}, Polytope::Origin::anywhere, x, work)
      .run(bound);
}

}  // namespace fcl_stpbv
