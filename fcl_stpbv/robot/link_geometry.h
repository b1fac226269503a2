// The collision bodies of a robot's links: STP-BVs around meshes, and primitives.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <functional>
#include <limits>
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

/// The default folder of the cache of volumes: $XDG_CACHE_HOME/fcl_stpbv, else ~/.cache/fcl_stpbv; "" if
/// neither is known.
std::string defaultCacheFolder();

/// Options of loadGeometry().
struct GeometryOptions {
  StpBvOptions radii;  ///< r and R for the volumes of every link
  /// Whether to choose r by each body's size, instead of radii.r (docs/choosing_r_and_R.md).
  bool fitSmallRadius = false;
  bool fitBigRadius = false;  ///< whether to choose R by each body's size, instead of radii.R
  /// If set, adviseRadii() chooses both radii of each mesh for this task; this overrides the members above. A
  /// warning counts the bodies that cannot keep both budgets. Primitives keep the radii above.
  std::optional<RadiiTask> advice;
  /// Radii of single links, by name; they override all of the above.
  std::map<std::string, StpBvOptions> links;
  /// Limit on a volume's over-cover over the hull of its mesh (m); 0 for no limit. With a limit, a volume
  /// gets few vertices (reduce()) and a larger r that covers the others. Before that, R is doubled until the
  /// volume with all vertices keeps the limit. The limit must be above r.
  double overCoverBudget = 0;
  /// The same limit for single links, by name.
  std::map<std::string, double> budgets;
  /// Whether the meshes of all links stay convex polyhedra, without STP-BVs. That is enough if the other body
  /// of each pair is an STP-BV.
  bool flat = false;
  std::set<std::string> flatLinks;  ///< links whose meshes stay convex polyhedra
  /// Whether to use the visual shapes instead of the collision shapes.
  bool visual = false;
  std::vector<std::string> packagePath;            ///< folders to search first for package:// names
  std::string cacheFolder = defaultCacheFolder();  ///< "" for no cache
  /// Number of threads that build; the result does not depend on it.
  int threads = 1;
  /// Called before each shape with its index, the number of all shapes and a text; by one thread at a time.
  std::function<void(std::size_t, std::size_t, const std::string&)> progress;
};

/// One shape of one link.
struct Body {
  int link = -1;  ///< index into RobotModel::links
  /// The link's name, with #2, #3 ... for its second, third ... shape, and :1, :2 ... for the parts of a
  /// shape.
  std::string name;
  /// Pose in the link's frame; its rotation is exact up to rounding.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::shared_ptr<fcl::CollisionGeometryd> geometry;  ///< the geometry that queries use
  /// The radii from the options, or fitted; for a flat primitive those that its cover would get.
  StpBvOptions radii;
  StpBv::Ptr volume;                  ///< null for a flat primitive and for a flat mesh
  std::optional<RadiiAdvice> advice;  ///< set if GeometryOptions::advice was used
  /// The volume of all points of the mesh, if `volume` is a reduced one, or if its R is so small that corners
  /// of the hull lie inside it; else null.
  std::shared_ptr<const StpBvGeometry> full;
  std::shared_ptr<fcl::CollisionGeometryd> primitive;  ///< the primitive under its smooth cover, else null
  std::string file;                                    ///< "" for a primitive
  /// Identifies the file's content and scale in caches; "" for a primitive.
  std::string meshKey;
  Eigen::Vector3d scale{1, 1, 1};   ///< of the mesh
  Eigen::Vector3d centre{0, 0, 0};  ///< centre of a bounding sphere, in the link's frame (m)
  /// Radius of that sphere (m). Infinite if it is not known: then no pair is left out as far away.
  double radius = std::numeric_limits<double>::infinity();
  OverCover cover{0, 0};  ///< over-cover of the volume over the mesh's hull or the primitive (m)
  int partOf = -1;        ///< for a convex part (LinkParts): index of its whole body; -1 for a whole body
  /// For a whole body: number of its convex parts, which replace it in pairs of `byParts`.
  int parts = 0;
  double excess = 0;      ///< for a part: upper bound on the excess of its hull over the mesh as a solid (m)
  double openExcess = 0;  ///< the same over the mesh's triangles alone (m)
  /// For a part: number of pieces of the mesh that are not closed, so that no part covers their inside.
  int openPieces = 0;
  std::vector<Eigen::Vector3d> hull;  ///< for a part: the corners of its hull, in the body's frame (m)
  /// Upper bound on the distance of any point of the body's surface from its mesh's triangles or its
  /// primitive (m). measureExcess() sets it; NaN before.
  double volumeExcess = std::numeric_limits<double>::quiet_NaN();

  /// Whether `volume` was reduced: it has fewer vertices, and a larger r instead.
  bool isReduced() const { return full && volume->radii().r > full->volume().radii().r; }
};

/// Two links, or a link and an obstacle.
struct LinkPair {
  int link1;              ///< index into RobotModel::links
  int link2;              ///< index of a link, or of an obstacle
  bool obstacle = false;  ///< whether `link2` is an obstacle
};
/// Ordering of pairs. Two links are the same pair in either order.
bool operator<(const LinkPair& a, const LinkPair& b);

/// The bodies of all links.
struct RobotGeometry {
  std::vector<Body> bodies;           ///< in the order of the links
  std::vector<std::string> warnings;  ///< whole sentences for the user
  int fromCache = 0;                  ///< number of volumes that came from the cache
  /// Pairs that use the convex parts of their bodies, not the whole bodies.
  std::set<LinkPair> byParts;
  std::set<int> incomplete;  ///< links of which a shape is missing, because it could not be read

  /// Whether this body is used in a pair: `inParts` states whether the pair is in `byParts`.
  bool counts(int body, bool inParts) const;
  /// Bodies of a link: first index and one past the last.
  std::pair<int, int> of(int link) const;
};

/// Reads the meshes and builds the volumes. Primitives are kept; coverPrimitives() (checked_pairs.h) can
/// replace them. A link without collision shapes has no body. If the whole robot has no collision shapes, its
/// visual shapes are used, with a warning.
/// @throws Error listing everything that is wrong. Each entry names the URDF, the link, the file and what
/// would work. Faults that do not need a volume are reported before any volume is built.
RobotGeometry loadGeometry(const RobotModel& robot, const GeometryOptions& options = {});

/// Sets Body::volumeExcess of all bodies. Call it last, after coverPrimitives() and after links were split
/// into parts, but before obstacles and constraints are made of them. It reads the meshes of whole bodies
/// again, which takes about a tenth of a second for each.
/// @throws Error naming the mesh, also if its file has changed since.
void measureExcess(RobotGeometry& geometry, int threads = 1);

/// A robot's bodies and their convex parts. Each mesh is read at most once, and split at most once for each
/// number of parts, even if several threads use it. The results are stored in the cache for the next run.
class LinkParts {
 public:
  /// `whole` must not have parts yet. `cacheFolder`: see GeometryOptions::cacheFolder; "" for no cache.
  explicit LinkParts(std::shared_ptr<const RobotGeometry> whole,
                     const std::string& cacheFolder = defaultCacheFolder());
  /// Moves the contents of another object, which may only be destroyed or assigned to afterwards.
  LinkParts(LinkParts&&) noexcept;
  /// The same.
  LinkParts& operator=(LinkParts&&) noexcept;
  ~LinkParts();

  /// The parts of one whole body, split into at most `most` parts. They have the radii of the body, or are
  /// flat if it is flat; `partOf` is `body`. A convex mesh, or `most` = 1, gives a single part, the mesh's
  /// hull. A primitive, or points without triangles, gives none.
  /// @throws Error naming the mesh, and for a body that does not exist.
  const std::vector<Body>& of(int body, int most);

  /// Computes in advance, on several threads, the parts that geometry(most, ...) needs. `progress`: see
  /// GeometryOptions.
  void prepare(const std::map<int, int>& most, int threads,
               const std::function<void(std::size_t, std::size_t, const std::string&)>& progress = nullptr);

  /// The whole bodies and, for each link in `most`, its parts (at most that many). `byParts` becomes
  /// RobotGeometry::byParts.
  RobotGeometry geometry(const std::map<int, int>& most, const std::set<LinkPair>& byParts);

  /// The whole bodies, as given to the constructor.
  const RobotGeometry& whole() const { return *whole_; }

 private:
  class Store;
  std::shared_ptr<const RobotGeometry> whole_;
  std::unique_ptr<Store> store_;
};

}  // namespace fcl_stpbv
