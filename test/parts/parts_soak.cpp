// Parts of meshes from files: how many, how far from the mesh, how long they took, and how many of a number
// of random points of the surface and of the inside no part covers.
//
//   parts_soak SAMPLES PARTS MESH...
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/mesh_file.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/arguments.h"
#include "test/reference/mesh_reference.h"
#include "test/reference/solids.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

// A volume of r = 1 um around each part: what it holds is within rounding of the part.
long uncovered(const ConvexParts& parts, const TriangleMesh& mesh, long samples) {
  std::vector<StpBv::Ptr> volumes;
  for (const ConvexPart& part : parts.parts) volumes.push_back(StpBv::build(part.points, {1e-6, 10}));
  Random random(1);
  long open = 0;
  for (long i = 0; i < samples; ++i) {
    const bool inner = i % 2 != 0;
    Eigen::Vector3d p = pointOn(mesh, random);
    if (inner) p += random.uniform(0, 1) * (pointOn(mesh, random) - p);
    if (inner && (parts.closedPieces < parts.pieces || std::abs(referenceWinding(mesh, p)) < 0.5)) continue;
    bool held = false;
    for (const StpBv::Ptr& volume : volumes) held = held || contains(*volume, p);
    open += !held;
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
      const long here = uncovered(parts, mesh, samples);
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
