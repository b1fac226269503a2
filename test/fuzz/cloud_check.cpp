// Checks a cloud:
// 1. The cloud is built, measured and verified.
// 2. Normals are drawn: random ones, those of planes through three points, and normals next to these.
// 3. Along each, checkBallHull() checks the core's surface point, and the points' height checks the
// over-cover.
#include "test/fuzz/cloud_check.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/ball_hull_check.h"

namespace fcl_stpbv::fuzz {

using detail::formatted;
using Eigen::Vector3d;

namespace {

// Random normals, normals of planes through three points, and normals next to these.
std::vector<Vector3d> normalsFor(const test::Cloud& points, test::Random& random) {
  std::vector<Vector3d> normals;
  const auto pick = [&] {
    return points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))];
  };
  for (int k = 0; k < 6; ++k) {
    normals.push_back(random.direction());
    const Vector3d a = pick(), n = (pick() - a).cross(pick() - a);
    if (!(n.norm() > 0)) continue;
    normals.push_back(n.normalized());
    normals.push_back(
        (n.normalized() + std::pow(10.0, random.uniform(-12, -1)) * random.direction()).normalized());
  }
  return normals;
}

}  // namespace

std::string complaintAbout(const CloudCase& c, test::Random& random) {
  StpBv::Ptr volume;
  OverCover over{};
  try {
    volume = StpBv::build(c.points, c.radii);
    over = overCover(*volume, c.points);
  } catch (const Error& e) {
    return std::string("refused: ") + e.what();
  }
  const Verification found = verify(*volume, c.points, c.radii.r);
  if (!found.ok) return "verify: " + found.message;

  // Points closer than the rounding of their coordinates count as one. On a joined face, heights of up to 32
  // roundings remain. Where faces are joined, claimed points are off by 1e-12 of the radius along the
  // surface. A unit normal has a rounding error, which rho multiplies.
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  double largest = 0;
  for (const Vector3d& p : c.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double size = volume->enclosingRadius(), rho = c.radii.R - c.radii.r;
  const double allowed = 64 * kEpsilon * (largest + size) + 1e-12 * size + 8 * kEpsilon * rho;
  for (const Vector3d& n : normalsFor(c.points, random)) {
    const Vector3d x = volume->surfacePoint(n) - c.radii.r * n;
    const test::BallHullClaim claim = test::checkBallHull(c.points, rho, n, x);
    if (!(claim.outside <= allowed)) return formatted("a point is %.3g m outside the core", claim.outside);
    if (!(claim.beyond <= allowed)) return formatted("the core is %.3g m too large", claim.beyond);
    double hull = -std::numeric_limits<double>::infinity();
    for (const Vector3d& p : c.points) hull = std::max(hull, n.dot(p - x));
    if (!(c.radii.r - hull <= over.max + allowed))
      return formatted("the over-cover is %.3g m too small", c.radii.r - hull - over.max);
  }
  if (!(over.mean >= c.radii.r - allowed && over.mean <= over.max + allowed))
    return formatted("the mean over-cover is %.3g m", over.mean);
  return {};
}

}  // namespace fcl_stpbv::fuzz
