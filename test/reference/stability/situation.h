// A situation in which distance codes break: two bodies, and the poses they are asked at.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/formatted.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::stability {

using detail::formatted;
using test::Cloud;

/// One of the two bodies: what everybody is given, and what is made of it.
struct Body {
  Cloud points;
  StpBvOptions radii;
  std::vector<int>
      facets;  ///< `[n, i0, ..]` repeated, as a mesh comes: only FCL reads it. Empty: the hull's own

  std::shared_ptr<const StpBvGeometry> smooth;  ///< the STP-BV of the points
  std::shared_ptr<const fcl::Convexd> sharp;  ///< what FCL gets: the given facets, or the hull of the STP-BV
  Cloud corners;  ///< the polyhedron's points, for the methods that need no facets
};

struct Placement {
  Eigen::Isometry3d a, b;
};

/// What an answer can be expected to be.
enum class Expected {
  distance,  ///< the signed distance
  refusal,   ///< no distance at all: a pose is not a pose
};

/// A case of the suite. Several placements follow one another like the steps of a motion where `isPath`.
struct Situation {
  std::string group;  ///< row of the table
  std::string name;   ///< unique within the suite; with the seed it says all that made the case
  std::shared_ptr<const Body> a, b;
  std::vector<Placement> placements;
  bool isPath = false;
  Expected expected = Expected::distance;
  Eigen::Vector3d towards{0, 0, 0};  ///< rough direction from a to b in which they are apart; zero: not known
  double slack = 0;                  ///< how far the input itself leaves the distance open (m)
  std::string source;                ///< of a published report: where, and what it says
};

/// Points to be covered with these radii, and the polyhedron.
/// @throws Error where no STP-BV can be built from them.
std::shared_ptr<const Body> makeBody(const Cloud& points, const StpBvOptions& radii = {},
                                     const std::vector<int>& facets = {});

/// A length that says how big the pair is: both bodies and, where they are farther
/// apart than that, their distance (m).
double sizeOf(const Situation& situation, const Placement& at);

/// All situations; `seed` moves whatever is random in them. Those that take more
/// than a second to set up only if `large`.
/// @throws std::runtime_error where the folder with the published cases is missing.
std::vector<Situation> allSituations(std::uint64_t seed, const std::string& hardCases, bool large);

// By kind; each adds to `all`.
void addContacts(std::vector<Situation>& all, std::uint64_t seed);  ///< what is parallel or touches
void addMotions(std::vector<Situation>& all, std::uint64_t seed);   ///< slides and rocks through them
void addDepths(std::vector<Situation>& all, std::uint64_t seed);    ///< containment, coincidence
void addBodies(std::vector<Situation>& all, std::uint64_t seed, bool large);  ///< extreme bodies and radii
void addPoses(std::vector<Situation>& all, std::uint64_t seed);               ///< extreme and broken poses
void addMeshes(std::vector<Situation>& all, std::uint64_t seed);              ///< degenerate facets
void addReports(std::vector<Situation>& all, const std::string& folder);      ///< published ones

}  // namespace fcl_stpbv::stability
