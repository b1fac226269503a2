// Makes a convex hull's edges and faces, and finds support vertices by hill climbing.
//
// 1. Make the facets by quickhull, or, if that fails because of rounding, by rolling a ball of nearly
//    infinite radius around the points (volume/rolling_ball.h).
// 2. Name its edges and the faces around each vertex.
// 3. Support: hill climbing from the last vertex (as in FCL), eight neighbours at once. A direction table
//    gives a start.
#include "fcl_stpbv/convex/hull_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {
namespace {

// Up to this many vertices, visiting all of them is faster than climbing: no indirection, no mispredicted
// branch.
constexpr int kScanLimit = 32;

// Newell's normal: exact for planar rings, and an average for slightly bent ones.
Eigen::Vector3d ringNormal(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& ring) {
  const Eigen::Vector3d& origin = points[at(ring[0])];
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += (points[at(ring[i])] - origin).cross(points[at(ring[i + 1])] - origin);
  return sum.normalized();
}

RolledHull checkedHull(const std::vector<Eigen::Vector3d>& cloud) {
  if (cloud.empty()) throw Error("convex hull: the cloud is empty; give at least one point");
  for (const Eigen::Vector3d& p : cloud)
    if (!p.allFinite()) throw Error("convex hull: a coordinate is not finite");
  return convexHull(cloud);
}

}  // namespace

HullGraph::HullGraph(const std::vector<Eigen::Vector3d>& cloud) : HullGraph(cloud, checkedHull(cloud)) {}

HullGraph::HullGraph(const std::vector<Eigen::Vector3d>& cloud, RolledHull hull) {
  cloudIndex_ = std::move(hull.vertices);
  std::vector<int> vertexOf(cloud.size(), -1);
  Eigen::Vector3d low = cloud[at(cloudIndex_[0])], high = low;
  for (int v = 0; v < static_cast<int>(cloudIndex_.size()); ++v) {
    const Eigen::Vector3d& p = cloud[at(cloudIndex_[at(v)])];
    vertexOf[at(cloudIndex_[at(v)])] = v;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  centre_ = 0.5 * (low + high);
  points_.reserve(cloudIndex_.size());
  for (const int i : cloudIndex_) {
    points_.push_back(cloud[at(i)] - centre_);
    radius_ = std::max(radius_, points_.back().norm());
  }
  faces_ = std::move(hull.faces);
  for (Ring& ring : faces_)
    for (int& v : ring) v = vertexOf[at(v)];
  for (const Ring& ring : faces_) normals_.push_back(ringNormal(points_, ring));
  if (faces_.size() == 2)
    normals_[1] = -normals_[0];  // flat hull: the two normals are opposite, without rounding
  makeEdges();
  makeChunks();
  makeTable();
}

void HullGraph::makeEdges() {
  std::vector<std::array<int, 3>>
      sides;  // for each side of each face: the ends in ascending order, and the face
  for (int f = 0; f < faceCount(); ++f) {
    const Ring& ring = faces_[at(f)];
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int a = ring[i], b = ring[(i + 1) % ring.size()];
      sides.push_back({std::min(a, b), std::max(a, b), f});
    }
  }
  if (faces_.empty() && vertexCount() == 2) sides.push_back({0, 1, -1});
  std::sort(sides.begin(), sides.end());
  for (const auto& [a, b, face] : sides) {
    const std::array<int, 2> ends{a, b};
    if (!edges_.empty() && edges_.back() == ends) {
      edgeFaces_.back()[1] = face;
    } else {
      edges_.push_back(ends);
      edgeFaces_.push_back({face, -1});
    }
  }

  std::vector<std::vector<std::array<int, 2>>> around(points_.size());
  for (int e = 0; e < edgeCount(); ++e) {
    const auto [a, b] = edges_[at(e)];
    around[at(a)].push_back({b, e});
    around[at(b)].push_back({a, e});
  }
  std::vector<std::vector<int>> facesAround(points_.size());
  for (int f = 0; f < faceCount(); ++f)
    for (const int v : faces_[at(f)]) facesAround[at(v)].push_back(f);

  start_.push_back(0);
  faceStart_.push_back(0);
  for (std::size_t v = 0; v < points_.size(); ++v) {
    for (const auto& [neighbour, edge] : around[v]) {
      neighbours_.push_back(neighbour);
      neighbourEdges_.push_back(edge);
    }
    vertexFaces_.insert(vertexFaces_.end(), facesAround[v].begin(), facesAround[v].end());
    start_.push_back(static_cast<std::int32_t>(neighbours_.size()));
    faceStart_.push_back(static_cast<std::int32_t>(vertexFaces_.size()));
  }
}

void HullGraph::makeTable() {
  if (vertexCount() <= kScanLimit) return;
  // About one cell for two vertices, so that a climb from the cell's vertex takes a step or two.
  int last = 0;
  table_ = DirectionTable(std::clamp(static_cast<int>(std::sqrt(0.5 * vertexCount())), 2, 78),
                          [&](const Eigen::Vector3d& n) { return last = climb(n, last); });
}

void HullGraph::makeChunks() {
  if (vertexCount() <= kScanLimit) {
    std::vector<std::int32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0);
    addChunks(all.data(), all.data() + all.size());
    return;
  }
  chunkStart_.push_back(0);
  for (int v = 0; v < vertexCount(); ++v) {
    addChunks(neighboursBegin(v), neighboursEnd(v));
    chunkStart_.push_back(static_cast<std::int32_t>(chunks_.size()));
  }
}

void HullGraph::addChunks(const std::int32_t* begin, const std::int32_t* end) {
  for (const std::int32_t* it = begin; it < end; it += 8) {
    Chunk& chunk = chunks_.emplace_back();
    for (std::size_t i = 0; i < 8; ++i) {
      const std::int32_t v = it + i < end ? it[i] : *it;
      const auto k = static_cast<Eigen::Index>(i);
      chunk.vertex[i] = v;
      chunk.x[k] = point(v)[0];
      chunk.y[k] = point(v)[1];
      chunk.z[k] = point(v)[2];
    }
  }
}

// Replaces `vertex` by the highest one in the chunks, if that one is higher. One branch per chunk.
bool HullGraph::higherIn(std::int32_t firstChunk, std::int32_t lastChunk, const Eigen::Vector3d& direction,
                         double& height, int& vertex) const {
  const double nx = direction[0], ny = direction[1], nz = direction[2];
  bool higher = false;
  for (std::int32_t c = firstChunk; c < lastChunk; ++c) {
    const Chunk& chunk = chunks_[at(c)];
    const Chunk::Eight h = nx * chunk.x + ny * chunk.y + nz * chunk.z;
    const double highest = h.maxCoeff();
    if (!(highest > height)) continue;
    height = highest;
    int which = 0;
    for (int i = 1; i < 8; ++i) which = h[i] >= highest ? i : which;
    vertex = chunk.vertex[at(which)];
    higher = true;
  }
  return higher;
}

int HullGraph::climb(const Eigen::Vector3d& direction, int from) const {
  double height =
      direction[0] * point(from)[0] + direction[1] * point(from)[1] + direction[2] * point(from)[2];
  while (higherIn(chunkStart_[at(from)], chunkStart_[at(from) + 1], direction, height, from)) {
  }
  return from;
}

FCL_STPBV_VECTORIZED
int HullGraph::extremeVertex(const Eigen::Vector3d& direction, int from) const {
  if (!table_.empty()) return climb(direction, from >= 0 ? from : table_[direction]);
  double height = -kInfinity;
  int best = 0;
  higherIn(0, static_cast<std::int32_t>(chunks_.size()), direction, height, best);
  return best;
}

HullFeature HullGraph::featureOf(const int* vertices, int count) const {
  const int first = vertices[0];
  if (count == 1) return {PatchKind::vertex, first};
  if (count == 2) {
    const std::int32_t* begin = neighboursBegin(first);
    const std::int32_t* found = std::find(begin, neighboursEnd(first), vertices[1]);
    if (found != neighboursEnd(first))
      return {PatchKind::edge, neighbourEdges_[at(start_[at(first)]) + at(static_cast<int>(found - begin))]};
  }
  // Two vertices without a common edge, or three vertices: the face that they share.
  const auto hasFace = [&](int v, std::int32_t face) {
    const auto begin = vertexFaces_.begin();
    return std::binary_search(begin + faceStart_[at(v)], begin + faceStart_[at(v) + 1], face);
  };
  for (std::int32_t i = faceStart_[at(first)]; i < faceStart_[at(first) + 1]; ++i) {
    const std::int32_t face = vertexFaces_[at(i)];
    bool all = true;
    for (int k = 1; k < count; ++k) all = all && hasFace(vertices[k], face);
    if (all) return {PatchKind::face, face};
  }
  return {PatchKind::vertex, first};
}

}  // namespace fcl_stpbv::detail
