// Splits the meshes of single links (parts/convex_parts.h) and builds a volume for each part, with the radii
// of the whole body.
#include "fcl_stpbv/robot/link_parts.h"

#include "fcl_stpbv/adapter/hull_geometry.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/mesh_file.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Body partOf(const Body& whole, int index, int number, const ConvexPart& part) {
  Body body;
  body.link = whole.link;
  body.name = whole.name + ":" + std::to_string(number);
  body.pose = whole.pose;
  body.file = whole.file;
  body.scale = whole.scale;
  body.radii = whole.radii;
  body.partOf = index;
  body.excess = part.excess.upper;
  body.hull = part.points;
  if (whole.volume) {
    body.volume = StpBv::build(part.points, {whole.volume->radii().r, whole.volume->radii().R});
    body.cover = overCover(*body.volume, part.points);
    body.geometry = std::make_shared<StpBvGeometry>(body.volume);
    body.centre = body.volume->centre();
    body.radius = body.volume->enclosingRadius();
  } else {
    const auto hull = hullGeometry(part.points);
    body.geometry = hull;
    body.centre = hull->aabb_center;
    body.radius = hull->aabb_radius;
  }
  body.centre = body.pose * body.centre;
  return body;
}

}  // namespace

const std::vector<Body>& LinkParts::of(int index, int most) {
  const auto [found, isNew] = known_.try_emplace({index, most});
  const Body& whole = whole_->bodies[at(index)];
  if (!isNew || whole.file.empty() || most < 2) return found->second;
  const TriangleMesh mesh = loadMesh(whole.file, whole.scale);
  if (mesh.triangles.empty()) return found->second;
  PartsOptions options;
  options.most = most;
  try {
    int number = 0;
    for (const ConvexPart& part : convexParts(mesh, options).parts)
      found->second.push_back(partOf(whole, index, ++number, part));
  } catch (const Error& error) {
    found->second.clear();
    throw Error(whole.file + ": " + error.what());
  }
  return found->second;
}

RobotGeometry LinkParts::geometry(const std::map<int, int>& most, const std::set<LinkPair>& byParts) {
  RobotGeometry all;
  all.warnings = whole_->warnings;
  all.fromCache = whole_->fromCache;
  all.byParts = byParts;
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
