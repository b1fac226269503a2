// The collision bodies of a robot's links: STP-BVs of meshes, and primitives as they are.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/radii_advice.h"

namespace fcl_stpbv {

/// The usual place of built volumes: $XDG_CACHE_HOME/fcl_stpbv, else
/// ~/.cache/fcl_stpbv; "" where neither is known.
std::string defaultCacheFolder();

/// What volumes a robot's links get.
struct GeometryOptions {
  StpBvOptions radii;  ///< of every link's volumes
  bool fitr = false;   ///< an r that fits each body's size, instead of radii.r (docs/choosing_r_and_R.md)
  bool fitR = false;   ///< an R that fits each body's size, instead of radii.R
  /// Both radii of each mesh by adviseRadii() for this task, before all of the above. A warning counts the
  /// bodies that cannot keep both promises. Primitives have the radii above.
  std::optional<RadiiTask> advice;
  std::map<std::string, StpBvOptions> links;  ///< of single links, by name: these win
  /// Most that a volume may exceed the hull of its mesh by (m), 0 for any. With one a volume gets few
  /// vertices (reduce()) and a larger r to cover the others; R is doubled first until all vertices keep to
  /// the budget. The budget must be above r.
  double overCoverBudget = 0;
  /// The same of single links, by name.
  std::map<std::string, double> budgets;
  /// The meshes of all links stay convex polyhedra, without STP-BVs. Enough where a pair's other body is
  /// smooth.
  bool flat = false;
  std::set<std::string> flatLinks;                 ///< only the meshes of these links stay so
  bool visual = false;                             ///< the visual shapes instead of the collision shapes
  std::vector<std::string> packagePath;            ///< folders for package:// names, before all others
  std::string cacheFolder = defaultCacheFolder();  ///< "" for no cache
  int threads = 1;                                 ///< that share the building; any number gives the same
  /// Called before each shape with its index and the number of all, by one thread at a time.
  std::function<void(std::size_t, std::size_t, const std::string&)> progress;
};

/// One shape of one link.
struct Body {
  int link = -1;                                      ///< index into RobotModel::links
  std::string name;                                   ///< the link's, with #2, #3 ... for its further shapes
  Eigen::Isometry3d pose;                             ///< in the link's frame; a rotation to rounding
  std::shared_ptr<fcl::CollisionGeometryd> geometry;  ///< what queries get
  StpBvOptions radii;  ///< those asked for, or fitted; of a flat primitive those that its cover would have
  StpBv::Ptr volume;   ///< null for a flat primitive and for a flat mesh
  std::optional<RadiiAdvice> advice;  ///< where GeometryOptions::advice asked for it
  /// The volume of all the mesh's points where `volume` is a reduced one, or so round that corners of the
  /// hull lie inside; else null.
  std::shared_ptr<const StpBvGeometry> full;
  std::shared_ptr<fcl::CollisionGeometryd> primitive;  ///< the primitive under its smooth cover, else null
  std::string file;                                    ///< "" for a primitive
  std::string meshKey;                                 ///< of the file and the scale, for caches; else ""
  Eigen::Vector3d scale{1, 1, 1};                      ///< of the mesh
  Eigen::Vector3d centre;  ///< of a sphere that holds the body, in the link's frame
  double radius = 0;       ///< of that sphere (m)
  OverCover cover{0, 0};   ///< what the volume exceeds the mesh's hull or the primitive by (m)
  int partOf = -1;        ///< index of the body that this is a convex part of (LinkParts), -1 for a whole one
  int parts = 0;          ///< of a whole body: how many parts stand for it in pairs taken by parts
  double excess = 0;      ///< of a part: most that its hull exceeds the mesh's solid by (m)
  double openExcess = 0;  ///< the same over the mesh's triangles alone (m)
  int openPieces = 0;     ///< of a part: pieces of the mesh that are not closed, whose inside no part covers
  std::vector<Eigen::Vector3d> hull;  ///< of a part: the corners of its hull, in the body's frame (m)

  /// Whether `volume` has fewer vertices than its r and R leave, and a larger r instead.
  bool isReduced() const { return full && volume->radii().r > full->volume().radii().r; }
};

/// Two links, or a link and an obstacle.
struct LinkPair {
  int link1;              ///< index into RobotModel::links
  int link2;              ///< link, or index among the obstacles
  bool obstacle = false;  ///< whether `link2` is an obstacle
};
/// Two links are the same pair in either order.
bool operator<(const LinkPair& a, const LinkPair& b);

/// The bodies of all links.
struct RobotGeometry {
  std::vector<Body> bodies;           ///< in the order of the links
  std::vector<std::string> warnings;  ///< whole sentences, to be told to the user
  int fromCache = 0;                  ///< volumes that needed no building
  std::set<LinkPair> byParts;         ///< pairs that are taken by their bodies' parts, not whole
  std::set<int> incomplete;           ///< links that a shape was left out of, as it could not be read

  /// Whether this body stands for its link where the pair is, or is not, taken by parts.
  bool counts(int body, bool inParts) const;
  /// Bodies of a link: first index and one past the last.
  std::pair<int, int> of(int link) const;
};

/// Reads the meshes and builds the volumes; primitives stay as they are until coverPrimitives()
/// (checked_pairs.h). A link without collision shapes has no body; where the whole robot has none, its visual
/// shapes are taken with a warning.
/// @throws Error listing all that is wrong, each naming the URDF, the link, the file and what would work;
/// what can be told before a volume is built is told before.
RobotGeometry loadGeometry(const RobotModel& robot, const GeometryOptions& options = {});

/// A robot's bodies and their convex parts. Each mesh is read at most once, and split once for each number of
/// parts, by any number of threads that ask; what was found is kept in the cache for the next run.
class LinkParts {
 public:
  /// `whole` has no parts yet. `cacheFolder`: as GeometryOptions::cacheFolder, "" for no cache.
  explicit LinkParts(std::shared_ptr<const RobotGeometry> whole,
                     const std::string& cacheFolder = defaultCacheFolder());
  ~LinkParts();

  /// The bodies that stand for one whole body when it is split into `most` parts: with its radii, or flat as
  /// it is; `partOf` is `body`. One alone is the mesh's hull: of a convex mesh, or where `most` is 1. None
  /// for a primitive and for points without triangles.
  /// @throws Error naming the mesh, and for a body that does not exist.
  const std::vector<Body>& of(int body, int most);

  /// Makes by several threads what geometry(most, ...) would have to make; `progress` as GeometryOptions'.
  void prepare(const std::map<int, int>& most, int threads,
               const std::function<void(std::size_t, std::size_t, const std::string&)>& progress = nullptr);

  /// The whole bodies, and beside them the parts of those links that have an
  /// entry in `most`; `byParts` as given.
  RobotGeometry geometry(const std::map<int, int>& most, const std::set<LinkPair>& byParts);

  /// The bodies as they were given.
  const RobotGeometry& whole() const { return *whole_; }

 private:
  class Store;
  std::shared_ptr<const RobotGeometry> whole_;
  std::unique_ptr<Store> store_;
};

}  // namespace fcl_stpbv
