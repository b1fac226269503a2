// Clouds that builders break on: little integer grids, circles, near-lines, near-duplicates, everything
// scaled, turned, shifted and shaken by noise at the level of rounding.
#pragma once

#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

struct CloudCase {
  test::Cloud points;
  StpBvOptions radii;
};

/// Random, and the same for the same state of `random` everywhere.
CloudCase nastyCloud(test::Random& random);

}  // namespace fcl_stpbv::fuzz
