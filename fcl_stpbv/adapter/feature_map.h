// Maps the features at the polyhedral witness points to the patches on which the search for the smooth
// witness points starts (paper IV.B to IV.D).
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The patches of two bodies for a polyhedral witness; -1: none. First the patches that correspond to the
/// witness's features. If the other body's witness point lies outside the Voronoi region of such a patch, the
/// neighbour on that side is taken (paper IV.B). This test is done first with the polyhedral witness points,
/// then with smooth ones.
std::array<int, 2> mapFeatures(const StpBvGeometry& a, const Eigen::Isometry3d& poseA, const StpBvGeometry& b,
                               const Eigen::Isometry3d& poseB, const PolyhedralWitness& witness);

/// Compares mapped patches with those of the answer and adds the outcome to `counts`.
void countMapping(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                  const Eigen::Isometry3d& poseB, const std::array<int, 2>& mapped, const Distance& answer,
                  MappingCounts& counts);

}  // namespace fcl_stpbv::detail
