// Makes the whole volume from its vertices and faces (paper, III.A, III.B, III.D): pairs half-edges, makes
// the patches with the planes and cones between them, an inscribed ball, and the table from directions to
// patches.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/half_edges.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/point_depth.h"
#include "fcl_stpbv/volume/query_tables.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

// An edge whose normals turn by more than this is split into parts, because a region of more than half a turn
// is not an intersection of half spaces. The rim of a flat plate turns by nearly half a turn and is not
// split.
constexpr double kWidestPart = kPi;
constexpr double kPartTurn = 2.2;  // rad; well below half a turn, and gives at most three parts

std::size_t partsOf(const StpBv::Edge& edge) {
  return edge.face[0] < 0 || edge.turn <= kWidestPart
             ? 1
             : static_cast<std::size_t>(std::ceil(edge.turn / kPartTurn));
}

/// An edge's patch with its two vertices as neighbours and without walls. kappa = sqrt(rho^2 - l^2/4) (paper,
/// Theorem 3.1) is computed as a product and in long double, because near the smallest R half of the digits
/// cancel.
EdgeRecord withoutWalls(const Vector3d& first, const Vector3d& second, const StpBv::Edge& edge,
                        long double rho) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Vector start = first.cast<long double>(), along = second.cast<long double>() - start;
  const long double half = along.norm() / 2;
  const auto kappa = static_cast<double>(std::sqrt(std::max(0.0L, (rho - half) * (rho + half))));
  const auto sine = static_cast<double>(half / rho);
  const Vector3d middle = (start + along / 2).cast<double>(), u = along.normalized().cast<double>();
  const Wall wall{{}, {edge.vertex[1], edge.vertex[0]}};
  return {withFourth(pack(middle), kappa), withFourth(pack(u), sine), {wall, wall}};
}

/// A few faces near `centre`, the nearest first, whose normals are well apart.
std::vector<int> shallowFaces(const PatchTable& patches, const Vector3d& centre) {
  constexpr std::size_t kMost = 6;      // as many as a box has
  constexpr double kNeighbours = 0.87;  // cosine of 30 degrees
  std::vector<int> shallow;
  while (shallow.size() < kMost) {
    int lowest = -1;
    double least = kInfinity;
    for (int f = patches.firstFace(); f < patches.count(); ++f) {
      const Packed normal = pack(patches.face(f).normal);
      const double height = dot(normal, pack(patches.face(f).anchor) - pack(centre));
      if (height < least && std::all_of(shallow.begin(), shallow.end(), [&](int other) {
            return dot(normal, pack(patches.face(other).normal)) < kNeighbours;
          }))
        least = height, lowest = f;
    }
    if (lowest < 0) break;
    shallow.push_back(lowest);
  }
  return shallow;
}

}  // namespace

StpBv::Ptr StpBv::make(std::vector<Vector3d> vertices, std::vector<Ring> faces, const StpBvOptions& options) {
  const std::shared_ptr<StpBv> volume(new StpBv);
  volume->radii_ = {options.r, options.R, options.R - options.r};
  volume->vertices_ = std::move(vertices);
  volume->faces_ = std::move(faces);
  volume->vertices_.shrink_to_fit();
  volume->faces_.shrink_to_fit();
  const Ball ball = minimumEnclosingBall(volume->vertices_);
  volume->centre_ = ball.centre;
  // A ball smaller than rho is itself an intersection of balls of radius rho. So if it contains the vertices,
  // it contains the core.
  volume->enclosingRadius_ = ball.radius + options.r;
  volume->extent_ = ball.centre.lpNorm<1>() + volume->enclosingRadius_;
  volume->makeEdges();
  volume->makeInnerRadius();
  const auto tables = std::make_shared<QueryTables>();
  volume->tables_ = tables;
  volume->makePatches(*tables);
  volume->makeDirectionTables(*tables);
  return volume;
}

void StpBv::makeEdges() {
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  for (const Ring& ring : faces_) {
    const std::array<int, 3> t = wideTriangle(vertices_, ring);
    const TouchingBall ball(at(t[0]), at(t[1]), at(t[2]), radii_.rho);
    if (!ball.valid())
      throw Error(formatted("a face's vertices lie on a line or too far apart for R = %.9g", radii_.R));
    faceNormals_.push_back(ball.normalAt(at(ring[0])));
  }
  faceNormals_.shrink_to_fit();
  if (faces_.empty()) {
    if (vertices_.size() == 2) edges_.push_back({{0, 1}, {-1, -1}, kTwoPi});
    return;
  }
  const std::vector<HalfEdge> halfEdges = pairHalfEdges(vertices_, faces_, faceNormals_, radii_.rho);
  edges_.reserve(halfEdges.size() / 2);
  for (std::size_t h = 0; h < halfEdges.size(); ++h) {
    const HalfEdge& e = halfEdges[h];
    if (static_cast<std::size_t>(e.twin) < h) continue;
    const Ring& ring = faces_[static_cast<std::size_t>(e.face)];
    const std::size_t k = static_cast<std::size_t>(e.corner);
    edges_.push_back({{ring[k], ring[(k + 1) % ring.size()]},
                      {e.face, halfEdges[static_cast<std::size_t>(e.twin)].face},
                      e.turn});
  }
}

/// The least distance from the centre to a triangle's plane. The triangles form a closed surface. So if all
/// of them have the centre on their inner side, a ball of that radius is inside the surface.
void StpBv::makeInnerRadius() {
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  double least = faces_.empty() ? 0.0 : kInfinity;
  for (const Ring& ring : faces_) {
    const Vector3d& first = at(ring[0]);
    for (std::size_t k = 2; k < ring.size(); ++k) {
      const Vector3d p = at(ring[k - 1]) - first, q = at(ring[k]) - first, normal = p.cross(q);
      const double area = normal.norm(), sliver = p.norm() * q.norm() / area;
      const double height = (first - centre_).dot(normal) / area - kRounding * sliver * extent_;
      if (!(height > 0.0)) return;
      least = std::min(least, height);
    }
  }
  innerRadius_ = least;
}

void StpBv::makePatches(QueryTables& tables) {
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  std::size_t count = 0;
  for (const Edge& edge : edges_) count += partsOf(edge);
  std::vector<EdgeRecord> records(count);
  const std::int32_t firstEdge = vertexCount(), firstFace = firstEdge + static_cast<std::int32_t>(count);
  std::int32_t further = firstEdge + edgeCount();
  for (int e = 0; e < edgeCount(); ++e) {
    const Edge& edge = edges_[static_cast<std::size_t>(e)];
    const Vector3d along = at(edge.vertex[1]) - at(edge.vertex[0]);
    const EdgeRecord whole = withoutWalls(at(edge.vertex[0]), at(edge.vertex[1]), edge, radii_.rho);
    std::vector<std::int32_t> parts{firstEdge + e};
    while (parts.size() < partsOf(edge)) parts.push_back(further++);
    const auto recordOf = [&](std::size_t part) -> EdgeRecord& {
      return records[static_cast<std::size_t>(parts[part] - firstEdge)];
    };
    for (std::size_t k = 0; k < parts.size(); ++k) recordOf(k) = whole;
    if (edge.face[0] < 0) continue;

    // Between two faces in one plane an edge turns by almost nothing. Its two planes would then also contain
    // the opposite normals. So each plane is tilted outwards by the rounding of a few dot products, which
    // separates the two sides.
    constexpr double kThinnest = 16 * std::numeric_limits<double>::epsilon();  // rad
    const double lean = edge.turn < kThinnest ? kThinnest : 0.0;
    const auto setWall = [&](std::size_t part, std::size_t k, const Vector3d& normal, std::int32_t past) {
      EdgeRecord& record = recordOf(part);
      record.wall[k].normal = {normal.x(), normal.y(), normal.z()};
      record.wall[1].past[k] = past;
    };
    // Planes through the edge and the centre of each face's ball. Their normals point out of the faces.
    const Vector3d u = along.normalized();
    const Vector3d leave = along.cross(corner(edge.face[0], edge.vertex[0])).normalized();
    const Vector3d arrive = -along.cross(corner(edge.face[1], edge.vertex[0])).normalized();
    const Vector3d start = leave.cross(u), end = u.cross(arrive);
    setWall(0, 0, -leave - lean * start, firstFace + edge.face[0]);
    setWall(parts.size() - 1, 1, -arrive - lean * end, firstFace + edge.face[1]);
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const double angle = edge.turn * static_cast<double>(k) / static_cast<double>(parts.size());
      const Vector3d forward = std::cos(angle) * leave - std::sin(angle) * start;
      setWall(k - 1, 1, forward, parts[k]);
      setWall(k, 0, -forward, parts[k - 1]);
    }
  }
  tables.patches = PatchTable(vertices_, std::move(records), faces_, faceNormals_);
  firstFace_ = tables.patches.firstFace();
  tables.shallowFaces = shallowFaces(tables.patches, centre_);
  tables.capHeight = capHeight(*this);
}

void StpBv::makeDirectionTables(QueryTables& tables) const {
  std::vector<std::array<int, 2>> ends;
  ends.reserve(edges_.size());
  for (const Edge& edge : edges_) ends.push_back(edge.vertex);
  tables.graph = VertexGraph(vertices_, ends);
  tables.box = boxAround(vertices_, ends);
  // About three cells per patch: then the vertex stored for a cell is nearly always the furthest one along a
  // direction in the cell. Large volumes have about one cell per patch, because a larger table would no
  // longer fit into the cache; at most a million.
  const double count = std::min(3.0 * patchCount(), patchCount() + 2000.0);
  const int side = std::clamp(static_cast<int>(std::sqrt(count)), 2, 1000);
  int last = 0;
  tables.patchNear = DirectionTable(side, [&](const Vector3d& n) { return last = owner(n, last); });
  tables.vertexNear = DirectionTable(side, [&](const Vector3d& n) {
    // Starts from a vertex of the patch. Over the first boundary a face leads to an edge, and an edge to one
    // of its ends.
    int corner = tables.patchNear[n];
    while (corner >= vertexCount()) corner = (*tables.patches.boundaries(corner).begin()).neighbour;
    return tables.graph.climb(corner, n.cast<float>());
  });
}

}  // namespace fcl_stpbv
