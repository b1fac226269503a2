// Removes duplicate triangles of a mesh: faces that were written twice or from both sides, and walls between
// bodies.
#pragma once

#include <array>
#include <vector>

namespace fcl_stpbv::detail {

/// Merges triangles with the same three corners, in any orientation. If an edge then has an odd number of
/// triangles, as along a fin or around a wall between two bodies, the merged triangles are a sheet: two of
/// them stay, with opposite orientations, which enclose nothing. Returns for each triangle whether it belongs
/// to a sheet. Vertices with equal coordinates must have been merged before.
std::vector<char> joinCopies(std::vector<std::array<int, 3>>& triangles);

}  // namespace fcl_stpbv::detail
