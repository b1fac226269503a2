// Local tests that together prove that the volume is the ball hull of its vertices. The patches lie over
// regions of normals, which are glued along their boundaries: an edge's region lies between the regions of
// two faces and two vertices. The tests are that
//   (a) each region is bounded by a loop that turns left at its corners and along its arcs; the turns add
//       up to 2 pi minus the region's area, and this area is not negative;
//   (b) neighbours lie on different sides of their boundary, and the angles around a corner add up to 2 pi;
//   (c) vertices - edges + faces is 2.
// By (a) a region is mapped one to one to the sphere of normals. A loop that turns left everywhere winds
// round its inside once. Otherwise its turns would add up to 2 pi more, and the area would come out negative,
// unless the loop bounded a quarter of the sphere twice over. With (b) the map is one to one near every
// normal. So the glued surface covers the sphere evenly, and by (c) once. So the patches are the surface of a
// convex body that has every normal once, with radii of curvature of at most R. By Blaschke's theorem, any
// ball of radius R that touches the body, with the body on its inner side, contains it. So the body is the
// ball hull of its vertices.
//
// For (b): if a face's region turns left at a corner, its angle and that of the vertex's region add up to pi
// there. The angles of the two edges' regions add up to the other pi. An edge lies on the balls of both of
// its faces if these balls touch its ends. It lies between the faces' normals if it turns forward. A concave
// edge would turn by nearly 2 pi, so edges with wide turns are measured.
#include "fcl_stpbv/volume/surface_check.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/regions.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Angle between two normals of an edge that are tested (rad).
constexpr double kWide = 0.3;

// Height of a vertex over the ball of a face (m), with the normal that the face's patch stores.
double patchHeight(const StpBv& volume, int face, int vertex) {
  const FaceRecord& f = volume.tables().patches.face(volume.facePatch(face));
  const Vector3d q = at(volume, vertex) - f.anchor;
  return q.squaredNorm() / (2 * volume.radii().rho) + q.dot(f.normal);
}

// Height of a vertex over the ball of a face (m). Unless the vertex is clearly below the ball, the height is
// computed without the patch's normal, which is rounded. (That rounding changes the support function by next
// to nothing.)
double height(const StpBv& volume, int face, int vertex) {
  const double rounded = patchHeight(volume, face, vertex);
  if (rounded < -1e-9 * volume.enclosingRadius()) return rounded;
  const std::array<int, 3> t = wideTriangle(volume.vertices(), volume.faces()[at(face)]);
  const TouchingBall ball(at(volume, t[0]), at(volume, t[1]), at(volume, t[2]), volume.radii().rho);
  return ball.valid() ? static_cast<double>(ball.height(at(volume, vertex))) : rounded;
}

// Largest height of a point over the ball that rolls over an edge, between the two ends of the roll (m).
double heightOnTheWay(const StpBv& volume, int edge, const Arc& arc, const Vector3d& p) {
  const StpBv::Edge& e = volume.edges()[at(edge)];
  const Vector3d &from = at(volume, e.vertex[0]), along = at(volume, e.vertex[1]) - from, q = p - from;
  const Patch patch = volume.patch(volume.edgePatch(edge));
  const double curvature = 1 / volume.radii().rho, cosine = curvature * patch.kappa;
  const double x = q.dot(arc.start), y = q.dot(arc.axis.cross(arc.start));
  double angle = std::atan2(y, x);
  if (angle < 0) angle += 2 * kPi;
  if (angle >= e.turn) return -kInfinity;
  return 0.5 * curvature * q.dot(q - along) + cosine * std::hypot(x, y);
}

// How far a point of the cloud is outside of a ball that touches one of the volume's faces or rolls over one
// of its edges (m).
double farthestOut(const StpBv& volume, const std::vector<Vector3d>& points) {
  const PointTree tree(points);
  const double curvature = 1 / volume.radii().rho;
  std::vector<int> near;
  double out = -kInfinity;
  for (int f = 0; f < volume.faceCount(); ++f) {
    const FaceRecord& face = volume.tables().patches.face(volume.facePatch(f));
    out = std::max(out, tree.highest(face.anchor, face.normal, curvature, 0, &near).height);
  }
  // A point that leaves the rolling ball and enters it again within half a turn is in the ball that has the
  // edge as its diameter. So it is nearer to both ends than the edge's length l. During the roll its height
  // is a sinusoid of at most that amplitude. If it is outside at an angle x from the tested angle, its height
  // at the tested angle is at least -l x^2 / 2.
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[at(e)];
    const Vector3d &from = at(volume, edge.vertex[0]), &to = at(volume, edge.vertex[1]);
    const Arc arc = edgeArc(volume, e);
    const double length = (to - from).norm(), sine = 0.5 * curvature * length,
                 cosine = curvature * volume.patch(volume.edgePatch(e)).kappa;
    const int count = static_cast<int>(edge.turn / kWide) + 1;
    const double x = 0.5 * edge.turn / count, low = 0.5 * length * x * x;
    for (int k = 0; k < count; ++k) {
      const Vector3d normal = cosine * arc.at((k + 0.5) / count) - sine * arc.axis;
      const PointTree::Highest top = tree.highest(from, normal, curvature, low, &near);
      if (top.height > low)
        out = std::max(out, top.height);
      else
        for (const int i : near) out = std::max(out, heightOnTheWay(volume, e, arc, points[at(i)]));
    }
  }
  return out;
}

// Greatest and least height of a face's corner over the face's own ball. Three corners fix this ball, so
// triangles do not count.
struct CornerHeights {
  double highest = -kInfinity, lowest = kInfinity;
};

CornerHeights cornerHeights(const StpBv& volume) {
  CornerHeights found;
  for (int f = 0; f < volume.faceCount(); ++f) {
    const StpBv::Ring& ring = volume.faces()[at(f)];
    if (ring.size() == 3) continue;
    for (const int i : ring) {
      const double over = height(volume, f, i);
      found.highest = std::max(found.highest, over);
      found.lowest = std::min(found.lowest, over);
    }
  }
  return found;
}

// Largest height of a face's corner over the face's own ball, or over the ball of the face across an edge,
// for the corners next to that edge (m).
double vertexHeight(const StpBv& volume, const CornerHeights& corners) {
  double worst = corners.highest;
  for (const StpBv::Edge& edge : volume.edges()) {
    if (edge.face[0] < 0) continue;
    for (const std::size_t side : {0u, 1u}) {
      const StpBv::Ring& ring = volume.faces()[at(edge.face[side])];
      const auto from =
          static_cast<std::size_t>(std::find(ring.begin(), ring.end(), edge.vertex[side]) - ring.begin());
      const int over = edge.face[1 - side];
      worst = std::max(worst, height(volume, over, ring[(from + 2) % ring.size()]));
      if (ring.size() > 3)
        worst = std::max(worst, height(volume, over, ring[(from + ring.size() - 1) % ring.size()]));
    }
  }
  return worst;
}

// The largest gap between patches that should meet. The gap at an edge is as large as the distance of its
// ends from its faces' balls, which the first loop measures. Apart from that, only edges with wide turns are
// measured, because a concave edge would seem to turn by nearly 2 pi.
double largestGap(const StpBv& volume) {
  double gap = 0;
  for (int f = 0; f < volume.faceCount(); ++f)
    for (const int i : volume.faces()[at(f)]) gap = std::max(gap, std::abs(patchHeight(volume, f, i)));
  for (int e = 0; e < volume.edgeCount(); ++e)
    if (volume.edges()[at(e)].turn >= kWide) gap = std::max(gap, edgeGap(volume, e).largest());
  return gap;
}

// Whether every region is bounded by a loop that turns left, and they tile the sphere.
bool tilesSphere(const StpBv& volume) {
  constexpr double kOff = 1e-6;  // rad and sr; the rounding of slivers may add up to this
  const RegionAngles angles = regionAngles(volume);
  double sum = 0, least = 0;
  for (const double angle : angles.area) sum += angle, least = std::min(least, angle);
  return std::abs(sum - 4 * kPi) <= kOff && least >= -kOff && angles.leastTurn >= -kOff;
}

// Angle by which the boundary of a face's region turns left at the `k`th corner of its ring (rad), (-pi, pi].
double cornerTurn(const StpBv& volume, int face, std::size_t k) {
  const StpBv::Ring& ring = volume.faces()[at(face)];
  const std::size_t corners = ring.size();
  const Vector3d& here = at(volume, ring[k]);
  const Vector3d n = volume.corner(face, ring[k]);
  const auto across = [&](const Vector3d& v) { return n.cross(v.cross(n)); };
  const Vector3d arrive = across(here - at(volume, ring[k > 0 ? k - 1 : corners - 1])),
                 leave = across(at(volume, ring[k + 1 < corners ? k + 1 : 0]) - here);
  return std::atan2(n.dot(arrive.cross(leave)), arrive.dot(leave));
}

}  // namespace

RegionAngles regionAngles(const StpBv& volume) {
  RegionAngles angles;
  angles.area.assign(static_cast<std::size_t>(volume.patchCount()), 0.0);
  const auto area = [&](int patch) -> double& { return angles.area[at(patch)]; };
  if (volume.edgeCount() == 0) {
    area(0) = 4 * kPi;
    return angles;
  }
  // A region's area is 2 pi minus the turning of its boundary. The boundary of a face's region turns at its
  // corners only. A vertex's region is bounded by the cones of its edges. These are small circles, which turn
  // along the way, too.
  for (int v = 0; v < volume.vertexCount(); ++v) area(v) = 2 * kPi;
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[at(e)];
    const double sine =
        0.5 * (at(volume, edge.vertex[1]) - at(volume, edge.vertex[0])).norm() / volume.radii().rho;
    area(volume.edgePatch(e)) = 2 * sine * edge.turn;
    for (const int v : edge.vertex) area(v) -= sine * edge.turn;
  }
  for (int f = 0; f < volume.faceCount(); ++f) {
    const StpBv::Ring& ring = volume.faces()[at(f)];
    double sum = 0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      // At the same corner the vertex's region turns from the cone of one edge to that of the other, by pi
      // minus `turn`.
      const double turn = cornerTurn(volume, f, k);
      angles.leastTurn = std::min(angles.leastTurn, turn);
      sum += turn;
      area(ring[k]) -= kPi - turn;
    }
    area(volume.facePatch(f)) = 2 * kPi - sum;
  }
  return angles;
}

double vertexHeight(const StpBv& volume) { return vertexHeight(volume, cornerHeights(volume)); }

EdgeGap edgeGap(const StpBv& volume, int e) {
  EdgeGap gap;
  const auto compare = [&](int a, int b, const Vector3d& n, double* largest) {
    *largest = std::max(*largest, (corePoint(volume, a, n) - corePoint(volume, b, n)).norm());
  };
  const StpBv::Edge& edge = volume.edges()[at(e)];
  const int own = volume.edgePatch(e);
  const double sine =
      0.5 * (at(volume, edge.vertex[1]) - at(volume, edge.vertex[0])).norm() / volume.radii().rho;
  const double cosine = volume.patch(own).kappa / volume.radii().rho;
  const Arc arc = edgeArc(volume, e);
  for (int k = 0; k <= 8; ++k) {
    const Vector3d w = arc.at(k / 8.0);
    compare(own, edge.vertex[0], cosine * w - sine * arc.axis, &gap.ends);
    compare(own, edge.vertex[1], cosine * w + sine * arc.axis, &gap.ends);
    // The edge's region should contain its arc.
    if (k > 0 && k < 8) compare(own, volume.owner(w), w, &gap.arc);
  }
  if (edge.face[0] < 0) return gap;
  for (const std::size_t side : {0u, 1u}) {
    const int face = edge.face[side];
    const Vector3d a = volume.corner(face, edge.vertex[0]), b = volume.corner(face, edge.vertex[1]);
    for (int k = 0; k <= 4; ++k)
      compare(own, volume.facePatch(face), ((1 - k / 4.0) * a + k / 4.0 * b).normalized(), &gap.side[side]);
  }
  return gap;
}

Soundness soundnessOf(const StpBv& volume, const std::vector<Vector3d>& points,
                      const std::vector<Vector3d>& others, double* off) {
  const CornerHeights corners = cornerHeights(volume);
  const double held = vertexHeight(volume, corners),
               left = others.empty() ? -kInfinity : farthestOut(volume, others);
  const double size = volume.enclosingRadius(), same = 2 * touchTolerance(points), out = std::max(held, left);
  if (off) *off = std::max(out, -corners.lowest);
  const double wide = 1e-9 * size + same;
  const double shift = 1e-3 * size + wide + 64 * kEpsilon * volume.radii().rho;
  if (!(out <= wide && tilesSphere(volume) && largestGap(volume) <= shift)) return Soundness::broken;
  if (!(out <= same + 8 * kEpsilon * volume.radii().rho)) return Soundness::off;
  return left <= 16 * kEpsilon * size ? Soundness::exact : Soundness::sound;
}

// The centre C of a patch is at the distance `rho` from the patch's vertices, with an error of at most `off`,
// and no point is further away than `rho + off`. Move C towards the centre of the smallest ball, which is
// within that ball's radius of all points: then all points are within `rho`. In the other direction, no
// centre that has all points within `rho` is much lower along one of the patch's normals. In both cases n.C
// changes by at most `off` times rho / sqrt(rho^2 - radius^2). The change is smaller if R is so close to the
// smallest R that `off` is all the space there is.
double supportErrorOf(const StpBv& volume, double off) {
  if (!(off > 0)) return 0;
  const double rho = volume.radii().rho, radius = volume.enclosingRadius() - volume.radii().r;
  const double room = std::max(0.0, rho - radius) * (rho + radius);
  return 2 * off * rho / std::sqrt(room + rho * off);  // twice the bound
}

}  // namespace fcl_stpbv::detail
