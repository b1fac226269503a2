// Measures of a volume.
// 1. Enclosed volume: the divergence theorem, patch by patch over the regions of normals, with Gauss-Legendre
//    quadrature.
// 2. Signed distance of a point: for each patch, the normal from the patch's farthest centre to the point.
//    The result is the largest value over the patches whose region contains that normal.
// 3. The difference of two volumes that should be equal: of their support functions, over normals of both
//    volumes, and of their vertices.
#include "fcl_stpbv/volume/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/regions.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

// Gauss-Legendre points and weights on [0, 1], ten points: exact for polynomials of degree 19.
constexpr std::array<std::array<double, 2>, 10> kGauss{{{0.013046735741414, 0.033335672154344},
                                                        {0.067468316655508, 0.074725674575290},
                                                        {0.160295215850488, 0.109543181257991},
                                                        {0.283302302935376, 0.134633359654998},
                                                        {0.425562830509184, 0.147762112357376},
                                                        {0.574437169490816, 0.147762112357376},
                                                        {0.716697697064624, 0.134633359654998},
                                                        {0.839704784149512, 0.109543181257991},
                                                        {0.932531683344492, 0.074725674575290},
                                                        {0.986953264258586, 0.033335672154344}}};

// The normals of a face differ only by its size over R. So all normals are written as offsets from the
// patch's axis, which follow from the vertices without cancellation.
double faceVolume(const StpBv& volume, const Region& region) {
  double sum = 0;
  const Patch patch = volume.patch(region.patch);
  const Vector3d anchor = patch.anchor - volume.centre(), middle = region.centre - patch.axis;
  const StpBv::Ring& ring = volume.faces()[at(region.patch - volume.facePatch(0))];
  for (std::size_t k = 0; k < ring.size(); ++k) {  // arc k starts at vertex ring[k]
    const Arc& arc = region.boundary[k];
    const Vector3d first = (at(volume, ring[k]) - patch.anchor) / volume.radii().rho - middle;
    const Vector3d along = arc.axis.cross(arc.start);
    const int pieces = std::max(1, static_cast<int>(std::ceil(arc.turn / 0.5)));
    for (int piece = 0; piece < pieces; ++piece)
      for (const auto& [t, wt] : kGauss) {
        const double angle = arc.turn * (piece + t) / pieces, sine = std::sin(angle);
        const double half = std::sin(0.5 * angle);
        const Vector3d out = first + sine * along - 2 * half * half * arc.start;
        const Vector3d rate = arc.turn / pieces * (std::cos(angle) * along - sine * arc.start);
        const double det = region.centre.cross(out).dot(rate);
        for (const auto& [share, wo] : kGauss) {
          const Vector3d g = region.centre + share * out;
          const double length = g.norm();
          const Vector3d n = g / length;
          const double height = n.dot(anchor) + supportAboveAnchor(volume, region.patch, n);
          sum += wt * wo * share * det / (length * length * length) * height;
        }
      }
  }
  return sum * volume.radii().R * volume.radii().R / 3;
}

// With n = cos(a) w + sin(a) u the surface element is R (R cos a - kappa) da
// dphi and h = n.I + R - kappa cos a.
double edgeVolume(const StpBv& volume, int edge) {
  const Patch patch = volume.patch(volume.edgePatch(edge));
  const Radii& radii = volume.radii();
  const Arc arc = edgeArc(volume, edge);
  const Vector3d middle = patch.anchor - volume.centre();
  const Vector3d sumOfW = arc.axis.cross(arc.start - arc.at(1));
  const double half = halfLength(patch, radii), half2 = half * half;
  const double limit = std::asin(std::min(1.0, patch.sine));
  double sum = 0;
  for (const auto& [t, weight] : kGauss) {
    const double a = limit * (2 * t - 1), c = std::cos(a), s = std::sin(a);
    // rho c - kappa without cancellation.
    const double over = (half2 - radii.rho * radii.rho * s * s) / (radii.rho * c + patch.kappa);
    const double height =
        arc.turn * (s * arc.axis.dot(middle) + radii.r + sag(patch, radii) + patch.kappa * s * s / (1 + c)) +
        c * sumOfW.dot(middle);
    sum += weight * 2 * limit * (radii.r * c + over) * height;
  }
  return sum * radii.R / 3;
}

// A direction perpendicular to the edge that belongs to the region of its patch.
Vector3d acrossEdge(const StpBv& volume, int patch) {
  Vector3d sum = Vector3d::Zero(), last = Vector3d::Zero();
  for (const RegionBoundary boundary : volume.tables().patches.boundaries(patch))
    if (boundary.limit == 0) sum -= boundary.normal, last = boundary.normal;
  const Vector3d& u = volume.patch(patch).axis;
  if (sum.norm() > 1e-6) return sum.normalized();
  return last.norm() > 0 ? Vector3d(last.cross(u)) : Vector3d(u.unitOrthogonal());
}

// Whether a patch has a region of normals that is not empty. An edge between two faces on one ball has an
// empty region, whose boundaries do not distinguish its side from the opposite side.
bool hasNormals(const StpBv& volume, int patch) {
  constexpr double kTurn = 1e-12;  // rad
  const int edge = patch - volume.vertexCount();
  return edge < 0 || edge >= volume.edgeCount() || volume.edges()[at(edge)].turn > kTurn;
}

// The patch's normal with the largest n.p - h(n): from the patch's farthest centre towards p. If all normals
// of a point, or all directions across an edge, give the same value, the result is one in the patch's region.
Vector3d stationaryNormal(const StpBv& volume, int index, const Vector3d& p) {
  const Patch patch = volume.patch(index);
  const PatchKind kind = volume.kind(index);
  Vector3d g = p - unpack(posedPatch(volume, index).centre());
  if (kind == PatchKind::edge) {
    // For a point on the edge's line the part across the edge is only rounding, and has an equally large part
    // along the edge.
    const double along = g.dot(patch.axis), rounding = 1e-15 * (p.norm() + std::abs(along));
    Vector3d side = g - along * patch.axis;
    side -= side.dot(patch.axis) * patch.axis;
    const double length = side.norm();
    g = along * patch.axis +
        (length + patch.kappa) * (length > rounding ? Vector3d(side / length) : acrossEdge(volume, index));
  }
  const double length = g.norm();
  // A point that coincides with the vertex up to rounding has no direction from the vertex.
  if (length > (kind == PatchKind::vertex ? 1e-12 * volume.enclosingRadius() : 0.0)) return g / length;
  if (kind == PatchKind::face) return patch.axis;
  Vector3d inside = Vector3d::Zero();
  for (const RegionBoundary boundary : volume.tables().patches.boundaries(index)) inside -= boundary.normal;
  return inside.norm() > 0 ? Vector3d(inside.normalized()) : Vector3d(Vector3d::UnitZ());
}

}  // namespace

double overCoverBound(const Radii& radii, double longestEdge) {
  const double a2 = longestEdge * longestEdge / 3;
  return radii.r + a2 / (radii.rho + std::sqrt(std::max(0.0, radii.rho * radii.rho - a2)));
}

double enclosedVolume(const StpBv& volume) {
  const std::vector<double> angles = solidAngles(volume);
  const double r = volume.radii().r;
  double sum = 0;
  for (const Region& region : regions(volume)) {
    if (volume.kind(region.patch) == PatchKind::face) {
      sum += faceVolume(volume, region);
      continue;
    }
    const Vector3d p = volume.patch(region.patch).anchor - volume.centre();
    const double share = volume.edgeCount() == 0 ? 0.5 : 1;  // regions() gives a lone sphere as two halves
    sum += r * r / 3 * (p.dot(vectorArea(region)) + r * share * angles[at(region.patch)]);
  }
  for (int e = 0; e < volume.edgeCount(); ++e) sum += edgeVolume(volume, e);
  return sum;
}

double signedDistance(const StpBv& volume, const Vector3d& point) {
  if (!point.allFinite()) return -kInfinity;
  // From such a distance every volume looks like a ball at the origin. At still larger distances squares of
  // lengths overflow.
  constexpr double kFar = 1e100;  // m; points of volumes are within 1e75
  if (point.cwiseAbs().maxCoeff() > kFar) return point.stableNorm() - volume.radii().r;
  // The largest value belongs to the patch that owns its normal. Any normal gives a valid lower bound if the
  // support of its true owner is used. So it does no harm if rounding moves a normal across a boundary, as
  // may happen close to a vertex.
  constexpr double kNear = 1e-3;  // the sine of an angle by which rounding never moves a normal
  double best = -2 * volume.radii().R;
  for (int index = 0; index < volume.patchCount(); ++index) {
    if (!hasNormals(volume, index)) continue;
    const Vector3d n = stationaryNormal(volume, index, point);
    const double past = volume.outside(index, n);
    if (past > kNear) continue;
    const int owner = past <= 0 ? index : volume.owner(n, index);
    best = std::max(best, n.dot(point - volume.patch(owner).anchor) - supportAboveAnchor(volume, owner, n));
  }
  return best;
}

bool contains(const StpBv& volume, const Vector3d& point) { return signedDistance(volume, point) <= 0; }

double surfaceDifference(const StpBv& a, const StpBv& b) {
  double worst = 0;
  const auto compare = [&](const Vector3d& n) {
    worst = std::max(worst, std::abs(a.support(n) - b.support(n)));
  };
  for (const StpBv* volume : {&a, &b})
    for (int face = 0; face < volume->faceCount(); ++face)
      for (const int vertex : volume->faces()[at(face)]) compare(volume->corner(face, vertex));
  constexpr int kMore = 1000;  // directions on a spiral, for bodies with few faces
  constexpr double kGoldenAngle = 2.399963229728653;
  for (int i = 0; i < kMore; ++i) {
    const double z = 1 - (2 * i + 1) / static_cast<double>(kMore), across = std::sqrt(1 - z * z);
    compare(
        Vector3d(across * std::cos(kGoldenAngle * i), across * std::sin(kGoldenAngle * i), z).normalized());
  }
  return worst;
}

int withoutPartner(const StpBv& a, const StpBv& b, double radius) {
  const PointTree tree(b.vertices());
  std::vector<int> near;
  return static_cast<int>(std::count_if(a.vertices().begin(), a.vertices().end(), [&](const Vector3d& v) {
    tree.within(v, radius, &near, 1);
    return near.empty();
  }));
}

}  // namespace fcl_stpbv
