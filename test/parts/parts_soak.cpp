// Parts of meshes from files: their number, their distance from the mesh, and the time. Also how many random
// points of the surface, and about as many inside if every piece is closed, no part covers.
//
//   parts_soak SAMPLES PARTS MESH...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/arguments.h"
#include "test/reference/mesh_reference.h"
#include "test/reference/solids.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

// A volume with r = 1 um around each part, which contains the part up to rounding.
class Covered {
 public:
  explicit Covered(const ConvexParts& parts) {
    for (const ConvexPart& part : parts.parts) volumes_.push_back(StpBv::build(part.points, {1e-6, 10}));
  }
  bool operator()(const Eigen::Vector3d& p) const {
    return std::any_of(volumes_.begin(), volumes_.end(),
                       [&](const StpBv::Ptr& volume) { return contains(*volume, p); });
  }

 private:
  std::vector<StpBv::Ptr> volumes_;
};

long uncoveredOnSurface(const Covered& covered, const TriangleMesh& mesh, long samples) {
  Random random(1);
  long open = 0;
  for (long i = 0; i < samples; ++i) open += !covered(pointOn(mesh, random));
  return open;
}

// Random points between two points of the surface. Their number is chosen so that about `samples` of them are
// inside; the first ten thousand show the share. Whether a point is inside is tested only if no part covers
// it, because that takes time.
long uncoveredInside(const Covered& covered, const TriangleMesh& mesh, long samples) {
  constexpr long kToTell = 10000;
  Random random(2);
  const auto between = [&] {
    const Eigen::Vector3d p = pointOn(mesh, random);
    return Eigen::Vector3d(p + random.uniform(0, 1) * (pointOn(mesh, random) - p));
  };
  const auto isInside = [&](const Eigen::Vector3d& p) { return std::abs(referenceWinding(mesh, p)) > 0.5; };
  long inside = 0, open = 0;
  for (long i = 0; i < kToTell; ++i) inside += isInside(between());
  if (inside == 0) return 0;
  for (long left = samples * kToTell / inside; left > 0; --left) {
    const Eigen::Vector3d p = between();
    open += !covered(p) && isInside(p);
  }
  return open;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "SAMPLES PARTS MESH ...", std::numeric_limits<int>::max());
  PartsOptions options;
  const long samples = arguments.number(1, 0L);
  options.most = arguments.number(2, 0);
  const std::vector<std::string> meshes = arguments.texts(3, 1);
  long open = 0;
  try {
    for (std::string name : meshes) {
      const TriangleMesh mesh = loadMesh(name);
      const std::clock_t start = std::clock();
      const ConvexParts parts = convexParts(mesh, options);
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      const double hull = hullExcess(mesh.vertices, MeshSolid(mesh)).upper;
      const Covered covered(parts);
      long here = uncoveredOnSurface(covered, mesh, samples);
      if (parts.closedPieces == parts.pieces) here += uncoveredInside(covered, mesh, samples);
      name = name.substr(name.rfind('/') + 1);
      std::printf(
          "%-20s %6zu triangles, %d of %d pieces closed; hull %7.3f mm; %zu parts %7.3f mm; %6.2f s; "
          "uncovered %ld\n",
          name.c_str(), mesh.triangles.size(), parts.closedPieces, parts.pieces, 1e3 * hull,
          parts.parts.size(), 1e3 * parts.excess, seconds, here);
      std::fflush(stdout);
      open += here;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "parts_soak: %s\n", error.what());
    return 2;
  }
  return open > 0;
}
