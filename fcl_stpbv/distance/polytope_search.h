// A normal near the answer's, from the bodies' vertices alone: GJK on the two point sets.
#pragma once

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv {

/// A vertex of each body.
struct VertexPair {
  int a;
  int b;
};

/// Unit normal of the widest gap between the two point sets (Gilbert, Johnson, Keerthi 1988): the paper's
/// first step (IV.B), done without any other library. Starts from the corners of a patch pair where they now
/// are
/// (`repose`), or from the normal `n`; leaves the last support vertices in `vertex`. A hint only: it may be
/// off where the STP-BV's own triangulation is not convex, and is false when it finds no gap.
///
/// The normal of a polyhedral witness falls into the region of the smooth patch of the same name: an edge's
/// cone is centred on the plane across it, a face's region holds its plane's normal (paper IV.C, IV.D).
bool searchVertices(const BodyPair& pair, Eigen::Vector3d& n, const std::array<int, 2>& patch, bool repose,
                    VertexPair& vertex);

}  // namespace fcl_stpbv
