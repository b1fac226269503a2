// Builds a volume, and answers its simple queries.
// 1. Check points and radii. The smallest enclosing ball decides whether R is large enough.
// 2. Find the faces that a ball of radius R - r can touch from inside: by quickhull. If the result fails the
//    check of the surface, roll the ball instead, and if that fails too and the points are few, use the
//    faces' definition (rolling_ball.h). Make patches of the faces (stp_bv_topology.cpp).
// 3. Queries walk from a hint to the patch that owns the normal and use its closed form.
#include "fcl_stpbv/volume/stp_bv.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/outer_points.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_check.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/surface_check.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

std::string number(double value) { return formatted("%.9g", value); }

// The number as text that still fulfils `holds` when it is read again, with as few digits as possible but at
// least nine.
template <typename Holds>
std::string number(double value, const Holds& holds) {
  std::string text;
  for (int digits = 9; digits <= 17; ++digits) {
    text = formatted("%.*g", digits, value);
    if (holds(std::strtod(text.c_str(), nullptr))) break;
  }
  return text;
}

// An R that works with the margin `r` if the points' smallest ball has this `radius`. It works as it is
// printed, too.
std::string usableR(double r, double radius) {
  double least = r + radius * (1 + 1e-9);
  while (least - r <= radius) least = std::nextafter(least, kInfinity);
  return number(least, [&](double R) { return R >= least; });
}

void checkInput(const std::vector<Vector3d>& points, const StpBvOptions& options) {
  if (points.empty()) throw Error("cannot build an STP-BV from no points: give at least one");
  constexpr double kMost = 1e75;  // m; the square of its square is finite
  for (std::size_t i = 0; i < points.size(); ++i) {
    requireFinite(i, points[i]);
    if (points[i].cwiseAbs().maxCoeff() > kMost)
      throw Error("point " + std::to_string(i) + " is too far away: every coordinate must be below " +
                  number(kMost) + " m");
  }
  if (!std::isfinite(options.r) || options.r < 0)
    throw Error("r = " + number(options.r) +
                " is not usable: the small radius must be a finite number of metres, 0 or more");
  if (!std::isfinite(options.R) || options.R <= options.r)
    throw Error("R = " + number(options.R) + " is not usable with r = " + number(options.r) +
                ": the big radius must be a finite number of metres, larger than r");
}

// A ball of radius R - r must contain all points and still be able to move; otherwise it cannot touch three
// of them from inside.
void checkRadius(const std::vector<Vector3d>& points, const StpBvOptions& options) {
  const Ball ball = minimumEnclosingBall(points);
  constexpr double kLink = 5.0;  // m; a link that is larger than any robot's is most likely in other units
  const auto tooSmall = [&](double R) { return R - options.r <= ball.radius; };
  if (points.size() > 1 && tooSmall(options.R))
    throw Error("R = " + number(options.R, tooSmall) +
                " m is too small: the smallest usable R for these points with r = " + number(options.r) +
                " m is " + usableR(options.r, ball.radius) + " m" +
                (ball.radius > kLink ? " (a ball around them has a radius of " + number(ball.radius) +
                                           " m: are they in millimetres?)"
                                     : ""));
  // A face of size s bulges by about s^2 / (8 R). If R is above s / epsilon, this is far below the rounding
  // of its points. Even the smallest clouds, only a few roundings wide, accept every R that a robot may use.
  constexpr double kAlways = 1e8;  // m
  const double largest =
      std::max(kAlways, (ball.radius + options.r) / std::numeric_limits<double>::epsilon());
  const auto tooLarge = [&](double R) { return R - options.r > largest; };
  if (points.size() > 1 && tooLarge(options.R))
    throw Error(
        "R = " + number(options.R, tooLarge) +
        " m is too large: such faces are flat to rounding; the largest usable R for these points with r = " +
        number(options.r) + " m is just below " + number(largest) + " m");
}

}  // namespace

double StpBv::smallestR(const std::vector<Vector3d>& points, double r) {
  checkInput(points, {r, std::numeric_limits<double>::max()});
  return r + minimumEnclosingBall(points).radius;
}

StpBv::Ptr StpBv::build(const std::vector<Vector3d>& points, const StpBvOptions& options) {
  checkInput(points, options);
  const std::vector<int> outer = outerPoints(points);
  if (2 * outer.size() < points.size()) {
    std::vector<Vector3d> fewer;
    fewer.reserve(outer.size());
    for (const int i : outer) fewer.push_back(points[at(i)]);
    return build(fewer, options);
  }
  checkRadius(points, options);
  const double rho = options.R - options.r;
  Soundness found = Soundness::broken;
  Ptr volume;
  // Makes the volume with these faces, and keeps it unless the one before is sounder.
  const auto offer = [&](RolledHull hull) {
    std::vector<int> newIndex(points.size(), -1);
    std::vector<Vector3d> vertices, others;
    for (const int i : hull.vertices) {
      newIndex[at(i)] = static_cast<int>(vertices.size());
      vertices.push_back(points[at(i)]);
    }
    for (Ring& ring : hull.faces)
      for (int& i : ring) i = newIndex[at(i)];
    for (std::size_t i = 0; i < points.size(); ++i)
      if (newIndex[i] < 0) others.push_back(points[i]);
    const Ptr made = make(std::move(vertices), std::move(hull.faces), options);
    double off = 0;
    const Soundness sound = soundnessOf(*made, points, others, &off);
    made->tables_->supportError = supportErrorOf(*made, off);
    if (volume && found < sound) return;
    volume = made, found = sound;
  };
  try {
    RolledHull quick = quickBallHull(points, rho);
    if (!quick.faces.empty()) offer(std::move(quick));
  } catch (const Error&) {  // quickhull's faces do not close: the cloud needs the rolling ball
  }
  if (found != Soundness::exact) {
    try {
      offer(rollBall(points, rho));
    } catch (const Error&) {  // rounding: the next two methods may still succeed
    }
  }
  // Clusters of points that differ only by a few roundings can make the roll fail, and so can points on the
  // surface of a spindle. A wrong volume must not be returned.
  if (found >= Soundness::off && points.size() <= kMostByDefinition) {
    offer(hullByDefinition(points, rho));
  } else if (found == Soundness::broken) {
    offer(spindleOf(points));
    if (found == Soundness::off) found = Soundness::broken;
  }
  if (found == Soundness::broken) {
    const double radius = minimumEnclosingBall(points).radius;
    constexpr double kRounding = 1e-13;  // share of the radius
    if (rho <= (1 + kRounding) * radius)
      throw Error("R = " + number(options.R) +
                  " m is the limit of the usable R up to rounding: use at least " +
                  usableR(options.r, radius) + " m");
    throw Error(
        "the points are too close to each other to be told apart: merge those closer together than about " +
        number(1e-9 * volume->enclosingRadius()) + " m and build again");
  }
  return volume;
}

StpBv::Ptr StpBv::assemble(std::vector<Vector3d> vertices, std::vector<Ring> faces,
                           const StpBvOptions& options) {
  checkInput(vertices, options);
  checkRadius(vertices, options);
  std::vector<char> used(vertices.size(), 0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size() < 3) throw Error("face " + std::to_string(f) + " has fewer than three vertices");
    std::vector<int> sorted = faces[f];
    std::sort(sorted.begin(), sorted.end());
    if (sorted.front() < 0 || sorted.back() >= static_cast<int>(vertices.size()))
      throw Error("face " + std::to_string(f) + " names a vertex that does not exist: there are " +
                  std::to_string(vertices.size()));
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      throw Error("face " + std::to_string(f) + " names a vertex twice");
    for (const int i : sorted) used[at(i)] = 1;
  }
  if (faces.empty() ? vertices.size() > 2 : std::count(used.begin(), used.end(), 0) > 0)
    throw Error("vertex " + std::to_string(std::find(used.begin(), used.end(), 0) - used.begin()) +
                " belongs to no face");

  if (faces.empty() && vertices.size() == 2 && !((vertices[1] - vertices[0]).norm() > 0))
    throw Error("vertices 0 and 1 coincide: give one of them");

  const Ptr volume = make(std::move(vertices), std::move(faces), options);
  const PointTree tree(volume->vertices_);
  std::vector<int> near;
  const double tolerance = 4 * touchTolerance(volume->vertices_);
  for (int f = 0; f < volume->faceCount(); ++f) {
    const Patch face = volume->patch(volume->facePatch(f));
    const auto top = tree.highest(face.anchor, face.axis, 1 / volume->radii_.rho, tolerance, &near);
    if (top.height > tolerance)
      throw Error("vertex " + std::to_string(top.index) + " lies " + number(top.height) +
                  " m outside the ball of face " + std::to_string(f));
    for (const int i : volume->faces_[at(f)])
      if (std::find(near.begin(), near.end(), i) == near.end())
        throw Error("vertex " + std::to_string(i) + " of face " + std::to_string(f) +
                    " does not lie on the face's ball");
  }
  const int euler = volume->vertexCount() - volume->edgeCount() + volume->faceCount();
  if (volume->faceCount() > 0 && euler != 2)
    throw Error("the faces are not one closed surface: vertices - edges + faces is " + std::to_string(euler) +
                ", not 2");
  // Vertices that coincide pass all these tests, and so does a surface that goes round twice.
  double off = 0;
  if (soundnessOf(*volume, volume->vertices_, {}, &off) == Soundness::broken)
    throw Error(
        "the faces are no convex surface: their patches overlap or leave gaps; do two vertices coincide?");
  volume->tables_->supportError = supportErrorOf(*volume, off);
  return volume;
}

FCL_STPBV_VECTORIZED
int StpBv::owner(const Vector3d& n, int hint) const {
  if (!(n.squaredNorm() > 0)) return 0;  // zero or NaN is no direction; any patch will do
  const Packed along = pack(n);
  const bool known = static_cast<unsigned>(hint) < static_cast<unsigned>(patchCount());
  int current = known ? hint : tables_->patchNear[n];
  const PatchTable& patches = tables_->patches;
  int best = current;
  double least = kInfinity;
  // Each step crosses the boundary that `n` violates most. It lowers the height n.C over the core's
  // admissible centres C, so the walk never returns to a patch. The limit only stops a walk among regions
  // that are narrower than rounding.
  for (int step = 0; step < 64 + patchCount(); ++step) {
    const Crossing over = patches.crossing(current, along);
    if (over.past <= kBoundaryRounding) return current;
    if (over.past < least) least = over.past, best = current;
    current = over.neighbour;
  }
  for (int patch = 0; patch < patchCount(); ++patch) {
    const double past = patches.crossing(patch, along).past;
    if (past < least) least = past, best = patch;
  }
  return best;
}

Patch StpBv::patch(int index) const { return tables_->patches.patch(index); }

double StpBv::outside(int patch, const Vector3d& n) const {
  return tables_->patches.crossing(patch, pack(n)).past;
}

double StpBv::support(const Vector3d& n, int hint) const {
  const int index = owner(n, hint);
  const double h = n.dot(patch(index).anchor) + supportAboveAnchor(*this, index, n);
  return std::isfinite(h) ? h : kInfinity;
}

Vector3d StpBv::surfacePoint(const Vector3d& n, int hint) const {
  const int index = owner(n, hint);
  const Vector3d point = corePoint(*this, index, n) + radii_.r * n;
  return point.allFinite() ? point : centre_;
}

Vector3d StpBv::corner(int face, int vertex) const {
  const std::size_t f = static_cast<std::size_t>(face);
  const Vector3d& first = vertices_[at(faces_[f][0])];
  return (faceNormals_[f] + (vertices_[at(vertex)] - first) / radii_.rho).normalized();
}

std::size_t StpBv::memory() const {
  std::size_t bytes = sizeof *this + vertices_.capacity() * sizeof(Vector3d) +
                      edges_.capacity() * sizeof(Edge) + faces_.capacity() * sizeof(Ring) +
                      faceNormals_.capacity() * sizeof(Vector3d) + tables_->memory();
  for (const Ring& ring : faces_) bytes += ring.capacity() * sizeof(int);
  return bytes;
}

}  // namespace fcl_stpbv
