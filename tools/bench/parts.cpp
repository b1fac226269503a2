// parts_benchmark: how far from their mesh a few convex parts are, ours beside the hulls of HACD's partition,
// and the processor's time for both (docs/parts.md).
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/mesh_file.h"
#include "tools/bench/parts/hacd.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;

double processorTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double hacdExcess(const TriangleMesh& mesh, int count) {
  const MeshSolid solid(mesh);
  double excess = 0;
  for (const auto& cluster : benchmark::hacdClusters(mesh, count))
    excess = std::max(excess, hullExcess(cluster, solid).upper);
  return excess;
}

struct Arguments {
  std::vector<std::string> meshes;
  std::vector<int> counts{2, 4, 8};
  double effort = 1;
  bool hacd = true;
};

int run(const Arguments& a) {
  std::printf("%-20s %9s %6s %6s %10s %8s %10s %8s\n", "mesh", "triangles", "hull", "parts", "ours", "s",
              "HACD", "s");
  for (const std::string& file : a.meshes) {
    const TriangleMesh mesh = loadMesh(file);
    const double hull = hullExcess(mesh.vertices, MeshSolid(mesh)).upper;
    for (const int count : a.counts) {
      double start = processorTime();
      PartsOptions options;
      options.most = count;
      options.effort = a.effort;
      const ConvexParts ours = convexParts(mesh, options);
      const double oursTime = processorTime() - start;
      start = processorTime();
      const double theirs = a.hacd ? hacdExcess(mesh, count) : 0;
      std::printf("%-20s %9zu %6.1f %2zu/%-3d %10.3f %8.2f %10.3f %8.2f\n",
                  std::filesystem::path(file).stem().c_str(), mesh.triangles.size(), 1e3 * hull,
                  ours.parts.size(), count, 1e3 * ours.excess, oursTime, 1e3 * theirs,
                  processorTime() - start);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  tools::Program app(
      "Largest excess over the mesh (mm) of a few convex parts, ours and HACD's, and the processor's "
      "seconds",
      "parts_benchmark");
  app.option("meshes", a.meshes, "mesh files").required().existingFile();
  app.option("--parts", a.counts, "numbers of parts").whole(1, 1000);
  app.option("--effort", a.effort, "of the search").number(1e-3, 1e6);
  app.flag("!--no-hacd", a.hacd, "ours alone");
  return app.run(argc, argv, [&] { return run(a); });
}
