// The code of docs/parts.md, for a mesh of the robot in data/hrp2_style. Run it in that folder.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "docs/examples/named.h"
#include "docs/examples/reported.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/scene_model.h"
#include "fcl_stpbv/volume/stp_bv.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  return reported(argc, argv, [] {
    std::vector<StpBv::Ptr> volumes;
    // clang-format off
const ConvexParts parts = convexParts(loadMesh("meshes/BODY.dae"), {8});   // eight at most
for (const ConvexPart& part : parts.parts) volumes.push_back(StpBv::build(part.points, {0.01, 10.0}));
// no point of a part's hull is farther from the mesh's solid than parts.excess
    // clang-format on
    // Puts two such bodies into FCL's broadphase, as docs/fcl.md shows.
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
    DistanceData data;
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    int first = 0, other = 0;
    const auto place = [&](int& body) {
      // clang-format off
for (const StpBv::Ptr& volume : volumes) {
  objects.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<StpBvGeometry>(volume), pose));
  objects.back()->setUserData(&body);
}
data.leaveOut = [](const auto* a, const auto* b) { return a->getUserData() == b->getUserData(); };
      // clang-format on
    };
    place(first);
    pose.translation().x() = 2;
    place(other);
    fcl::DynamicAABBTreeCollisionManagerd scene;
    for (const auto& object : objects) scene.registerObject(object.get());
    scene.setup();
    scene.distance(&data, distanceCallback);
    // Refines three pairs of the robot as far as needed in its neutral posture.
    const auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
    const auto kinematics = std::make_shared<const Kinematics>(robot);
    const Eigen::VectorXd q = kinematics->neutral();
    const std::vector<Obstacle> obstacles;
    std::vector<LinkPair> pairs;
    for (const char* name : {"HEAD_LINK1", "RARM_LINK5", "RLEG_LINK5"})
      pairs.push_back({linkOf(*robot, "BODY"), linkOf(*robot, name)});
    // clang-format off
GeometryOptions options;
options.radii = {0.01, 10.0};
const auto levels = loadLevels(*robot, options, {0.05, 0.02});  // over-covers of up to 5 and 2 cm, then r = 1 cm with all vertices
std::vector<SceneNeed> needs;                                   // pairs that the coarsest bodies make collide in configurations that matter
for (const LinkPair& pair : pairs) needs.push_back({pair, q, 0.0});
const SceneModel model = modelForScene(kinematics, levels, obstacles, needs);
    // clang-format on
    std::printf("%d of %d needs are met\n", static_cast<int>(needs.size() - model.unmet.size()),
                static_cast<int>(needs.size()));
    std::printf("the two bodies are %.3f m apart\n", data.result.distance);
    std::printf("%d parts, %.3f mm from the mesh at most\n", static_cast<int>(volumes.size()),
                parts.excess * 1e3);
    const bool shown = !volumes.empty() && volumes.size() <= 8 && data.result.distance > 1;
    return shown && model.unmet.empty() ? 0 : 1;
  });
}
