// The difference of two volumes that should be equal: of their support functions, over normals of both
// volumes, and of their vertices.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/point_tree.h"

namespace fcl_stpbv {

using namespace detail;

using Eigen::Vector3d;

double surfaceDifference(const StpBv& a, const StpBv& b) {
  double worst = 0;
  const auto compare = [&](const Vector3d& n) {
    worst = std::max(worst, std::abs(a.support(n) - b.support(n)));
  };
  for (const StpBv* volume : {&a, &b})
    for (int face = 0; face < volume->faceCount(); ++face)
      for (const int vertex : volume->faces()[at(face)]) compare(volume->corner(face, vertex));
  constexpr int kMore = 1000;  // directions on a spiral, for bodies with few faces
  constexpr double kGoldenAngle = 2.399963229728653;
  for (int i = 0; i < kMore; ++i) {
    const double z = 1 - (2 * i + 1) / static_cast<double>(kMore), across = std::sqrt(1 - z * z);
    compare(
        Vector3d(across * std::cos(kGoldenAngle * i), across * std::sin(kGoldenAngle * i), z).normalized());
  }
  return worst;
}

int withoutPartner(const StpBv& a, const StpBv& b, double radius) {
  const PointTree tree(b.vertices());
  std::vector<int> near;
  return static_cast<int>(std::count_if(a.vertices().begin(), a.vertices().end(), [&](const Vector3d& v) {
    tree.within(v, radius, &near, 1);
    return near.empty();
  }));
}

}  // namespace fcl_stpbv
