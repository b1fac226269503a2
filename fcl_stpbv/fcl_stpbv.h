// Includes all public headers that an FCL user needs: volumes and their files, exact distances and
// derivatives, and the replacements for FCL's functions.
#pragma once

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_hessian.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/hessian.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "fcl_stpbv/volume/tessellate.h"

/// Exact signed distances with continuous gradients, between STP-BVs and from STP-BVs to FCL's geometries.
/// The robot component handles whole robots. Names in `fcl_stpbv::detail` are internal and may change at any
/// time.
namespace fcl_stpbv {}
