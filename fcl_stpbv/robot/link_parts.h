// Convex parts of a robot's concave links, beside the whole bodies, for the pairs that need them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

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
  /// @throws Error naming the mesh.
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
