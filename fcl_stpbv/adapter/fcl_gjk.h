// FCL's GJK (fcl::detail::libccd_extension) without its assertions.
//
// The assertions compare rounding errors with absolute bounds, and would abort the process for some touching
// pairs. The caller checks the simplex itself. The other headers that FCL's header includes are included
// first, so that only FCL's own functions lose their assertions.
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
#include <cassert>  // each inclusion defines assert anew

// clang-format off
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>
// clang-format on

#ifdef FCL_STPBV_RESTORE_ASSERTIONS
#undef FCL_STPBV_RESTORE_ASSERTIONS
#undef NDEBUG
#include <cassert>
#endif
