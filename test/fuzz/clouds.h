// Clouds that often break builders: small integer grids, circles, near-lines, near-duplicates, all of them
// scaled, turned, shifted, and with noise at the level of rounding.
#pragma once

#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

struct CloudCase {
  test::Cloud points;
  StpBvOptions radii;
};

/// A random cloud, the same on every machine for the same state of `random`.
CloudCase nastyCloud(test::Random& random);

/// A random cloud as in degenerate meshes: four to fourteen points of a few centimetres to a metre, with
/// triples nearly on a line, slivers of aspect 1e-9 and less, coordinates rounded to float32 or to few
/// digits, vertices duplicated 1e-8 apart, coplanar and cospherical sets.
CloudCase nearDegenerateCloud(test::Random& random);

}  // namespace fcl_stpbv::fuzz
