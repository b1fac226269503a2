// Triangles that a mesh has more than once: faces written twice or from both sides, and walls between bodies.
#pragma once

#include <array>
#include <vector>

namespace fcl_stpbv::detail {

/// Takes triangles with the same three corners for one, whatever their directions. Where that leaves an edge
/// with an odd number of triangles, as along a fin or around a wall between two bodies, they are a sheet: two
/// of them stay, in opposite directions, which enclose nothing between them. Returns for each triangle
/// whether it belongs to a sheet. Corners are to be welded.
std::vector<char> joinCopies(std::vector<std::array<int, 3>>& triangles);

}  // namespace fcl_stpbv::detail
