// A situation in which distance codes fail: two bodies, and the poses at which they are queried.
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

/// One of the two bodies: the input of all methods, and what is made from it.
struct Body {
  Cloud points;
  StpBvOptions radii;
  std::vector<int>
      facets;  ///< `[n, i0, ..]` repeated, as a mesh comes: only FCL reads it. Empty: the hull's own

  std::shared_ptr<const StpBvGeometry> smooth;  ///< the STP-BV of the points
  /// FCL's polyhedron: the given facets, or the hull of the STP-BV.
  std::shared_ptr<const fcl::Convexd> sharp;
  Cloud corners;  ///< the polyhedron's points, for the methods that need no facets
};

struct Placement {
  Eigen::Isometry3d a, b;
};

/// The expected kind of answer.
enum class Expected {
  distance,  ///< the signed distance
  refusal,   ///< no distance, because a pose is invalid
};

/// A case of the suite. With `isPath`, several placements follow one another like the steps of a motion.
struct Situation {
  std::string group;  ///< row of the table
  std::string name;   ///< unique within the suite; with the seed it determines the case
  std::shared_ptr<const Body> a, b;
  std::vector<Placement> placements;
  bool isPath = false;
  Expected expected = Expected::distance;
  /// Rough direction from a to b in which they are apart; zero if it is not known.
  Eigen::Vector3d towards{0, 0, 0};
  double slack = 0;    ///< uncertainty of the distance because of the input (m)
  std::string source;  ///< for a published report: where it is, and what it says
};

/// Makes a body from points, the radii of its volume, and the polyhedron's facets.
/// @throws Error if no STP-BV can be built from the points.
std::shared_ptr<const Body> makeBody(const Cloud& points, const StpBvOptions& radii = {},
                                     const std::vector<int>& facets = {});

/// A length that describes the size of the pair: that of both bodies or, if they are farther apart, their
/// distance (m).
double sizeOf(const Situation& situation, const Placement& at);

/// All situations. `seed` changes their random parts. Situations that take more than a second to set up are
/// included only with `large`.
/// @throws std::runtime_error if the folder with the published cases is missing.
std::vector<Situation> allSituations(std::uint64_t seed, const std::string& hardCases, bool large);

// By kind. Each function adds to `all`.
void addContacts(std::vector<Situation>& all, std::uint64_t seed);  ///< what is parallel or touches
void addMotions(std::vector<Situation>& all, std::uint64_t seed);   ///< slides and rocks through them
void addDepths(std::vector<Situation>& all, std::uint64_t seed);    ///< containment, coincidence
void addBodies(std::vector<Situation>& all, std::uint64_t seed, bool large);  ///< extreme bodies and radii
void addPoses(std::vector<Situation>& all, std::uint64_t seed);               ///< extreme and broken poses
void addMeshes(std::vector<Situation>& all, std::uint64_t seed);              ///< degenerate facets
void addReports(std::vector<Situation>& all, const std::string& folder);      ///< published ones

}  // namespace fcl_stpbv::stability
