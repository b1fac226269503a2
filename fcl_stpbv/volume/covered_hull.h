// How far volumes exceed one convex hull, which is made once.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/half_edges.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// The convex hull of a cloud, to measure volumes around it against (docs/theory.md, 4).
class CoveredHull {
 public:
  explicit CoveredHull(const std::vector<Eigen::Vector3d>& points);

  /// Largest distance of the volume's surface from the hull (m): the largest difference of the support
  /// functions, found at a face normal of the hull or along the normals of one of its edges.
  double max(const StpBv& volume) const;

  /// Mean height of the surface over the hull's faces, by area; over a segment along it (m).
  double mean(const StpBv& volume) const;

  /// Both.
  OverCover of(const StpBv& volume) const { return {max(volume), mean(volume)}; }

  /// The hull's vertices, among the points.
  const std::vector<int>& corners() const { return corners_; }

 private:
  const Eigen::Vector3d& at(int i) const { return points_[static_cast<std::size_t>(i)]; }

  std::vector<Eigen::Vector3d> points_;
  std::vector<int> corners_;
  std::vector<std::vector<int>> faces_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<HalfEdge> halfEdges_;
};

}  // namespace fcl_stpbv::detail
