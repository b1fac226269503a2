// How far volumes exceed one convex hull. The hull is made once, for any number of volumes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/half_edges.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// The convex hull of a cloud, with which the volumes around it are compared (docs/theory.md, 4).
class CoveredHull {
 public:
  explicit CoveredHull(const std::vector<Eigen::Vector3d>& points);

  /// Largest distance of the volume's surface from the hull (m): the largest difference of the support
  /// functions, found at a face normal of the hull or along the normals of one of its edges.
  double max(const StpBv& volume) const;

  /// Mean height of the surface over the hull's faces, weighted by area (m). If the hull is a segment: the
  /// mean along it.
  double mean(const StpBv& volume) const;

  /// The results of max() and mean().
  OverCover of(const StpBv& volume) const { return {max(volume), mean(volume)}; }

  /// The hull's vertices, as indices into the cloud.
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
