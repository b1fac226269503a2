// A volume's patches and the region boundaries between them, laid out for a query.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/volume/patch_record.h"
#include "fcl_stpbv/volume/stp_bv.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packed.h says why

namespace fcl_stpbv::detail {

/// One side of a patch's region of normals. `n` is inside iff `n.normal <= limit`; past the boundary lies
/// `neighbour`.
struct RegionBoundary {
  Eigen::Vector3d normal;
  double limit;
  int neighbour;
};

/// The boundary that a normal passes furthest. `past` is the largest `n.normal - limit`; it is <= 0 if the
/// normal is inside all boundaries.
struct Crossing {
  double past;
  int neighbour;
};

/// A normal this far past a region boundary still counts as inside: the rounding of one dot product of unit
/// vectors.
constexpr double kBoundaryRounding = 4 * std::numeric_limits<double>::epsilon();

/// Patches by number: vertices, then edges with their further parts, then faces. Boundaries are tested four
/// at a time.
class PatchTable {
 public:
  class Boundaries;

  PatchTable() = default;

  /// Joins vertices, edges and faces by the neighbours that the edges name. A face is given by its vertices,
  /// counter-clockwise, and the unit normal at its first vertex.
  /// @throws Error if there are more edges than can be numbered.
  PatchTable(const std::vector<Eigen::Vector3d>& vertices, std::vector<EdgeRecord> edges,
             const std::vector<std::vector<int>>& faces, const std::vector<Eigen::Vector3d>& normals);

  int firstEdge() const { return firstEdge_; }
  int firstFace() const { return firstFace_; }
  int count() const { return firstFace_ + static_cast<int>(faces_.size()); }
  PatchKind kind(int patch) const {
    return patch < firstEdge_ ? PatchKind::vertex : patch < firstFace_ ? PatchKind::edge : PatchKind::face;
  }

  const VertexRecord& vertex(int patch) const { return vertices_[at(patch)]; }
  const EdgeRecord& edge(int patch) const { return edges_[at(patch - firstEdge_)]; }
  const FaceRecord& face(int patch) const { return faces_[at(patch - firstFace_)]; }

  Patch patch(int index) const;
  Boundaries boundaries(int patch) const;

  /// The vertex at a side's end of its edge. Of a face's side it is the vertex where the side begins,
  /// counter-clockwise.
  int startOf(std::int32_t side) const { return edgeOf(side).past(isSecond(side) ? 0 : 1); }

  /// The boundary of the patch that `n` passes furthest. `past` is `length` (the length of `n`) times the
  /// value for a unit vector.
  Crossing crossing(int patch, const Packed& n, double length = 1.0) const {
    const Packed to = withFourth(n, length);
    return most(patch, [&](const auto& pastAll) { return pastAll(to); });
  }

  /// The boundary that is met first on the way from the unit normal `n` along the tangent `h`. `past` is the
  /// inverse of the distance to it; about 0 or less if there is none.
  Crossing ahead(int patch, const Packed& n, const Packed& h) const {
    constexpr double kAtOnce = 1e-12;  // rad; the least distance: `n` may be past the boundary already
    const Packed at = withFourth(n, 1.0), to = withFourth(h, 0.0), least = Packed{} + kAtOnce;
    return most(patch, [&](const auto& pastAll) { return pastAll(to) / larger(-pastAll(at), least); });
  }

  /// Prefetches the records of the neighbouring patches into the processor's cache, for a query that is
  /// likely to go there next. A small volume's records are in the cache anyway.
  void prefetchBeside(int patch) const {
    constexpr int kSmall = 100;  // patches; they fill half of the nearest cache
    if (count() < kSmall) return;
    switch (kind(patch)) {
      case PatchKind::vertex:
        for (const std::int32_t side : vertex(patch).sides.side) prefetch(edgeOf(side));
        break;
      case PatchKind::edge:
        for (const std::size_t k : {0u, 1u}) {
          const EdgeRecord& e = edge(patch);
          prefetch(vertex(e.past(k)));
          if (e.past(2 + k) >= firstFace_) prefetch(face(e.past(2 + k)));
        }
        break;
      case PatchKind::face:
        prefetchEdgesOf(face(patch));
    }
  }

  /// prefetchBeside(). For a volume too large to stay in the cache, it also prefetches the neighbours'
  /// neighbours.
  void prefetchAround(int patch) const {
    constexpr int kLarge = 3000;  // patches; they fill half a megabyte
    prefetchBeside(patch);
    if (count() < kLarge) return;
    switch (kind(patch)) {
      case PatchKind::vertex:
        for (const std::int32_t side : vertex(patch).sides.side) {
          const EdgeRecord& e = edgeOf(side);
          prefetch(vertex(e.past(isSecond(side) ? 1 : 0)));
          if (e.past(2) >= firstFace_) prefetch(face(e.past(2)));
        }
        break;
      case PatchKind::edge:
        for (const std::size_t k : {0u, 1u}) {
          const EdgeRecord& e = edge(patch);
          for (const std::int32_t side : vertex(e.past(k)).sides.side) prefetch(edgeOf(side).axis);
          if (e.past(2 + k) >= firstFace_) prefetchEdgesOf(face(e.past(2 + k)));
        }
        break;
      case PatchKind::face:
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t side = face(patch).side[k];
          const int over = edgeOf(side).past(isSecond(side) ? 2 : 3);
          prefetch(vertex(startOf(side)));
          if (over >= firstFace_) prefetch(face(over));
        }
    }
  }

  /// Memory that the table uses, in bytes.
  std::size_t memory() const {
    return vertices_.capacity() * sizeof(VertexRecord) + edges_.capacity() * sizeof(EdgeRecord) +
           faces_.capacity() * sizeof(FaceRecord) + further_.capacity() * sizeof(Sides);
  }

 private:
  static std::size_t bytes(std::int32_t side) { return static_cast<std::uint32_t>(side); }
  static bool isSecond(std::int32_t side) { return bytes(side) & sizeof(Wall); }
  int edgeAt(std::int32_t side) const { return firstEdge_ + side / static_cast<int>(sizeof(EdgeRecord)); }
  const char* records() const { return reinterpret_cast<const char*>(edges_.data()); }
  const EdgeRecord& edgeOf(std::int32_t side) const {
    return *reinterpret_cast<const EdgeRecord*>(records() + (bytes(side) & ~(sizeof(EdgeRecord) - 1)));
  }
  const Wall& wallOf(std::int32_t side) const {
    return *reinterpret_cast<const Wall*>(records() + bytes(side));
  }

  template <typename Record>
  static void prefetch(const Record& record) {
    constexpr std::size_t kLine = 64;  // bytes
    const char* there = reinterpret_cast<const char*>(&record);
    asm volatile("");  // without this, GCC leaves out calls of functions that only prefetch
    for (std::size_t at = 0; at < sizeof record; at += kLine) __builtin_prefetch(there + at);
  }

  void prefetchEdgesOf(const FaceRecord& face) const {
    for (std::size_t k = 0; k < 3; ++k) prefetch(edgeOf(face.side[k]));
  }

  /// A vertex's boundary: its normal, with minus its limit as the fourth number. So the product with a unit
  /// vector and a fourth number of 1 is how far the vector is past the boundary.
  Packed boundaryAtVertex(std::int32_t side) const {
    static constexpr PackedBits opposite[2] = {{}, kOpposite3};
    PackedBits bits;
    std::memcpy(&bits, reinterpret_cast<const char*>(opposite) + (bytes(side) & sizeof(Wall)), sizeof bits);
    return fromBits(bitsOf(edgeOf(side).axis) ^ bits);
  }
  /// A wall's boundary in the same form. Its limit is 0.
  static Packed boundaryOf(const Wall& wall) {
    PackedBits bits;
    std::memcpy(&bits, &wall, sizeof bits);
    return fromBits(bits & PackedBits{-1, -1, -1, 0});
  }

  /// How far `n`, with its length as the fourth number, is past the boundaries of four sides of a vertex or
  /// of a face. For a face the walls point the other way.
  template <PatchKind kind>
  Packed pastSides(const std::int32_t* side, const Packed& n) const {
    const Packed to = kind == PatchKind::face ? -n : n;
    const auto past = [&](std::size_t k) {
      return (kind == PatchKind::face ? boundaryOf(wallOf(side[k])) : boundaryAtVertex(side[k])) * to;
    };
    return sums(past(0), past(1), past(2), past(3));
  }
  /// How far `n`, with its length as the fourth number, is past the four boundaries of an edge, in the order
  /// of `EdgeRecord::past`.
  static Packed pastSidesOf(const EdgeRecord& edge, const Packed& n) {
    const Packed second = edge.axis * fromBits(bitsOf(n) ^ kOppositeFourth),
                 first = fromBits(bitsOf(second) ^ kOpposite3);
    if (!edge.hasWalls()) return sums(second, first, second, first);
    return sums(second, first, boundaryOf(edge.wall[0]) * n, boundaryOf(edge.wall[1]) * n);
  }

  /// Replaces the three lowest bits of each number by its place: `first`, `first` + 1 and so on, all below
  /// eight.
  static Packed tagged(const Packed& v, std::int64_t first) {
    constexpr PackedBits places{0, 1, 2, 3};
    return fromBits((bitsOf(v) & ~std::int64_t{Sides::kSize - 1}) | (places + first));
  }
  static std::size_t placeOf(double tagged) {
    std::uint64_t key;
    std::memcpy(&key, &tagged, sizeof key);
    return key & (Sides::kSize - 1);
  }

  /// The largest value of `measure` over the patch's boundaries, and the neighbour past the boundary that has
  /// it. `measure` is called with a function that tells how far a vector is past four boundaries; it returns
  /// four numbers.
  template <typename Measure>
  Crossing most(int patch, const Measure& measure) const {
    if (patch < firstEdge_) return mostOf<PatchKind::vertex>(vertex(patch).sides, measure);
    if (patch < firstFace_) {
      const EdgeRecord& e = edge(patch);
      const Packed four = measure([&](const Packed& n) { return pastSidesOf(e, n); });
      const double past = largest(tagged(four, 0));
      return {past, e.past(placeOf(past))};
    }
    const std::int32_t further = face(patch).further();
    std::array<std::int32_t, FaceRecord::kSize> side = face(patch).side;
    if (further >= 0) side[3] = side[2];
    const double past = largest(ofFour<PatchKind::face>(side.data(), 0, measure));
    const Crossing here{past, edgeAt(side[placeOf(past)])};
    if (further < 0) return here;
    const Crossing there = mostOf<PatchKind::face>(further_[at(further)], measure);
    return here.past >= there.past ? here : there;
  }

  /// most() for a block of eight sides and the blocks chained to it.
  template <PatchKind kind, typename Measure>
  Crossing mostOf(const Sides& first, const Measure& measure) const {
    const auto mostOfEight = [&](const Sides& sides) -> Crossing {
      const std::int32_t* side = sides.side.data();
      const double past = largest(larger(ofFour<kind>(side, 0, measure), ofFour<kind>(side, 4, measure)));
      return {past, edgeAt(side[placeOf(past)])};
    };
    Crossing most = mostOfEight(first);
    for (std::int32_t next = first.next; next >= 0;) {
      const Sides& sides = further_[at(next)];
      const Crossing other = mostOfEight(sides);
      if (other.past > most.past) most = other;
      next = sides.next;
    }
    return most;
  }

  /// The values of `measure` for four sides from place `first` on, tagged with their places.
  template <PatchKind kind, typename Measure>
  Packed ofFour(const std::int32_t* side, std::int64_t first, const Measure& measure) const {
    return tagged(measure([&](const Packed& n) { return pastSides<kind>(side + first, n); }), first);
  }

  RegionBoundary boundary(int patch, std::int32_t side) const;
  void joinSides(std::vector<std::vector<std::int32_t>>& atVertex,
                 std::vector<std::vector<std::int32_t>>& atFace);
  std::int32_t addFurther(const std::vector<std::int32_t>& sides, std::size_t from);

  int firstEdge_ = 0, firstFace_ = 0;
  std::vector<VertexRecord> vertices_;
  std::vector<EdgeRecord> edges_;  // a volume of one vertex has one edge, whose boundary holds for any normal
  std::vector<FaceRecord> faces_;
  // Sides of vertices beyond eight; of faces with more than four sides, those beyond three.
  std::vector<Sides> further_;
};

/// Goes over the boundaries of one patch, one by one.
class PatchTable::Boundaries {
 public:
  class Iterator {
   public:
    Iterator(const PatchTable& table, int patch);
    explicit Iterator(const PatchTable& table) : table_(table) {}
    RegionBoundary operator*() const { return table_.boundary(patch_, *side_); }
    Iterator& operator++();
    bool operator!=(const Iterator& other) const { return side_ != other.side_; }

   private:
    void take(const std::int32_t* sides, std::size_t size);

    const PatchTable& table_;
    int patch_ = -1;
    const std::int32_t *side_ = nullptr, *end_ = nullptr;
    std::int32_t next_ = -1;
  };

  Boundaries(const PatchTable& table, int patch) : table_(table), patch_(patch) {}
  Iterator begin() const { return {table_, patch_}; }
  Iterator end() const { return Iterator(table_); }

 private:
  const PatchTable& table_;
  int patch_;
};

inline PatchTable::Boundaries PatchTable::boundaries(int patch) const { return {*this, patch}; }

}  // namespace fcl_stpbv::detail

#pragma GCC diagnostic pop
