// From the polyhedral witness to the patches the smooth witness is looked for on (paper IV.B to IV.D).
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The patches of two bodies a polyhedral witness points at: those named like its features, then where the
/// other body's witness point lies outside such a patch's Voronoi region, the neighbour on that side (paper
/// IV.B); tested first with the polyhedral witness points, then with smooth ones. -1: none.
std::array<int, 2> mapFeatures(const StpBvGeometry& a, const Eigen::Isometry3d& poseA, const StpBvGeometry& b,
                               const Eigen::Isometry3d& poseB, const PolyhedralWitness& witness);

/// Compares mapped patches with those of the answer and adds the outcome to `counts`.
void countMapping(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                  const Eigen::Isometry3d& poseB, const std::array<int, 2>& mapped, const Distance& answer,
                  MappingCounts& counts);

}  // namespace fcl_stpbv::detail
