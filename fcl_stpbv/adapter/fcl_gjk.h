// FCL's GJK (fcl::detail::libccd_extension) without its assertions.
//
// They test rounding against absolute bounds and end the process where a touching pair
// exceeds one; the caller checks the simplex itself. What the header pulls in is included
// first, so that only its own functions lose them.
#pragma once

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#include <fcl/narrowphase/detail/failed_at_this_configuration.h>

#ifndef NDEBUG
#define NDEBUG
#define FCL_STPBV_RESTORE_ASSERTIONS
#endif
#include <cassert>  // defines assert anew each time

// clang-format off
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>
// clang-format on

#ifdef FCL_STPBV_RESTORE_ASSERTIONS
#undef FCL_STPBV_RESTORE_ASSERTIONS
#undef NDEBUG
#include <cassert>
#endif
