// The data of a vertex, an edge and a face that queries read, each in one or two cache lines.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// One of the two planes that bound an edge's region of normals, towards a face or another part of the edge.
/// It also holds two of the edge's four neighbours.
struct Wall {
  /// Unit, points out of the region.
  std::array<double, 3> normal;
  /// Neighbouring patches. First wall: past the boundaries of the second vertex and of the first one. Second
  /// wall: past the two walls.
  std::array<std::int32_t, 2> past;
};

/// An edge's patch (stp_bv.h) with the four boundaries of its region. A spindle has no walls; its second wall
/// names the two vertices again. All boundaries of a volume are stored with the edges; vertices and faces
/// refer to them as sides. An edge has two sides, each with one of its ends and one of its walls. The number
/// of a side is the byte offset of its wall from the first record.
struct alignas(64) EdgeRecord {
  Packed middle;  ///< the fourth number is kappa
  Packed axis;    ///< the fourth number is the sine
  std::array<Wall, 2> wall;

  static std::int32_t side(std::size_t edge, std::size_t end) {
    return static_cast<std::int32_t>(edge * sizeof(EdgeRecord) + offsetof(EdgeRecord, wall) +
                                     end * sizeof(Wall));
  }
  bool hasWalls() const { return past(2) != past(0); }
  std::int32_t past(std::size_t boundary) const { return wall[boundary / 2].past[boundary % 2]; }
};
static_assert(sizeof(EdgeRecord) == 128);

/// Sides of one patch. Unused places repeat the last side.
struct Sides {
  static constexpr std::size_t kSize = 8;
  std::array<std::int32_t, kSize> side;
  std::int32_t next;  ///< index of the block with the patch's further sides, -1: none
};

struct alignas(64) VertexRecord {
  Eigen::Vector3d point;
  Sides sides;
};
static_assert(sizeof(VertexRecord) == 64);

struct alignas(64) FaceRecord {
  static constexpr std::size_t kSize = 4;
  Eigen::Vector3d anchor, normal;
  /// Sides in the ring's order. A triangle repeats its last side. A face with more than four sides has three
  /// here; the last entry is ~i, with i the index of the block that has the others.
  std::array<std::int32_t, kSize> side;

  /// count(): number of sides stored here. further(): index of the block with the others, -1: none.
  std::size_t count() const { return side[3] < 0 || side[3] == side[2] ? 3 : 4; }
  std::int32_t further() const { return side[3] < 0 ? ~side[3] : -1; }
};
static_assert(sizeof(FaceRecord) == 64);

}  // namespace fcl_stpbv::detail
