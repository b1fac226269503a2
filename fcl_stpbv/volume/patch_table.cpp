// Arrays of a volume's patches and region boundaries, for queries. Each boundary is stored once, with its
// edge. The sides of a patch are indices in blocks of four, which are tested together.
#include "fcl_stpbv/volume/patch_table.h"

#include <algorithm>
#include <limits>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// Copies the sides into a block, and repeats the last one in the places left over.
template <std::size_t kSize>
void fill(std::array<std::int32_t, kSize>& block, const std::int32_t* sides, std::size_t count) {
  for (std::size_t k = 0; k < kSize; ++k) block[k] = sides[std::min(k, count - 1)];
}

}  // namespace

PatchTable::PatchTable(const std::vector<Vector3d>& vertices, std::vector<EdgeRecord> edges,
                       const std::vector<std::vector<int>>& faces, const std::vector<Vector3d>& normals)
    : firstEdge_(static_cast<int>(vertices.size())),
      firstFace_(firstEdge_ + static_cast<int>(edges.size())),
      edges_(std::move(edges)) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max() / sizeof(EdgeRecord);
  if (edges_.size() > kMost)
    throw Error("a volume cannot have more than " + std::to_string(kMost) +
                " edges: reduce the points first");
  std::vector<std::vector<std::int32_t>> atVertex(vertices.size()), atFace(faces.size());
  joinSides(atVertex, atFace);
  vertices_.reserve(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const std::vector<std::int32_t>& sides = atVertex[v];
    const std::size_t here = std::min(sides.size(), Sides::kSize);
    vertices_.push_back({vertices[v], {{}, addFurther(sides, here)}});
    fill(vertices_.back().sides.side, sides.data(), here);
  }
  std::vector<std::size_t> place(vertices.size());  // of each vertex in the face's ring
  faces_.reserve(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t i = 0; i < faces[f].size(); ++i) place[at(faces[f][i])] = i;
    std::vector<std::int32_t>& sides = atFace[f];
    std::sort(sides.begin(), sides.end(),
              [&](std::int32_t p, std::int32_t q) { return place[at(startOf(p))] < place[at(startOf(q))]; });
    const bool more = sides.size() > FaceRecord::kSize;
    const std::size_t here = std::min(sides.size(), FaceRecord::kSize - more);
    faces_.push_back({vertices[at(faces[f][0])], normals[f], {}});
    fill(faces_.back().side, sides.data(), here);
    if (more) faces_.back().side.back() = ~addFurther(sides, here);
  }
  further_.shrink_to_fit();
}

/// An edge may have several parts. Its first vertex and first wall belong to its first part, the second ones
/// to its last part.
void PatchTable::joinSides(std::vector<std::vector<std::int32_t>>& atVertex,
                           std::vector<std::vector<std::int32_t>>& atFace) {
  for (auto& sides : atVertex) sides.reserve(Sides::kSize);  // nearly always enough
  for (auto& sides : atFace) sides.reserve(FaceRecord::kSize);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (const std::size_t k : {0u, 1u}) {
      const std::int32_t past = edges_[e].past(2 + k), side = EdgeRecord::side(e, k);
      if (past >= firstEdge_ && past < firstFace_) continue;
      atVertex[at(startOf(side))].push_back(side);
      if (past >= firstFace_) atFace[at(past - firstFace_)].push_back(side);
    }
  if (!edges_.empty()) return;
  edges_.push_back({Packed{}, Packed{0, 0, 0, -2}, {}});
  atVertex[0] = {EdgeRecord::side(0, 0)};
}

/// Stores the sides from number `from` on in a chain of blocks. Returns the index of the first block, -1 if
/// there is none.
std::int32_t PatchTable::addFurther(const std::vector<std::int32_t>& sides, std::size_t from) {
  std::int32_t next = -1;
  for (std::size_t blocks = (sides.size() - from + Sides::kSize - 1) / Sides::kSize; blocks-- > 0;) {
    const std::size_t at = from + blocks * Sides::kSize;
    further_.push_back({{}, next});
    fill(further_.back().side, &sides[at], std::min(Sides::kSize, sides.size() - at));
    next = static_cast<std::int32_t>(further_.size()) - 1;
  }
  return next;
}

Patch PatchTable::patch(int index) const {
  switch (kind(index)) {
    case PatchKind::edge: {
      const EdgeRecord& e = edge(index);
      return {unpack(e.middle), unpack(e.axis), e.middle[3], e.axis[3]};
    }
    case PatchKind::face:
      return {face(index).anchor, face(index).normal, 0, 0};
    case PatchKind::vertex:
      break;
  }
  return {vertex(index).point, Vector3d::Zero(), 0, 0};
}

RegionBoundary PatchTable::boundary(int patch, std::int32_t side) const {
  switch (kind(patch)) {
    case PatchKind::edge: {  // the edge's own, numbered as in `EdgeRecord::past`
      const EdgeRecord& e = edge(patch);
      const auto k = static_cast<std::size_t>(side);
      if (k > 1) return {unpack(boundaryOf(e.wall[k - 2])), 0, e.past(k)};
      return {k == 0 ? unpack(e.axis) : unpack(-e.axis), e.axis[3], e.past(k)};
    }
    case PatchKind::face:
      return {unpack(-boundaryOf(wallOf(side))), 0, edgeAt(side)};
    case PatchKind::vertex:
      break;
  }
  const Packed at = boundaryAtVertex(side);
  return {unpack(at), -at[3], edgeAt(side)};
}

PatchTable::Boundaries::Iterator::Iterator(const PatchTable& table, int patch)
    : table_(table), patch_(patch) {
  static constexpr std::array<std::int32_t, 4> own{0, 1, 2, 3};
  switch (table.kind(patch)) {
    case PatchKind::vertex:
      if (table.firstEdge_ == table.firstFace_) break;
      next_ = table.vertex(patch).sides.next;
      take(table.vertex(patch).sides.side.data(), Sides::kSize);
      break;
    case PatchKind::edge:
      take(own.data(), table.edge(patch).hasWalls() ? 4 : 2);
      break;
    case PatchKind::face:
      next_ = table.face(patch).further();
      take(table.face(patch).side.data(), table.face(patch).count());
  }
}

void PatchTable::Boundaries::Iterator::take(const std::int32_t* sides, std::size_t size) {
  while (size > 1 && sides[size - 1] == sides[size - 2]) --size;
  side_ = sides;
  end_ = sides + size;
}

PatchTable::Boundaries::Iterator& PatchTable::Boundaries::Iterator::operator++() {
  if (++side_ != end_) return *this;
  side_ = nullptr;
  if (next_ < 0) return *this;
  const Sides& sides = table_.further_[at(next_)];
  next_ = sides.next;
  take(sides.side.data(), Sides::kSize);
  return *this;
}

}  // namespace fcl_stpbv::detail
