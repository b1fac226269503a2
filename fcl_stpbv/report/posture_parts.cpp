// If no posture was found, the pairs at their margin in the best posture prevent one. Of these, the pairs
// whose meshes are farther apart, and whose distance increases with convex parts, get parts, and the search
// starts again.
#include "fcl_stpbv/report/posture_parts.h"

#include <set>

namespace fcl_stpbv::report {
namespace {

// The solver leaves pairs that are in the way about at their margin; all pairs within a millimetre of it are
// examined.
constexpr double kNear = 1e-3;

}  // namespace

PostureParts::PostureParts(const PostureTask& task, PostureScene& scene,
                           std::shared_ptr<const RobotGeometry> around, const GeometryOptions& options)
    : task_(task),
      scene_(scene),
      kinematics_(std::make_shared<const Kinematics>(scene.robot, task.base)),
      near_(task.collisionMargin + kNear),
      choice_(kinematics_, {scene.geometry}, scene.obstacles,
              {options.cacheFolder, options.threads, options.progress}, task.parts > 1),
      causes_(kinematics_, scene.geometry, scene.obstacles, std::move(around)) {
  if (task.parts < 2) return;
  choice_.splitAll(task.parts);
  use(choice_.geometry());
}

Posture PostureParts::find(PostureSetup& setup, const PostureOptions& options) {
  Posture posture = findPosture(setup, options);
  constexpr int kMostRefinements = 3;  // into two, four and eight parts
  for (int k = 0; task_.partsAuto && !posture.feasible && k < kMostRefinements; ++k) {
    if (choice_.refine(inTheWay(setup, posture.q)).empty()) break;
    use(choice_.geometry());
    setup = setUp(task_, scene_);
    posture = findPosture(setup, options);
  }
  return posture;
}

std::vector<SceneNeed> PostureParts::inTheWay(const PostureSetup& setup, const Eigen::VectorXd& q) {
  std::vector<SceneNeed> needs;
  if (setup.pairs.empty()) return needs;
  ConstraintOptions options;
  options.obstacles = scene_.obstacles;
  CollisionConstraints constraints(kinematics_, scene_.geometry, setup.pairs, options);
  Eigen::VectorXd d(constraints.rows());
  constraints.evaluate(q, d);
  std::set<LinkPair> close;
  for (std::size_t i = 0; i < setup.pairs.size(); ++i)
    if (d[static_cast<Eigen::Index>(i)] <= near_) close.insert(linksOf(setup.pairs[i], *scene_.geometry));
  for (const LinkPair& pair : close)
    if (causes_.explain(bodiesOf(*scene_.geometry, pair), q, near_).cause != kMeshesMeet)
      needs.push_back({pair, q, near_});
  return needs;
}

// Replaces the bodies. The robot's own pairs name bodies by number, and parts change the numbers.
void PostureParts::use(std::shared_ptr<const RobotGeometry> geometry) {
  if (scene_.selfPairs) {
    std::set<LinkPair> links;
    for (const CheckedPair& pair : *scene_.selfPairs) links.insert(linksOf(pair, *scene_.geometry));
    scene_.selfPairs->clear();
    for (const LinkPair& pair : links) {
      const std::vector<CheckedPair> bodies = bodiesOf(*geometry, pair);
      scene_.selfPairs->insert(scene_.selfPairs->end(), bodies.begin(), bodies.end());
    }
  }
  scene_.geometry = geometry;
  causes_.use(std::move(geometry));
}

}  // namespace fcl_stpbv::report
