// The data of a vertex, an edge and a face that queries read, each in one or two cache lines.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// Half of what bounds an edge's region of normals: the plane to a face or to another part of the edge.
struct Wall {
  std::array<double, 3> normal;      ///< unit, out of the region
  std::array<std::int32_t, 2> past;  ///< patches: the first wall's past the boundaries of the second vertex
                                     ///< and of the first, the second wall's past the two walls
};

/// An edge's patch (stp_bv.h) with the four boundaries of its region. A spindle has no walls, and its
/// vertices twice. All boundaries of a volume are stored with the edges; vertices and faces refer to them as
/// sides. An edge has two sides, each with one of its ends and one of its walls. The number of a side is the
/// byte offset of that wall among all records.
struct alignas(64) EdgeRecord {
  Packed middle;  ///< fourth: kappa
  Packed axis;    ///< fourth: sine
  std::array<Wall, 2> wall;

  static std::int32_t side(std::size_t edge, std::size_t end) {
    return static_cast<std::int32_t>(edge * sizeof(EdgeRecord) + offsetof(EdgeRecord, wall) +
                                     end * sizeof(Wall));
  }
  bool hasWalls() const { return past(2) != past(0); }
  std::int32_t past(std::size_t boundary) const { return wall[boundary / 2].past[boundary % 2]; }
};
static_assert(sizeof(EdgeRecord) == 128);

/// Sides of one patch; what is unused repeats the last.
struct Sides {
  static constexpr std::size_t kSize = 8;
  std::array<std::int32_t, kSize> side;
  std::int32_t next;  ///< of the patch's further sides, -1: none
};

struct alignas(64) VertexRecord {
  Eigen::Vector3d point;
  Sides sides;
};
static_assert(sizeof(VertexRecord) == 64);

struct alignas(64) FaceRecord {
  static constexpr std::size_t kSize = 4;
  Eigen::Vector3d anchor, normal;
  std::array<std::int32_t, kSize> side;  ///< in the ring's order, a triangle's last one twice; of more than
                                         ///< four the last one is ~ the place of the further sides

  /// How many of the sides are here, and the place of those that are not, -1: none.
  std::size_t count() const { return side[3] < 0 || side[3] == side[2] ? 3 : 4; }
  std::int32_t further() const { return side[3] < 0 ? ~side[3] : -1; }
};
static_assert(sizeof(FaceRecord) == 64);

}  // namespace fcl_stpbv::detail
