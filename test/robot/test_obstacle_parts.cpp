// A scene's obstacles keep their index: by it a search and a proof know whether a pair is checked by convex
// parts, as the rows of constraints do.
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <utility>

#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "test/reference/robots.h"
#include "test/reference/solids.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

constexpr int kL = 1;  // the link with the L

// An L that turns by 0.05 rad either way, and two balls: one far away, one in the L's corner. The corner's
// ball is 7 cm deep in the L's hull, and at least 1 cm from its parts.
struct Corner {
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<Obstacle> obstacles;
  int near;  // index of the ball in the corner
  std::unique_ptr<LinkParts> parts;

  explicit Corner(bool farFirst) : near(farFirst ? 1 : 0) {
    const TemporaryFolder folder;
    saveMesh(folder / "l.obj", lShape());
    GeometryOptions options;
    options.radii = {0.001, 10};
    LoadedRobot loaded =
        parsed(robot(link("base") + link("l", "<mesh filename=\"" + (folder / "l.obj") + "\"/>") +
                     "<joint name=\"j\" type=\"revolute\"><parent link=\"base\"/><child link=\"l\"/>"
                     "<axis xyz=\"0 0 1\"/><limit lower=\"-0.05\" upper=\"0.05\" effort=\"1\" "
                     "velocity=\"1\"/></joint>"),
               options);
    parts =
        std::make_unique<LinkParts>(std::make_shared<const RobotGeometry>(std::move(loaded.geometry)), "");
    parts->prepare({{kL, 2}}, 1);
    kinematics = std::make_shared<const Kinematics>(loaded.model);
    const auto ball = [](double x, double y) {
      const fcl::CollisionObjectd object(std::make_shared<fcl::Sphered>(0.02),
                                         fcl::Transform3d(Eigen::Translation3d(x, y, 0.025)));
      return obstacleOf(object, "ball");
    };
    obstacles = {ball(3, 0), ball(0.09, 0.09)};
    if (!farFirst) std::swap(obstacles[0], obstacles[1]);
  }
};

}  // namespace

TEST_CASE("searches, proofs and rows use the same bodies of a pair with an obstacle") {
  for (const bool farFirst : {true, false}) {
    Corner corner(farFirst);
    const LinkPair near{kL, corner.near, true}, far{kL, 1 - corner.near, true};
    for (const std::set<LinkPair>& byParts : {std::set<LinkPair>{}, std::set<LinkPair>{far},
                                              std::set<LinkPair>{near}, std::set<LinkPair>{near, far}}) {
      const bool inParts = byParts.count(near) > 0;
      CAPTURE(farFirst, inParts, byParts.size());
      const auto geometry = std::make_shared<const RobotGeometry>(corner.parts->geometry({{kL, 2}}, byParts));
      ConstraintOptions options;
      options.obstacles = corner.obstacles;
      CollisionConstraints rows(corner.kinematics, geometry, bodiesOf(*geometry, near), options);
      CHECK(rows.rows() == (inParts ? 2 : 1));
      PairSearch search(corner.kinematics, geometry, near, corner.obstacles);
      Eigen::VectorXd q(1), d(rows.rows());
      for (q[0] = -0.05; q[0] <= 0.05; q[0] += 0.005) {
        rows.evaluate(q, d);
        CHECK(search.distance(q) == Approx(d.minCoeff()).margin(1e-12));
        CHECK((d.minCoeff() > 0.01) == inParts);
      }
      const ProofScene scene = proofScene(corner.kinematics, geometry, corner.obstacles, 0);
      const PairProof proof = provePair(scene, near, unproven(scene, near).open, 100);
      CHECK(proof.proven() == inParts);
      CHECK(proof.collision.has_value() == !inParts);
      PairListOptions list;
      list.samples = 100;
      list.obstacles = corner.obstacles;
      for (const PairEntry& entry : pairList(corner.kinematics, geometry, nullptr, list)) {
        const bool clear = entry.link2 != corner.near || inParts;
        CHECK((entry.reason == PairReason::neverProven) == clear);
        CHECK((entry.minDistance > 0) == clear);
      }
    }
  }
}
