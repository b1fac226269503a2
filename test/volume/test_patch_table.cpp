// The boundaries around every patch, compared between the table and the edges themselves.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "fcl_stpbv/volume/query_tables.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

using Vector = Eigen::Matrix<long double, 3, 1>;

// Rounding of four products of unit numbers and their sum.
constexpr double kRounding = 2e-15;

struct ReferenceBoundary {
  Vector normal;
  long double limit;
  int neighbour;
};

/// The boundaries of all patches according to docs/theory.md, 3, in long double from vertices, edges and
/// faces.
std::vector<std::vector<ReferenceBoundary>> referenceBoundaries(const StpBv& volume) {
  std::vector<std::vector<ReferenceBoundary>> boundaries(static_cast<std::size_t>(volume.patchCount()));
  const auto at = [&](int i) -> Vector {
    return volume.vertices()[static_cast<std::size_t>(i)].cast<long double>();
  };
  const auto add = [&](int patch, const Vector& normal, long double limit, int neighbour) {
    boundaries[static_cast<std::size_t>(patch)].push_back({normal, limit, neighbour});
  };
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[static_cast<std::size_t>(e)];
    const Vector along = at(edge.vertex[1]) - at(edge.vertex[0]), u = along.normalized();
    const long double sine = along.norm() / 2 / volume.radii().rho;
    const int patch = volume.edgePatch(e);
    add(edge.vertex[0], u, -sine, patch);
    add(edge.vertex[1], -u, -sine, patch);
    add(patch, u, sine, edge.vertex[1]);
    add(patch, -u, sine, edge.vertex[0]);
    for (const int side : {0, 1}) {
      const int face = edge.face[static_cast<std::size_t>(side)];
      if (face < 0) continue;
      const Vector out = (side == 0 ? 1 : -1) *
                         along.cross(volume.corner(face, edge.vertex[0]).cast<long double>()).normalized();
      add(volume.facePatch(face), out, 0, patch);
      add(patch, -out, 0, volume.facePatch(face));
    }
  }
  return boundaries;
}

/// The boundary with the largest measure, and whether the next one is clearly smaller.
template <typename Measure>
std::pair<Crossing, bool> most(const std::vector<ReferenceBoundary>& boundaries, const Measure& measure) {
  Crossing first{-std::numeric_limits<double>::infinity(), -1};
  double second = first.past;
  for (const ReferenceBoundary& s : boundaries) {
    const auto value = static_cast<double>(measure(s));
    if (value > first.past) {
      second = first.past;
      first = {value, s.neighbour};
    } else {
      second = std::max(second, value);
    }
  }
  return {first, first.past - second > 1e-9 * std::abs(first.past) + 1e-12};
}

/// A cone with many sides: a vertex and a face with more boundaries than fit into one record.
Cloud cone(int sides) {
  Cloud points{{0, 0, 0.3}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    points.push_back({0.2 * std::cos(angle), 0.2 * std::sin(angle), 0});
  }
  return points;
}

std::vector<StpBv::Ptr> volumes() {
  std::vector<StpBv::Ptr> all;
  for (const Cloud& points :
       {Cloud{{0.1, 0.2, 0.3}}, Cloud{{0, 0, 0}, {0.1, 0.2, 0.3}}, box(0.2, 0.4, 0.3), needle(1.0),
        plate(0.4, 0.3), cone(5), cone(9), cone(40), cylinder(0.1, 0.4, 17), geodesicSphere(0.2, 2),
        randomHull(100, {0.1, 0.2, 0.3}, 3)})
    for (const double R : {10.0, 1e4}) all.push_back(StpBv::build(points, {0.01, R}));
  return all;
}

}  // namespace

TEST_CASE("A patch's region boundaries are those of the edges around it") {
  for (const StpBv::Ptr& volume : volumes()) {
    const auto reference = referenceBoundaries(*volume);
    for (int p = 0; p < volume->patchCount(); ++p) {
      const auto& expected = reference[static_cast<std::size_t>(p)];
      std::size_t count = 0;
      for (const RegionBoundary s : volume->tables().patches.boundaries(p)) {
        ++count;
        const bool found = std::any_of(expected.begin(), expected.end(), [&](const ReferenceBoundary& r) {
          return r.neighbour == s.neighbour && (r.normal.cast<double>() - s.normal).norm() <= kRounding &&
                 std::abs(static_cast<double>(r.limit) - s.limit) <= kRounding;
        });
        REQUIRE(found);
      }
      REQUIRE(count == expected.size());
    }
  }
}

TEST_CASE("The region boundary passed furthest and the first one ahead, four at a time and one by one") {
  Random random(11);
  int decided = 0;
  for (const StpBv::Ptr& volume : volumes()) {
    if (volume->edgeCount() == 0) {
      CHECK(volume->outside(0, random.direction()) < 0);
      continue;
    }
    const auto reference = referenceBoundaries(*volume);
    for (int p = 0; p < volume->patchCount(); ++p)
      for (int k = 0; k < 20; ++k) {
        const auto& boundaries = reference[static_cast<std::size_t>(p)];
        const Vector3d n = random.direction(), h = random.direction().cross(n).normalized();
        const Vector nL = n.cast<long double>(), hL = h.cast<long double>();
        const double length = std::pow(10.0, random.uniform(-3, 3));
        const Crossing over = volume->tables().patches.crossing(p, pack(length * n), length);
        const auto [furthest, clear] =
            most(boundaries, [&](const ReferenceBoundary& s) { return nL.dot(s.normal) - s.limit; });
        REQUIRE(std::abs(over.past - length * furthest.past) <= kRounding * length);
        if (clear) REQUIRE(over.neighbour == furthest.neighbour);

        if (!(furthest.past < -1e-3)) continue;  // only from inside
        ++decided;
        const Crossing ahead = volume->tables().patches.ahead(p, pack(n), pack(h));
        const auto [first, alone] = most(boundaries, [&](const ReferenceBoundary& s) {
          return hL.dot(s.normal) / (s.limit - nL.dot(s.normal));
        });
        REQUIRE(std::abs(ahead.past - first.past) <=
                1e-11 * (1 + std::abs(first.past)));  // rounding divided by 1e-3
        if (alone) REQUIRE(ahead.neighbour == first.neighbour);
      }
  }
  CHECK(decided > 100);
}

TEST_CASE("A face's sides begin at its vertices in the order of its ring") {
  for (const StpBv::Ptr& volume : volumes())
    for (int f = 0; f < volume->faceCount(); ++f) {
      const StpBv::Ring& ring = volume->faces()[static_cast<std::size_t>(f)];
      const auto& side = volume->tables().patches.face(volume->facePatch(f)).side;
      for (std::size_t i = 0; i < std::min<std::size_t>(ring.size(), 3); ++i)
        REQUIRE(volume->tables().patches.startOf(side[i]) == ring[i]);
    }
}
