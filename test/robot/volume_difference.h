// By how much two volumes differ that should be the same.
#pragma once

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/volume/stp_bv.h"
#include "test/shapes.h"

namespace fcl_stpbv::test {

/// Largest distance between the two surfaces' tangent planes of the same normal, over the normals of all
/// patches' corners and `random` further ones (m): from below, how far the two bodies are apart in
/// Hausdorff's sense.
inline double surfaceDifference(const StpBv& a, const StpBv& b, int random) {
  double worst = 0;
  const auto compare = [&](const Eigen::Vector3d& n) {
    worst = std::max(worst, std::abs(a.support(n) - b.support(n)));
  };
  for (const StpBv* volume : {&a, &b})
    for (int face = 0; face < volume->faceCount(); ++face)
      for (int vertex : volume->faces()[static_cast<std::size_t>(face)]) compare(volume->corner(face, vertex));
  Random directions(1);
  for (int i = 0; i < random; ++i) compare(directions.direction());
  return worst;
}

/// How many vertices of `a` have none of `b` within `radius` (m).
inline int withoutPartner(const StpBv& a, const StpBv& b, double radius) {
  return static_cast<int>(std::count_if(a.vertices().begin(), a.vertices().end(), [&](const auto& v) {
    return std::none_of(b.vertices().begin(), b.vertices().end(),
                        [&](const auto& w) { return (v - w).norm() <= radius; });
  }));
}

}  // namespace fcl_stpbv::test
