// modelForScene(): not finer than the needs require, as fine as they require, and the same for any number of
// threads.
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/scene_model.h"
#include "fcl_stpbv/robot/triangle_tree.h"
#include "test/reference/solids.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string origin(const std::string& xyz, const std::string& rpy = "0 0 0") {
  return "<origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/>";
}

/// An L in the xy plane, a cup that slides along x and y, and a second L, turned by half a turn. The second L
/// slides along x, from a position where the two hook into each other without touching.
struct Workshop {
  TemporaryFolder folder;
  std::shared_ptr<const RobotModel> robot;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<std::shared_ptr<const RobotGeometry>> levels;
  LinkPair cupAndL, hooks;
  SceneModelOptions options;

  Workshop() {
    saveMesh(folder / "l.obj", lShape());
    saveMesh(folder / "cup.obj", bowl(0.02, 6));
    const std::string mesh = "<mesh filename=\"";
    const std::string alongX = "<axis xyz=\"1 0 0\"/>", alongY = "<axis xyz=\"0 1 0\"/>";
    put(folder / "r.urdf",
        fcl_stpbv::test::robot(
            link("l", mesh + "l.obj\"/>") + link("carriage") + link("cup", mesh + "cup.obj\"/>") +
            link("hook", mesh + "l.obj\"/>") + joint("x", "prismatic", "l", "carriage", alongX) +
            joint("y", "prismatic", "carriage", "cup", alongY) +
            joint("h", "prismatic", "l", "hook", alongX + origin("0.26 0.12 0", "0 0 3.141592653589793"))));
    robot = std::make_shared<const RobotModel>(loadUrdf(folder / "r.urdf"));
    kinematics = std::make_shared<const Kinematics>(robot);
    GeometryOptions geometry;
    geometry.radii = {0.001, 3};
    geometry.cacheFolder = options.cacheFolder = folder / "cache";
    levels = loadLevels(*robot, geometry, {0.02});
    cupAndL = {robot->link("l"), robot->link("cup")};
    hooks = {robot->link("l"), robot->link("hook")};
  }

  VectorXd at(double x, double y, double hook = -1) const {
    VectorXd q(3);
    q[kinematics->coordinate("x")] = x;
    q[kinematics->coordinate("y")] = y;
    q[kinematics->coordinate("h")] = hook;  // negative values move it away, because it is turned
    return q;
  }

  double distance(const std::shared_ptr<const RobotGeometry>& geometry, const LinkPair& pair,
                  const VectorXd& q) const {
    CollisionConstraints rows(kinematics, geometry, bodiesOf(*geometry, pair));
    VectorXd d(rows.rows());
    rows.evaluate(q, d);
    return d.minCoeff();
  }

  /// Distance of the cup from the L.
  double meshDistance(const VectorXd& q) const {
    const auto tree = [](const TriangleMesh& mesh) {
      return detail::triangleTree(mesh.vertices, mesh.triangles);
    };
    Kinematics::State state = kinematics->makeState();
    kinematics->forward(q, state);
    const auto poseOf = [&](int link) { return state.link[static_cast<std::size_t>(link)]; };
    return fcl_stpbv::distance(*tree(lShape()), poseOf(cupAndL.link1), *tree(bowl(0.02, 6)),
                               poseOf(cupAndL.link2))
        .distance;
  }

  SceneModel model(const std::vector<SceneNeed>& needs) const {
    return modelForScene(kinematics, levels, {}, needs, options);
  }

  /// A position below the L where the coarse volumes overlap by a millimetre.
  VectorXd belowTheL() const {
    double apart = -0.5, meets = 0;
    while (meets - apart > 1e-9) {
      const double y = (apart + meets) / 2;
      (distance(levels[0], cupAndL, at(0.1, y)) > 0 ? apart : meets) = y;
    }
    return at(0.1, meets + 0.001);
  }
};

const Workshop& workshopOfAll() {
  static const Workshop workshop;
  return workshop;
}

// Whether the link is the same whole body at this level.
bool isWhole(const RobotGeometry& geometry, const RobotGeometry& level, int link) {
  const auto [first, last] = geometry.of(link);
  return last == first + 1 && geometry.bodies[static_cast<std::size_t>(first)].volume ==
                                  level.bodies[static_cast<std::size_t>(level.of(link).first)].volume;
}

void checkSame(const RobotGeometry& a, const RobotGeometry& b) {
  REQUIRE(a.bodies.size() == b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    CHECK(a.bodies[i].name == b.bodies[i].name);
    CHECK(a.bodies[i].partOf == b.bodies[i].partOf);
    CHECK(a.bodies[i].volume->vertices() == b.bodies[i].volume->vertices());
  }
  REQUIRE(a.byParts.size() == b.byParts.size());
  for (const LinkPair& pair : a.byParts) CHECK(b.byParts.count(pair) == 1);
}

}  // namespace

TEST_CASE("a scene that the coarsest bodies show gets no finer ones") {
  const Workshop& workshop = workshopOfAll();
  const SceneModel model = workshop.model({{workshop.cupAndL, workshop.at(0.5, 0.5), 0.05}});
  CHECK(model.unmet.empty());
  CHECK(model.geometry->byParts.empty());
  CHECK(workshop.levels[0]->bodies.size() == model.geometry->bodies.size());
  for (const int link : {workshop.cupAndL.link1, workshop.cupAndL.link2, workshop.hooks.link2})
    CHECK(isWhole(*model.geometry, *workshop.levels[0], link));
}

TEST_CASE("a finer level of one link is taken before parts") {
  const Workshop& workshop = workshopOfAll();
  const VectorXd q = workshop.belowTheL();
  REQUIRE(workshop.distance(workshop.levels[0], workshop.cupAndL, q) < 0);
  REQUIRE(workshop.distance(workshop.levels[1], workshop.cupAndL, q) > 0);
  const SceneModel model = workshop.model({{workshop.cupAndL, q, 0}});
  CHECK(model.unmet.empty());
  CHECK(workshop.distance(model.geometry, workshop.cupAndL, q) > 0);
  CHECK(model.geometry->byParts.empty());
  const bool fineL = isWhole(*model.geometry, *workshop.levels[1], workshop.cupAndL.link1);
  const bool fineCup = isWhole(*model.geometry, *workshop.levels[1], workshop.cupAndL.link2);
  CHECK(fineL != fineCup);
  CHECK(isWhole(*model.geometry, *workshop.levels[0], workshop.hooks.link2));
}

TEST_CASE("a pair whose hulls meet is taken by the fewest parts, and only that pair") {
  const Workshop& workshop = workshopOfAll();
  const VectorXd q = workshop.at(0.11, 0.11);  // in the corner of the L, 4 cm from its arms
  REQUIRE(workshop.distance(workshop.levels[1], workshop.cupAndL, q) < 0);
  const SceneModel model = workshop.model({{workshop.cupAndL, q, 0.02}});
  CHECK(model.unmet.empty());
  CHECK(workshop.distance(model.geometry, workshop.cupAndL, q) > 0.02);
  CHECK(model.geometry->byParts.size() == 1);
  CHECK(model.geometry->byParts.count(workshop.cupAndL) == 1);
  CHECK(bodiesOf(*model.geometry, workshop.cupAndL).size() == 2);
  CHECK(bodiesOf(*model.geometry, workshop.hooks).size() == 1);
  CHECK(isWhole(*model.geometry, *workshop.levels[0], workshop.hooks.link2));
}

TEST_CASE("a link whose own mesh does not clear the other link is not split") {
  const Workshop& workshop = workshopOfAll();
  SceneModelOptions options = workshop.options;
  options.cacheFolder = workshop.folder / "of the L alone";
  // The cup itself is inside the hull of the L, so only the L is split.
  modelForScene(workshop.kinematics, workshop.levels, {}, {{workshop.cupAndL, workshop.at(0.11, 0.11), 0.02}},
                options);
  std::size_t meshes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(options.cacheFolder))
    meshes += entry.path().extension() == ".parts";
  CHECK(meshes == 1);
}

TEST_CASE("where no single link helps both are split") {
  const Workshop& workshop = workshopOfAll();
  const VectorXd q = workshop.at(-0.5, -0.5, 0);
  const SceneModel model = workshop.model({{workshop.hooks, q, 0}});
  CHECK(model.unmet.empty());
  CHECK(workshop.distance(model.geometry, workshop.hooks, q) > 0);
  CHECK(bodiesOf(*model.geometry, workshop.hooks).size() == 4);
}

TEST_CASE("a need that the finest bodies do not show changes nothing and is named") {
  const Workshop& workshop = workshopOfAll();
  const SceneNeed inside{workshop.cupAndL, workshop.at(0.02, 0.1), 0};
  const SceneNeed tooFar{workshop.cupAndL, workshop.at(0.11, 0.11), 0.05};
  const SceneModel model = workshop.model({inside, tooFar});
  REQUIRE(model.unmet.size() == 2);
  CHECK(model.unmet[0].q == inside.q);
  CHECK(model.unmet[1].clearance == 0.05);
  checkSame(*model.geometry, *workshop.levels[0]);
}

TEST_CASE("a clearance that the meshes themselves do not have is told before parts are searched") {
  const Workshop& workshop = workshopOfAll();
  SceneModelOptions options = workshop.options;
  options.cacheFolder = workshop.folder / "of the parts";
  const std::vector<SceneNeed> needs{{workshop.cupAndL, workshop.at(0.11, 0.11), 0.05},
                                     {workshop.hooks, workshop.at(-0.5, -0.5, 0), 1}};
  const SceneModel model = modelForScene(workshop.kinematics, workshop.levels, {}, needs, options);
  CHECK(model.unmet.size() == 2);
  CHECK_FALSE(std::filesystem::exists(options.cacheFolder));
  // Each surface is at least r = 1 mm away from its mesh.
  const VectorXd q = workshop.at(0.11, 0.11);
  const double apart = workshop.meshDistance(q);
  REQUIRE(apart > 0.002);
  const SceneModel within = modelForScene(workshop.kinematics, workshop.levels, {},
                                          {{workshop.cupAndL, q, apart - 0.0019}}, options);
  CHECK(within.unmet.size() == 1);
  CHECK_FALSE(std::filesystem::exists(options.cacheFolder));
  const SceneModel beyond = modelForScene(workshop.kinematics, workshop.levels, {},
                                          {{workshop.cupAndL, q, apart - 0.0021}}, options);
  CHECK(std::filesystem::exists(options.cacheFolder));
}

TEST_CASE("the parts of volumes with few vertices and a large r are used where they are needed") {
  const Workshop& workshop = workshopOfAll();
  GeometryOptions coarse;
  coarse.radii = {0.001, 3};
  coarse.overCoverBudget = 0.05;
  coarse.cacheFolder = workshop.options.cacheFolder;
  const auto level = std::make_shared<const RobotGeometry>(loadGeometry(*workshop.robot, coarse));
  const VectorXd q = workshop.at(0.11, 0.11);
  double largest = 0;
  for (const Body& body : level->bodies) largest = std::max(largest, body.volume->radii().r);
  const double clearance = 0.03;  // the meshes are farther apart, but not by the large r
  REQUIRE(workshop.meshDistance(q) > clearance + 2 * coarse.radii.r);
  REQUIRE(workshop.meshDistance(q) < clearance + largest);
  const SceneModel model =
      modelForScene(workshop.kinematics, {level}, {}, {{workshop.cupAndL, q, clearance}}, workshop.options);
  CHECK(model.unmet.empty());
  CHECK(workshop.distance(model.geometry, workshop.cupAndL, q) > clearance);
}

TEST_CASE("obstacles make needs too; the order of needs and the number of threads change nothing") {
  const Workshop& workshop = workshopOfAll();
  const auto ball = std::make_shared<fcl::Sphered>(0.02);
  const std::vector<Obstacle> around{obstacleOf(
      fcl::CollisionObjectd(ball, Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.11, 0.11, 0.02)), "ball")};
  const LinkPair withBall{workshop.cupAndL.link1, 0, true};
  std::vector<SceneNeed> needs{{withBall, workshop.at(-0.5, -0.5), 0.02},
                               {workshop.hooks, workshop.at(-0.5, -0.5, 0), 0},
                               {workshop.cupAndL, workshop.belowTheL(), 0}};
  const SceneModel model =
      modelForScene(workshop.kinematics, workshop.levels, around, needs, workshop.options);
  CHECK(model.unmet.empty());
  CHECK(model.geometry->byParts.count(withBall) == 1);
  CHECK(model.geometry->byParts.count(workshop.cupAndL) == 0);
  std::reverse(needs.begin(), needs.end());
  SceneModelOptions threads = workshop.options;
  threads.threads = 4;
  checkSame(*modelForScene(workshop.kinematics, workshop.levels, around, needs, threads).geometry,
            *model.geometry);
}

TEST_CASE("levels of other shapes and needs that make no sense are refused") {
  const Workshop& workshop = workshopOfAll();
  const auto refused = [&](const SceneNeed& need) {
    return refusal([&](const std::string&) { workshop.model({need}); }, "");
  };
  const VectorXd q = workshop.at(0, 0);
  CHECK_THAT(refused({{0, 99}, q, 0}), Contains("does not exist"));
  CHECK_THAT(refused({{0, 0, true}, q, 0}), Contains("does not exist"));
  CHECK_THAT(refused({{1, 1}, q, 0}), Contains("a link and itself"));
  CHECK_THAT(refused({workshop.cupAndL, VectorXd::Zero(2), 0}), Contains("3 finite numbers"));
  CHECK_THAT(refused({workshop.cupAndL, VectorXd::Constant(3, kInfinity), 0}), Contains("3 finite numbers"));
  CHECK_THAT(refused({workshop.cupAndL, q, kInfinity}), Contains("not finite"));
  auto other = std::make_shared<RobotGeometry>(*workshop.levels[0]);
  other->bodies.pop_back();
  CHECK_THROWS_WITH(modelForScene(workshop.kinematics, {other, workshop.levels[1]}, {}, {}),
                    Contains("same links"));
  CHECK_THROWS_WITH(modelForScene(workshop.kinematics, {}, {}, {}), Contains("no level"));
  GeometryOptions options;
  options.cacheFolder.clear();
  CHECK_THROWS_WITH(loadLevels(*workshop.robot, options, {0.02, 0.02}), Contains("below the one before"));
  CHECK_THROWS_WITH(loadLevels(*workshop.robot, options, {0.02, 0}), Contains("a budget of 0"));
  CHECK_THROWS_WITH(loadLevels(*workshop.robot, options, {-0.5}), Contains("a budget of -0.5"));
  CHECK_THROWS_WITH(loadLevels(*workshop.robot, options, {std::nan("")}), Contains("a budget of nan"));
}

TEST_CASE("a need whose distance cannot be measured is not met") {
  const Workshop& workshop = workshopOfAll();
  const VectorXd q = workshop.at(0.5, 0.5), far = workshop.at(1e151, 0.5);
  const auto unmetAmong = [&](const Eigen::Isometry3d& pose) {
    const auto ball = std::make_shared<const fcl::Sphered>(0.1);
    const std::vector<Obstacle> obstacles{{"ball", ball, pose}};
    const LinkPair pair{workshop.cupAndL.link2, 0, true};
    return modelForScene(workshop.kinematics, workshop.levels, obstacles, {{pair, q, 0}}, workshop.options)
        .unmet.size();
  };
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(9, 9, 9);
  CHECK(unmetAmong(pose) == 0);
  pose.linear() *= 2;
  CHECK(unmetAmong(pose) == 1);
  CHECK(workshop.model({{workshop.cupAndL, far, 0.01}}).unmet.size() == 1);
}

TEST_CASE("levels of bodies that differ are refused") {
  const TemporaryFolder folder;
  const auto levelOf = [&](const std::string& shape) {
    const auto model = parseUrdf(fcl_stpbv::test::robot(link("a", shape)), folder / "r.urdf");
    return std::make_shared<const RobotGeometry>(loadGeometry(model, {}));
  };
  saveMesh(folder / "l.obj", lShape());
  const auto kinematics = std::make_shared<const Kinematics>(std::make_shared<const RobotModel>(
      parseUrdf(fcl_stpbv::test::robot(link("a", "<sphere radius=\"1\"/>")), folder / "r.urdf")));
  const auto refused = [&](const std::string& one, const std::string& other) {
    const auto load = [&](const std::string&) {
      modelForScene(kinematics, {levelOf(one), levelOf(other)}, {}, {}, {});
    };
    return refusal(load, "").find("the same links' whole bodies") != std::string::npos;
  };
  const std::string ball = "<sphere radius=\"1\"/>", box = "<box size=\"1 2 3\"/>",
                    mesh = "<mesh filename=\"l.obj\"";
  CHECK_FALSE(refused(ball, ball));
  CHECK_FALSE(refused(box, box));
  CHECK_FALSE(refused(mesh + "/>", mesh + "/>"));
  CHECK(refused(ball, "<sphere radius=\"2\"/>"));
  CHECK(refused(ball, box));
  CHECK(refused(box, "<box size=\"1 2 4\"/>"));
  CHECK(refused(mesh + "/>", mesh + " scale=\"2 2 2\"/>"));
  CHECK(refused(mesh + "/>", ball));
}
