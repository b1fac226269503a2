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

/// The same for clouds as degenerate meshes hold them, four to fourteen points of a few centimetres to a
/// metre: triples nearly on a line, slivers of aspect 1e-9 and less, coordinates rounded to float32 or to few
/// digits, vertices doubled 1e-8 apart, coplanar and cospherical sets.
CloudCase nearDegenerateCloud(test::Random& random);

}  // namespace fcl_stpbv::fuzz
