// Volumes of meshes beside those of the polyhedra published for the same links: by how much they differ.
//   volume_differences MESH_FOLDER POLYHEDRON_FOLDER
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>

#include "fcl_stpbv/robot/mesh_file.h"
#include "test/robot/volume_difference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "volume_differences MESH_FOLDER POLYHEDRON_FOLDER\n");
    return 2;
  }
  constexpr double kSame = 1e-6;  // the last digit of the .dae files (m)
  std::set<std::filesystem::path> files(std::filesystem::directory_iterator(argv[2]), {});
  std::printf("%-16s %13s %13s %18s %12s\n", "link", "mesh's", "polyhedron's", "without partner",
              "surfaces [um]");
  for (const std::filesystem::path& file : files) {
    std::string link = file.filename().string();
    link.resize(link.size() - std::string("-ch.txt").size());
    const StpBv::Ptr mesh = StpBv::build(loadPoints(std::string(argv[1]) + "/" + link + ".dae"));
    const StpBv::Ptr polyhedron = StpBv::build(loadPoints(file.string()));
    std::printf("%-16s %13d %13d %9d, %7d %12.2f\n", link.c_str(), mesh->vertexCount(),
                polyhedron->vertexCount(), withoutPartner(*mesh, *polyhedron, kSame),
                withoutPartner(*polyhedron, *mesh, kSame),
                surfaceDifference(*mesh, *polyhedron, 20000) * 1e6);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "volume_differences: %s\n", error.what());
  return 2;
}
