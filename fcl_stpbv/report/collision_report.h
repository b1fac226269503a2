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
  std::string pose;        ///< a state's name or a JSON file, "" for each pair's closest configuration
  std::string trajectory;  ///< way points that pairs are followed along (trajectory_file.h), "" for none
  std::string neutral;     ///< as pose, "" for all joints at zero or at the limit nearest to it
  std::string polyhedra;   ///< folder of published ones, "" for none
  bool partsAuto = false;  ///< concave links are split for the pairs that collide by their hulls alone
  bool partsForAllPairs = false;  ///< and then for all the pairs of these links
  int partsAll = 1;               ///< or all of them into so many at most, for all pairs
  bool mayCheckNothing = false;   ///< no error where no pair is left to check
  PairListOptions search;
};

/// One pair of links, or a link and an obstacle, in the posture asked for or in its closest configuration.
struct PairReport {
  LinkPair links;
  std::string link1, link2;  ///< their names, or link2 an obstacle's
  std::string reason;        ///< what the search says
  std::string srdfReason;    ///< what the SRDF says, "" where it says nothing
  bool checked = true;  ///< false where the SRDF or, without one, the search leaves the pair of links out
  DistanceAnswer answer;
  bool colliding = false;      ///< the distance is not above the margin asked for
  int body1 = -1, body2 = -1;  ///< the closest bodies; body2 of an obstacle counts on from the robot's
  std::map<std::string, double> gradient;
  double overCover1 = 0, overCover2 = 0;  ///< of the two surfaces over their hulls along the normal (m)
  double hullDistance = 0;                ///< of the two hulls or primitives, NaN where they overlap (m)
  /// Lipschitz constant of the normal: its largest change per metre of relative translation, for bodies in
  /// contact or apart: 1/(r1 + r2) (1/m). Infinite if neither body has an r (docs/theory.md, 6).
  double lipschitz = std::numeric_limits<double>::infinity();
  /// Distance of the meshes or primitives themselves (m); 0 if they meet. NaN if it was not measured, because
  /// the volumes are farther apart than they exceed the hulls.
  double meshDistance = std::numeric_limits<double>::quiet_NaN();
  /// Upper bound on `meshDistance`, measured or not: the distance of the volumes plus the excess of each over
  /// its mesh (m). NaN if the volumes meet.
  double meshDistanceMost = std::numeric_limits<double>::quiet_NaN();
  /// "meshes meet", "hull only" or "margin only" (pair_cause.h): what the collision comes from, or the one
  /// that contradicts the SRDF, in `closest`; "" without one.
  std::string cause;
  double minDistance = 0;  ///< least found by the search (m)
  double probabilityBound = 1;
  double security = 0, influence = 0;
  Eigen::VectorXd configuration;  ///< of `answer`
  double time =
      std::numeric_limits<double>::quiet_NaN();  ///< of `configuration` on the trajectory, NaN without one
  Eigen::VectorXd closest;                       ///< where minDistance was found

  bool freeAlong = false;        ///< proven free all along the trajectory
  bool stopsTrajectory = false;  ///< has its first contact, or the first place where nothing is decided
  bool contradictsSrdf = false;  ///< which leaves the pair out as never or adjacent, and it collides
};

/// The cost of convex parts: rows and time of a controller that keeps all checked pairs of bodies apart.
struct RowCost {
  int rows = 0;
  int live = 0;          ///< of these, how many are not constant
  double usPerTick = 0;  ///< with their Jacobian, in small steps
};

constexpr double kHandOver = 0.1;  ///< m

struct CollisionReport {
  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const RobotGeometry> geometry;
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const Srdf> srdf;  ///< null without one
  std::vector<Obstacle> obstacles;
  std::vector<std::string> meshFiles;  ///< that were read
  std::vector<std::string> warnings;
  std::vector<MeshFit> fits;                ///< one a body
  std::vector<std::string> skipped;         ///< shapes left out as wrong, which nothing was checked against
  std::vector<PolyhedronReport> polyhedra;  ///< one a body, or none where none were asked for
  /// Checked ones first: that which stops the trajectory, then the closest first.
  std::vector<PairReport> pairs;
  bool pairsOfBodies = false;   ///< pairs name bodies, not links
  std::vector<PairEntry> list;  ///< what the search found
  detail::NeutralPosture neutral;
  std::string pose;                            ///< "" where each pair is in its own closest configuration
  std::optional<TrajectoryReport> trajectory;  ///< its pairs of bodies are `trajectoryPairs`
  std::vector<std::pair<std::string, std::string>> trajectoryPairs;  ///< their links, or link and obstacle
  double margin = 0;  ///< a distance not above it is a collision (m)
  int checked = 0, colliding = 0;
  std::map<std::string, int> causes;    ///< of the checked pairs in collision, how many of each
  double minDistance = 0;               ///< of the checked pairs (m)
  double nsPerPair = 0, usPerTick = 0;  ///< of all checked pairs with their Jacobian, in small steps
  /// The costs with whole bodies, with parts, and with parts and a hand-over at kHandOver; 0 without parts.
  RowCost wholeCost, partsCost, handOverCost;

  /// Whether the pair uses the convex parts of its links.
  bool isByParts(const PairReport& pair) const { return geometry->byParts.count(pair.links) > 0; }
  /// "link1 - link2" of one of `trajectoryPairs`.
  std::string trajectoryPair(int pair) const {
    const auto& [first, second] = trajectoryPairs[static_cast<std::size_t>(pair)];
    return first + " - " + second;
  }
};

/// @throws Error naming the file or the argument.
CollisionReport makeReport(const ReportRequest& request);

}  // namespace fcl_stpbv::report
