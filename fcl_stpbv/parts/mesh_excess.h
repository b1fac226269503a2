// How far a surface around a mesh is from the mesh, at most.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv {

/// How close a bound is asked for, and when to end.
struct ExcessOptions {
  double absolute = 1e-5;  ///< the bound is within this (m)
  double relative = 1e-3;  ///< plus this part of it, of the truth,
  long queries = 1000000;  ///< unless that would take more distances than this
  bool filled = true;      ///< points that the mesh encloses count 0; else all points from its triangles
  double enough =
      std::numeric_limits<double>::infinity();  ///< ends once the truth is seen to exceed this (m)
};

/// For a figure to read rather than a proof: a tenth of a second, within 2 % and 0.1 mm as a rule.
inline ExcessOptions quickExcess(bool filled) {
  ExcessOptions options;
  options.relative = 0.02;
  options.queries = 20000;
  options.filled = filled;
  return options;
}

/// Largest distance of a surface's points from a mesh: lower <= truth <= upper. Lengths in m.
struct MeshExcess {
  double upper = 0;                ///< certified upper bound (m)
  double lower = 0;                ///< found at `where` (m)
  Eigen::Vector3d where{0, 0, 0};  ///< a point of the surface (m)
};

/// Branch and bound over the surface's triangles. The distance from the mesh changes by no more than one
/// moves, and that from one convex set, as a triangle is, is largest at a corner; so a triangle's bound is
/// the smaller of the distance at its middle plus its radius, and of its corners' distances from the mesh's
/// triangle next to its middle.
MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                    const ExcessOptions& options = {});

/// The same of the surface of the convex hull of a cloud.
/// @throws Error as rollBall() does.
MeshExcess hullExcess(const std::vector<Eigen::Vector3d>& points, const MeshSolid& mesh,
                      const ExcessOptions& options = {});

/// The triangles of the convex hull's surface; a flat hull has two sides, a segment
/// and a point one triangle that is one.
std::vector<Triangle> hullTriangles(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv
