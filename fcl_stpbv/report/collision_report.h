// The contents of a collision report (urdf_collision_report), independent of the output format.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/report/mesh_fit.h"
#include "fcl_stpbv/report/published_polyhedra.h"
#include "fcl_stpbv/report/robot_files.h"
#include "fcl_stpbv/report/trajectory.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/neutral_posture.h"
#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::report {

struct ReportRequest {
  RobotFiles files;
  std::string pose;        ///< a state's name or a JSON file; "" for each pair's closest configuration
  std::string trajectory;  ///< way points along which pairs are followed (trajectory_file.h); "" for none
  std::string neutral;     ///< like `pose`; "" for all joints at zero or at the limit nearest to it
  std::string polyhedra;   ///< folder of published polyhedra; "" for none
  bool partsAuto = false;  ///< split concave links, for those pairs that collide only by their hulls
  bool partsForAllPairs = false;  ///< use these parts for all pairs of such links, too
  int partsAll = 1;               ///< split all links into at most this many parts, for all pairs
  bool mayCheckNothing = false;   ///< no error if no pair is left to check
  PairListOptions search;
};

/// One pair of links, or a link and an obstacle, in the requested posture or in its closest configuration.
struct PairReport {
  LinkPair links;
  std::string link1, link2;  ///< names of the links; link2 may be the name of an obstacle
  /// Reason that the search gives; "sometimes" if only `configuration` shows a collision within the limits.
  std::string reason;
  std::string srdfReason;  ///< reason that the SRDF gives, "" if it gives none
  bool checked = true;  ///< false if the SRDF leaves the pair of links out, or, without an SRDF, the search
  DistanceAnswer answer;
  /// The distance is not above the requested margin.
  bool colliding = false;
  /// The closest bodies; numbers of obstacles follow those of the robot's bodies.
  int body1 = -1, body2 = -1;
  std::map<std::string, double> gradient;
  double overCover1 = 0, overCover2 = 0;  ///< excess of each surface over its hull along the normal (m)
  double hullDistance = 0;  ///< distance of the two hulls or primitives (m), NaN if they overlap
  /// Lipschitz constant of the normal: its largest change per metre of relative translation, for bodies in
  /// contact or apart: 1/(r1 + r2) (1/m). Infinite if neither body has an r (docs/theory.md, 6).
  double lipschitz = std::numeric_limits<double>::infinity();
  /// Distance of the meshes or primitives themselves (m); 0 if they meet. NaN if it was not measured, because
  /// the distance of the volumes is larger than their excess over the hulls.
  double meshDistance = std::numeric_limits<double>::quiet_NaN();
  /// Upper bound on `meshDistance`, measured or not: the distance of the volumes plus the excess of each over
  /// its mesh (m). NaN if the volumes meet.
  double meshDistanceMost = std::numeric_limits<double>::quiet_NaN();
  /// Cause of the collision: "meshes meet", "hull only" or "margin only" (pair_cause.h). For a pair that
  /// contradicts the SRDF, the cause in the configuration `closest`. "" if there is neither.
  std::string cause;
  double minDistance = 0;  ///< least distance that was found, by the search or in `configuration` (m)
  double probabilityBound = 1;
  double security = 0, influence = 0;
  Eigen::VectorXd configuration;  ///< configuration of `answer`
  double time =
      std::numeric_limits<double>::quiet_NaN();  ///< time of `configuration` on the trajectory, else NaN
  Eigen::VectorXd closest;                       ///< configuration in which minDistance was found

  /// Proven farther apart than the margin all along the trajectory.
  bool freeAlong = false;
  /// Has the trajectory's first contact, or the first place where nothing is decided.
  bool stopsTrajectory = false;
  bool contradictsSrdf = false;  ///< the SRDF leaves the pair out as never or adjacent, but it collides
};

/// The cost of convex parts: rows and time of a controller that keeps all checked pairs of bodies apart.
struct RowCost {
  int rows = 0;
  int live = 0;          ///< number of rows that are not constant
  double usPerTick = 0;  ///< time of the rows with their Jacobian, in small steps (us)
};

constexpr double kHandOver = 0.1;  ///< m; below this distance convex parts take over from whole bodies

struct CollisionReport {
  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const RobotGeometry> geometry;
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const Srdf> srdf;  ///< null if there is none
  std::vector<Obstacle> obstacles;
  std::vector<std::string> meshFiles;  ///< mesh files that were read
  std::vector<std::string> warnings;
  std::vector<MeshFit> fits;         ///< one for each body
  std::vector<std::string> skipped;  ///< wrong shapes that were left out; nothing was checked against them
  std::vector<PolyhedronReport> polyhedra;  ///< one for each body; empty if none were requested
  /// Checked pairs first. Among them, the pair that stops the trajectory is first; the others are sorted by
  /// distance.
  std::vector<PairReport> pairs;
  bool pairsOfBodies = false;   ///< pairs name bodies instead of links
  std::vector<PairEntry> list;  ///< result of the search, with the reasons of `pairs`
  detail::NeutralPosture neutral;
  /// "" if each pair is in its own closest configuration.
  std::string pose;
  /// Its pairs of bodies are those of `trajectoryPairs`.
  std::optional<TrajectoryReport> trajectory;
  /// The links of each pair, or link and obstacle. Their names may not tell pairs apart: an obstacle may have
  /// the name of a link.
  std::vector<LinkPair> trajectoryPairs;
  double margin = 0;  ///< a distance not above it is a collision (m)
  int checked = 0, colliding = 0;
  /// Number of checked pairs in collision for each cause.
  std::map<std::string, int> causes;
  /// Least distance of the checked pairs (m).
  double minDistance = 0;
  /// Time of one and of all checked pairs with their Jacobian, in small steps.
  double nsPerPair = 0, usPerTick = 0;
  /// The costs with whole bodies, with parts, and with parts and a hand-over at kHandOver; 0 without parts.
  RowCost wholeCost, partsCost, handOverCost;

  /// Whether the pair uses the convex parts of its links.
  bool isByParts(const PairReport& pair) const { return geometry->byParts.count(pair.links) > 0; }
  /// Names of the two links, or of link and obstacle.
  std::pair<std::string, std::string> namesOf(const LinkPair& pair) const {
    const auto second = static_cast<std::size_t>(pair.link2);
    return {robot->links[static_cast<std::size_t>(pair.link1)].name,
            pair.obstacle ? obstacles[second].name : robot->links[second].name};
  }
  /// "link1 - link2" for one of `trajectoryPairs`.
  std::string trajectoryPair(int pair) const {
    const auto [first, second] = namesOf(trajectoryPairs[static_cast<std::size_t>(pair)]);
    return first + " - " + second;
  }
};

/// @throws Error naming the file or the argument.
CollisionReport makeReport(const ReportRequest& request);

}  // namespace fcl_stpbv::report
