// Splits the meshes of single links (parts/convex_parts.h) and builds a volume for each part, with the radii
// of the whole body.
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/link_volume.h"
#include "fcl_stpbv/robot/volume_cache.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

Body partOf(const Body& whole, int index, int number, const ConvexPart& part, int openPieces) {
  Body body;
  body.link = whole.link;
  body.name = whole.name + ":" + std::to_string(number);
  body.pose = whole.pose;
  body.file = whole.file;
  body.meshKey = whole.meshKey;
  body.scale = whole.scale;
  body.radii = whole.radii;
  body.partOf = index;
  body.excess = part.excess.upper;
  body.openExcess = part.openExcess.upper;
  body.openPieces = openPieces;
  body.hull = part.points;
  if (whole.volume) {
    body.volume = StpBv::build(part.points, whole.radii);  // not those of a volume with fewer vertices
    body.cover = overCover(*body.volume, part.points);
    body.geometry = std::make_shared<StpBvGeometry>(body.volume);
    body.centre = body.volume->centre();
    body.radius = body.volume->enclosingRadius();
  } else {
    makeHull(part.points, body);
  }
  body.centre = body.pose * body.centre;
  return body;
}

}  // namespace

// Map entries do not move. Each is made by the first thread that needs it, and other threads wait.
class LinkParts::Store {
 public:
  Store(const RobotGeometry& whole, const std::string& cacheFolder) : whole_(whole), cache_(cacheFolder) {}

  const std::vector<Body>& of(int index, int most) {
    Split& split = entry(splits_, std::pair(index, most));
    std::call_once(split.made, [&] { split.bodies = made(index, most); });
    return split.bodies;
  }

 private:
  struct Split {
    std::once_flag made;
    std::vector<Body> bodies;
  };
  struct Mesh {
    std::once_flag read;
    TriangleMesh mesh;
  };
  struct MeshParts {
    std::once_flag found;
    ConvexParts parts;
  };

  template <class Map>
  typename Map::mapped_type& entry(Map& map, const typename Map::key_type& key) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return map[key];
  }

  std::vector<Body> made(int index, int most) {
    const Body& whole = whole_.bodies[at(index)];
    std::vector<Body> bodies;
    if (whole.file.empty() || most < 1) return bodies;
    namingFile(whole.file, [&] {
      const ConvexParts& parts = partsOf(whole, most);
      int number = 0;
      for (const ConvexPart& part : parts.parts)
        bodies.push_back(partOf(whole, index, ++number, part, parts.pieces - parts.closedPieces));
    });
    return bodies;
  }

  // The legs of a robot are often made of one mesh.
  const ConvexParts& partsOf(const Body& whole, int most) {
    const std::string key = meshKey(whole);
    MeshParts& known = entry(parts_, std::pair(key, most));
    std::call_once(known.found, [&] {
      PartsOptions options;
      options.most = most;
      known.parts = cache_.parts(key, options, [&] {
        Mesh& file = entry(meshes_, key);
        std::call_once(file.read, [&] { file.mesh = KeyedMesh(whole.file, whole.scale, key).mesh(); });
        return file.mesh.triangles.empty() ? ConvexParts() : convexParts(file.mesh, options);
      });
    });
    return known.parts;
  }

  const RobotGeometry& whole_;
  VolumeCache cache_;
  std::mutex mutex_;
  std::map<std::pair<int, int>, Split> splits_;             // by body and most
  std::map<std::pair<std::string, int>, MeshParts> parts_;  // by mesh and most
  std::map<std::string, Mesh> meshes_;
};

LinkParts::LinkParts(std::shared_ptr<const RobotGeometry> whole, const std::string& cacheFolder)
    : whole_(std::move(whole)), store_(std::make_unique<Store>(*whole_, cacheFolder)) {}

LinkParts::LinkParts(LinkParts&&) noexcept = default;
LinkParts& LinkParts::operator=(LinkParts&&) noexcept = default;
LinkParts::~LinkParts() = default;

const std::vector<Body>& LinkParts::of(int body, int most) {
  if (body < 0 || at(body) >= whole_->bodies.size())
    throw Error("LinkParts: there is no body " + std::to_string(body));
  return store_->of(body, most);
}

void LinkParts::prepare(const std::map<int, int>& most, int threads,
                        const std::function<void(std::size_t, std::size_t, const std::string&)>& progress) {
  std::vector<std::pair<int, int>> wanted;  // body and largest number of parts
  for (std::size_t i = 0; i < whole_->bodies.size(); ++i) {
    const Body& body = whole_->bodies[i];
    const auto found = most.find(body.link);
    if (found != most.end() && !body.file.empty()) wanted.emplace_back(static_cast<int>(i), found->second);
  }
  shareOut(
      wanted.size(), threads, [&](std::size_t i) { of(wanted[i].first, wanted[i].second); },
      [&](std::size_t i) {
        if (progress) progress(i, wanted.size(), "parts of " + whole_->bodies[at(wanted[i].first)].name);
      });
}

RobotGeometry LinkParts::geometry(const std::map<int, int>& most, const std::set<LinkPair>& byParts) {
  RobotGeometry all;
  all.warnings = whole_->warnings;
  all.fromCache = whole_->fromCache;
  all.byParts = byParts;
  all.incomplete = whole_->incomplete;
  const std::vector<Body>& bodies = whole_->bodies;
  for (std::size_t first = 0; first < bodies.size();) {
    std::size_t last = first;
    while (last < bodies.size() && bodies[last].link == bodies[first].link) ++last;
    const std::size_t start = all.bodies.size();
    all.bodies.insert(all.bodies.end(), bodies.begin() + static_cast<std::ptrdiff_t>(first),
                      bodies.begin() + static_cast<std::ptrdiff_t>(last));
    const auto wanted = most.find(bodies[first].link);
    for (std::size_t i = first; i < last && wanted != most.end(); ++i) {
      const std::vector<Body>& parts = of(static_cast<int>(i), wanted->second);
      if (parts.size() < 2) continue;
      const std::size_t own = start + i - first;
      all.bodies[own].parts = static_cast<int>(parts.size());
      for (Body part : parts) {
        part.partOf = static_cast<int>(own);
        all.bodies.push_back(std::move(part));
      }
    }
    first = last;
  }
  return all;
}

}  // namespace fcl_stpbv
