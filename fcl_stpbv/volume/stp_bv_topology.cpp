// From vertices and rings to edges, patches, seams and the direction table (paper III.A, III.B, III.D).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 6.283185307179586476925;

// An edge that turns by more is cut into parts: the seams of a region past half a turn do not intersect in
// it, however little it is past. A flat plate's rim turns by nearly half a turn and stays whole.
constexpr double kWidestPart = 0.5 * kTwoPi;

int partsOf(const StpBv::Edge& edge) {
  return edge.face[0] < 0 || edge.turn <= kWidestPart ? 1 : static_cast<int>(std::ceil(edge.turn / 2.2));
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
  // A ball smaller than rho is itself an intersection of balls of radius rho, so it holds the core with the
  // vertices.
  volume->enclosingRadius_ = ball.radius + options.r;
  volume->extent_ = ball.centre.lpNorm<1>() + volume->enclosingRadius_;
  volume->makeEdges();
  volume->makeInnerRadius();
  volume->makePatches();
  volume->makeSeams();
  volume->makeStars();
  volume->makeTable();
  return volume;
}

void StpBv::makeEdges() {
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  for (const Ring& ring : faces_) {
    const std::array<int, 3> t = wideTriangle(vertices_, ring);
    const TouchingBall ball(at(t[0]), at(t[1]), at(t[2]), radii_.rho);
    if (!ball.valid())
      throw Error("a face's vertices lie on a line or too far apart for R = " + std::to_string(radii_.R));
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

/// The least distance from the centre to a triangle's plane: the triangles' surface is closed, so where all
/// have the centre on their inner side a ball of that radius is inside it.
void StpBv::makeInnerRadius() {
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  double least = faces_.empty() ? 0.0 : std::numeric_limits<double>::infinity();
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

void StpBv::makePatches() {
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  const auto edgePatchOf = [&](const Edge& edge) {
    // kappa = sqrt(rho^2 - l^2/4) (paper, Theorem 3.1), as a product and in long double: near the smallest R
    // half of the digits cancel.
    using Vector = Eigen::Matrix<long double, 3, 1>;
    const Vector along = at(edge.vertex[1]).cast<long double>() - at(edge.vertex[0]).cast<long double>();
    const long double half = along.norm() / 2, rho = radii_.rho;
    const long double kappa = std::sqrt(std::max(0.0L, (rho - half) * (rho + half)));
    const Vector middle = at(edge.vertex[0]).cast<long double>() + along / 2;
    return Patch{middle.cast<double>(), along.normalized().cast<double>(), static_cast<double>(kappa),
                 static_cast<double>(half * half / (rho + kappa))};
  };
  firstEdge_ = static_cast<int>(vertices_.size());
  firstFace_ = firstEdge_ + static_cast<int>(edges_.size());
  firstPart_ = firstFace_ + static_cast<int>(faces_.size());
  std::size_t further = 0;
  for (const Edge& edge : edges_) further += static_cast<std::size_t>(partsOf(edge) - 1);
  patches_.reserve(vertices_.size() + edges_.size() + faces_.size() + further);
  for (const Vector3d& p : vertices_) patches_.push_back({{p, Vector3d::Zero(), 0, 0}, {}});
  for (const Edge& edge : edges_) patches_.push_back({edgePatchOf(edge), {}});
  for (std::size_t f = 0; f < faces_.size(); ++f)
    patches_.push_back({{at(faces_[f][0]), faceNormals_[f], 0, 0}, {}});
  for (const Edge& edge : edges_)
    for (int part = 1; part < partsOf(edge); ++part) patches_.push_back({edgePatchOf(edge), {}});
}

void StpBv::makeSeams() {
  std::vector<std::pair<int, Seam>> all;  // (patch, seam)
  const auto at = [&](int i) -> const Vector3d& { return vertices_[static_cast<std::size_t>(i)]; };
  int further = facePatch(faceCount());
  for (int e = 0; e < edgeCount(); ++e) {
    const Edge& edge = edges_[static_cast<std::size_t>(e)];
    const Vector3d along = at(edge.vertex[1]) - at(edge.vertex[0]), u = along.normalized();
    const double sine = 0.5 * along.norm() / radii_.rho;  // of the cone's half angle (docs/theory.md, 3)
    std::vector<int> parts{edgePatch(e)};
    for (int k = 1; k < partsOf(edge); ++k) parts.push_back(further++);

    all.push_back({edge.vertex[0], {u, -sine, parts.front()}});
    all.push_back({edge.vertex[1], {-u, -sine, parts.back()}});
    for (const int part : parts) {
      all.push_back({part, {u, sine, edge.vertex[1]}});
      all.push_back({part, {-u, sine, edge.vertex[0]}});
    }
    if (edge.face[0] < 0) continue;

    // Planes through the edge and the two faces' ball centres, their normals pointing out of the faces.
    const Vector3d leave = along.cross(corner(edge.face[0], edge.vertex[0])).normalized();
    const Vector3d arrive = -along.cross(corner(edge.face[1], edge.vertex[0])).normalized();
    all.push_back({facePatch(edge.face[0]), {leave, 0, parts.front()}});
    all.push_back({facePatch(edge.face[1]), {arrive, 0, parts.back()}});
    all.push_back({parts.front(), {-leave, 0, facePatch(edge.face[0])}});
    all.push_back({parts.back(), {-arrive, 0, facePatch(edge.face[1])}});
    const Vector3d start = leave.cross(u);
    for (std::size_t k = 1; k < parts.size(); ++k) {
      const double angle = edge.turn * static_cast<double>(k) / static_cast<double>(parts.size());
      const Vector3d forward = std::cos(angle) * leave - std::sin(angle) * start;
      all.push_back({parts[k - 1], {forward, 0, parts[k]}});
      all.push_back({parts[k], {-forward, 0, parts[k - 1]}});
    }
  }
  std::vector<std::int32_t> last(patches_.size(), -1);  // further block with room, -1: the patch's first
  for (const auto& [patch, seam] : all) {
    const auto p = static_cast<std::size_t>(patch);
    const auto block = [&]() -> SeamBlock& {
      return last[p] < 0 ? patches_[p].seams : furtherSeams_[static_cast<std::size_t>(last[p])];
    };
    if (block().neighbour.back() >= 0) {  // full
      const auto next = static_cast<std::int32_t>(furtherSeams_.size());
      block().next = next;
      last[p] = next;
      furtherSeams_.emplace_back();
    }
    const auto& taken = block().neighbour;
    block().set(static_cast<std::size_t>(std::find(taken.begin(), taken.end(), -1) - taken.begin()), seam);
  }
  furtherSeams_.shrink_to_fit();
}

void StpBv::makeStars() {
  stars_.resize(vertices_.size());
  std::vector<std::int32_t> last(vertices_.size());  // star with room
  std::iota(last.begin(), last.end(), 0);
  std::vector<std::size_t> filled(vertices_.size(), 0);
  for (const Edge& edge : edges_)
    for (const std::size_t side : {0u, 1u}) {
      const std::size_t from = static_cast<std::size_t>(edge.vertex[side]);
      const int to = edge.vertex[1 - side];
      if (filled[from] == VertexStar::kSize) {
        const auto further = static_cast<std::int32_t>(stars_.size());
        stars_[static_cast<std::size_t>(last[from])].next = further;
        last[from] = further;
        stars_.emplace_back();
        filled[from] = 0;
      }
      const Vector3d along = vertices_[static_cast<std::size_t>(to)] - vertices_[from];
      VertexStar& star = stars_[static_cast<std::size_t>(last[from])];
      for (std::size_t slot = filled[from]++; slot < VertexStar::kSize; ++slot)
        star.set(slot, along.normalized().cast<float>(), to);
    }
  stars_.shrink_to_fit();
}

void StpBv::makeTable() {
  // Three cells a patch, up to millions: the vertex of a direction's cell is nearly always the furthest along
  // it.
  cells_ = std::clamp(static_cast<int>(std::sqrt(3.0 * patchCount())), 2, 1000);
  const std::size_t cells = static_cast<std::size_t>(cells_);
  table_.reserve(cells * cells);
  vertexTable_.reserve(cells * cells);
  int last = 0;
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t j = 0; j < cells; ++j) {
      const double x = (2 * static_cast<double>(i) + 1) / static_cast<double>(cells) - 1;
      const double y = (2 * static_cast<double>(j) + 1) / static_cast<double>(cells) - 1;
      Vector3d n(x, y, 1 - std::abs(x) - std::abs(y));
      if (n.z() < 0) n.x() = std::copysign(1 - std::abs(y), x), n.y() = std::copysign(1 - std::abs(x), y);
      n.normalize();
      last = owner(n, last);
      table_.push_back(last);
      int corner = last;  // one of the patch: its own point, else by an edge's first seam, which leads to an end
      while (corner >= vertexCount()) corner = (*seams(corner).begin()).neighbour;
      vertexTable_.push_back(climb(corner, n.cast<float>()));
    }
}

}  // namespace fcl_stpbv
