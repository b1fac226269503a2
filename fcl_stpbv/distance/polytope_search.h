// A normal near the answer's, from the bodies' vertices alone: GJK on the two point sets.
#pragma once

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv {

/// Vertices where a search over the two point sets starts, and ends.
struct VertexPair {
  int a;
  int b;
};

/// Unit normal of the widest gap between the two point sets, `n` to start with (Gilbert, Johnson, Keerthi
/// 1988): the paper's first step (IV.B), done without any other library. A hint only: it may be off where the
/// STP-BV's own triangulation is not convex, and is false when it finds no gap.
///
/// The normal of a polyhedral witness falls into the region of the smooth patch of the same name: an edge's
/// cone is centred on the plane across it, a face's region holds its plane's normal (paper IV.C, IV.D).
bool searchVertices(const BodyPair& pair, Eigen::Vector3d& n, VertexPair& vertex);

/// A vertex of the patch, to start a search from.
int vertexOf(const StpBv& body, int patch);

}  // namespace fcl_stpbv
