// Builds the volume of a number of random points on a sphere. instructions_per_point counts its instructions.
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/arguments.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "POINTS", 1);
  test::Random random(1);
  test::Cloud points;
  for (int i = arguments.number(1, 1000); i > 0; --i) points.push_back(0.2 * random.direction());
  return StpBv::build(points, {0.01, 10})->vertexCount() > 0 ? 0 : 1;
}
