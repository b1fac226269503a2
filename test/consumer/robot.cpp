// Uses the robot component from an installed tree: reads a mesh.
#include <fcl_stpbv/mesh/mesh_file.h>
#include <fcl_stpbv/volume/stp_bv.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto volume = fcl_stpbv::StpBv::build(fcl_stpbv::loadPoints(argv[1]));
  std::printf("%d vertices\n", volume->vertexCount());
  return volume->vertexCount() > 4 ? 0 : 1;
}
