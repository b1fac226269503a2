#include "fcl_stpbv/distance/ball_crown.h"

#include <cmath>

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

FCL_STPBV_VECTORIZED
bool ballCloses(const Packed& centre, double radius, const Corners& corners, const Packed& n, double depth) {
  Packed wall[Corners::kMost];  // unit outward normal of the plane over a side that touches the ball
  for (std::size_t i = 0; i < corners.count; ++i) {
    const Packed &p = corners.point[i], side = corners.point[(i + 1) % corners.count] - p;
    const double side2 = dot(side, side);
    const Packed in = centre - p - dot(centre - p, side) / side2 * side;
    const double in2 = dot(in, in), tangent2 = in2 - radius * radius;
    if (!(tangent2 > 0.0)) return false;
    wall[i] = (std::sqrt(tangent2 / side2) * cross(in, side) - radius * in) / in2;
    if (!(dot(wall[i], p) >= depth)) return false;
  }
  for (std::size_t i = 0; i < corners.count; ++i) {
    const std::size_t j = (i + 1) % corners.count;
    const Packed &p = corners.point[j], turn = cross(wall[i], wall[j]);
    if (!(dot(turn, n) < 0.0)) return false;
    // From wall to wall the cone's normals go along a circle, on which the planes' distance from the origin
    // is a sine: the least is at an end unless the sine's own least is between them.
    const bool rises = dot(centre, cross(wall[i], p)) <= 0.0, falls = dot(centre, cross(wall[j], p)) >= 0.0,
               halfTurn = !(dot(turn, p - centre) > 0.0);
    if (!(halfTurn ? rises && falls : rises || falls)) return false;
  }
  return true;
}

}  // namespace fcl_stpbv
