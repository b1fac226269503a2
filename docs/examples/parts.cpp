// What docs/parts.md shows, for a mesh of the robot in data/hrp2_style: run in that folder.
#include <cstdio>
#include <vector>

#include "docs/examples/reported.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/mesh_file.h"
#include "fcl_stpbv/volume/stp_bv.h"

using namespace fcl_stpbv;

int main() {
  return reported([] {
    std::vector<StpBv::Ptr> volumes;
    // clang-format off
const ConvexParts parts = convexParts(loadMesh("meshes/BODY.dae"), {8});   // eight at most
for (const ConvexPart& part : parts.parts) volumes.push_back(StpBv::build(part.points, {0.01, 10.0}));
// no point of a part's hull is farther from the mesh's solid than parts.excess
    // clang-format on
    std::printf("%d parts, %.3f mm from the mesh at most\n", static_cast<int>(volumes.size()),
                parts.excess * 1e3);
    return volumes.empty() || volumes.size() > 8 ? 1 : 0;
  });
}
