// Bodies of links from meshes and primitives, and the cache of volumes.
#include <catch2/catch.hpp>
#include <filesystem>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/mesh/mesh_reads.h"
#include "test/reference/robots.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

GeometryOptions cachedIn(const std::string& folder) {
  GeometryOptions options;
  options.cacheFolder = folder;
  return options;
}

// A robot with one link, whose mesh is a tetrahedron of this size.
RobotModel tetrahedron(const TemporaryFolder& folder, double size) {
  const std::string s = std::to_string(size);
  put(folder / "mesh.obj",
      "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nv 0 0 " + s + "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  put(folder / "r.urdf", robot(link("a", "<mesh filename=\"mesh.obj\" scale=\"1 -1 1\"/>")));
  return loadUrdf(folder / "r.urdf");
}

bool sameVolume(const StpBv& a, const StpBv& b) {
  return a.vertices() == b.vertices() && a.faces() == b.faces();
}

}  // namespace

TEST_CASE("every link of every robot becomes a body within its bounding sphere") {
  for (const TestRobot& robot : robots()) {
    const LoadedRobot loaded = load(robot);
    INFO(robot.name);
    std::size_t shapes = 0;
    for (const LinkModel& link : loaded.model->links) shapes += link.collision.size();
    CHECK(loaded.geometry.bodies.size() == shapes);
    for (const Body& body : loaded.geometry.bodies) {
      REQUIRE(body.geometry);
      if (!body.volume) continue;
      for (const Eigen::Vector3d& v : body.volume->vertices())
        CHECK((body.pose * v - body.centre).norm() + body.volume->radii().r <= body.radius + 1e-12);
      CHECK(body.cover.max >= body.volume->radii().r);
    }
    CHECK(loaded.geometry.warnings.empty());
  }
}

TEST_CASE("fitted radii come from the cache with the volume, and the mesh is not read again") {
  TemporaryFolder folder;
  const RobotModel robot = tetrahedron(folder, 0.3);
  GeometryOptions options = cachedIn(folder / "cache");
  for (const auto& [fitSmallRadius, fitBigRadius] : {std::pair{true, true}, {true, false}, {false, true}}) {
    options.fitSmallRadius = fitSmallRadius;
    options.fitBigRadius = fitBigRadius;
    long before = pagesOfChildren();
    const Body cold = loadGeometry(robot, options).bodies[0];
    CHECK(pagesOfChildren() > before);
    before = pagesOfChildren();
    const RobotGeometry warm = loadGeometry(robot, options);
    CHECK(pagesOfChildren() == before);
    CHECK(warm.fromCache == 1);
    CHECK(warm.bodies[0].radii.r == cold.radii.r);
    CHECK(warm.bodies[0].radii.R == cold.radii.R);
    CHECK(sameVolume(*warm.bodies[0].volume, *cold.volume));
    CHECK((cold.radii.r != options.radii.r) == fitSmallRadius);
    CHECK((cold.radii.R != options.radii.R) == fitBigRadius);
  }
}

TEST_CASE("each mesh gets the radii that its task asks for, and they are kept with the volume") {
  TemporaryFolder folder;
  const RobotModel robot = tetrahedron(folder, 0.3);
  GeometryOptions options = cachedIn(folder / "cache");
  RadiiTask task;
  task.acceleration = 4;
  task.clearance = 0.05;
  options.advice = task;
  options.fitSmallRadius = true;  // the advice overrides this
  const RobotGeometry cold = loadGeometry(robot, options);
  const Body& body = cold.bodies[0];
  const RadiiAdvice alone = adviseRadii(loadPoints(body.file), task);
  REQUIRE(alone.meetsBoth);
  REQUIRE(body.advice);
  CHECK(body.radii.r == alone.radii.r);
  CHECK(body.radii.R == alone.radii.R);
  CHECK(body.cover.max <= task.clearance);
  CHECK(cold.warnings.empty());

  const long before = pagesOfChildren();
  const RobotGeometry warm = loadGeometry(robot, options);
  CHECK(pagesOfChildren() == before);
  CHECK(warm.fromCache == 1);
  CHECK(sameVolume(*warm.bodies[0].volume, *body.volume));
  CHECK(warm.bodies[0].advice->acceleration == alone.acceleration);
  CHECK(warm.bodies[0].advice->leastClearance == alone.leastClearance);

  // Another task gives another volume. A task that cannot be kept gives a warning, also from a warm cache.
  options.advice->clearance = alone.leastClearance / 2;
  for (const int fromCache : {0, 1}) {
    const RobotGeometry tight = loadGeometry(robot, options);
    CHECK(tight.fromCache == fromCache);
    CHECK(tight.bodies[0].cover.max <= options.advice->clearance);
    REQUIRE(tight.warnings.size() == 1);
    CHECK_THAT(tight.warnings[0], Contains("no r and R keep 1 of 1 meshes within a clearance"));
  }
  put(folder / "box.urdf", fcl_stpbv::test::robot(link("b", "<box size=\"1 1 1\"/>")));
  const RobotGeometry box = loadGeometry(loadUrdf(folder / "box.urdf"), options);
  REQUIRE(box.warnings.size() == 1);
  CHECK_THAT(box.warnings[0], Contains("1 primitives keep the general r and R"));
  options.links[robot.links[0].name] = {0.01, 5};
  CHECK(loadGeometry(robot, options).bodies[0].radii.R == 5);
  options.links.clear();
  options.advice->clearance = 1e-8;  // less than the clearance lost in a period
  CHECK_THROWS_WITH(loadGeometry(robot, options), Contains(body.file) && Contains("clearance"));
}

TEST_CASE("a volume so round that corners of the hull lie inside keeps one that has them") {
  TemporaryFolder folder;
  // A square of 20 cm with a corner 1 mm above its middle, and one far below. At R = 0.3 m the former is
  // inside the volume.
  put(folder / "mesh.obj",
      "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0.1 0.1 0\nv -0.1 0.1 0\nv 0 0 0.001\nv 0 0 -0.1\n"
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n");
  put(folder / "r.urdf", robot(link("a", "<mesh filename=\"mesh.obj\"/>")));
  const RobotModel robot = loadUrdf(folder / "r.urdf");
  GeometryOptions options = cachedIn(folder / "cache");
  for (const double R : {100.0, 0.3}) {
    options.radii = {0.001, R};
    for (const bool warm : {false, true}) {
      const RobotGeometry geometry = loadGeometry(robot, options);
      CHECK((geometry.fromCache > 0) == warm);
      const Body& body = geometry.bodies[0];
      CHECK((body.full != nullptr) == (R < 1));
      CHECK(body.volume->vertexCount() == (R < 1 ? 5 : 6));
      if (body.full) CHECK(body.full->volume().vertexCount() == 6);
      // The over-cover is over the hull of all points. It is smaller than that over the hull of the five
      // points, by about a millimetre.
      const double most = overCover(*body.volume).max;
      CHECK(body.cover.max == overCover(*body.volume, loadPoints(body.file)).max);
      if (R < 1) CHECK(body.cover.max < most - 5e-4);
    }
  }
}

TEST_CASE("flat meshes and single triangles leave no corner inside") {
  TemporaryFolder folder;
  for (const char* faces : {"f 1 2 3\nf 1 3 4\n", "f 1 2 3\n"}) {
    put(folder / "mesh.obj", std::string("v 0 0 0\nv 0.3 0 0\nv 0.3 0.2 0\nv 0 0.2 0\n") + faces);
    put(folder / "r.urdf", robot(link("a", "<mesh filename=\"mesh.obj\"/>")));
    const Body body = loadGeometry(loadUrdf(folder / "r.urdf"), cachedIn("")).bodies[0];
    CHECK(body.full == nullptr);
    CHECK(body.cover.max >= body.radii.r);
  }
}

TEST_CASE("a second load takes volumes from the cache, and others when content or radii change") {
  TemporaryFolder folder;
  const RobotModel model = tetrahedron(folder, 0.1);
  GeometryOptions options = cachedIn(folder / "cache");
  const RobotGeometry first = loadGeometry(model, options);
  CHECK(first.fromCache == 0);
  const RobotGeometry second = loadGeometry(model, options);
  CHECK(second.fromCache == 1);
  CHECK(sameVolume(*first.bodies[0].volume, *second.bodies[0].volume));
  options.radii.r = 0.02;
  CHECK(loadGeometry(model, options).fromCache == 0);
  CHECK(loadGeometry(tetrahedron(folder, 0.2), options).fromCache == 0);
}

TEST_CASE("a damaged entry of the cache is built anew") {
  TemporaryFolder folder;
  const RobotModel model = tetrahedron(folder, 0.1);
  const RobotGeometry first = loadGeometry(model, cachedIn(folder / "cache"));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache")) {
    std::string text = contentOf(entry.path().string());
    text[text.size() - 3] ^= 1;
    put(entry.path().string(), text);
  }
  const RobotGeometry again = loadGeometry(model, cachedIn(folder / "cache"));
  CHECK(again.fromCache == 0);
  CHECK(sameVolume(*first.bodies[0].volume, *again.bodies[0].volume));
  CHECK(loadGeometry(model, cachedIn(folder / "cache")).fromCache == 1);
}

TEST_CASE("a cache that cannot be written is done without") {
  TemporaryFolder folder;
  const RobotModel model = tetrahedron(folder, 0.1);
  put(folder / "file", "not a folder");
  CHECK(loadGeometry(model, cachedIn(folder / "file")).bodies.size() == 1);
}

TEST_CASE("single links have their own radii, and an over-cover budget raises R") {
  TemporaryFolder folder;
  const RobotModel model = tetrahedron(folder, 0.5);
  GeometryOptions options = cachedIn("");
  options.links["a"] = {0.005, 2};
  CHECK(loadGeometry(model, options).bodies[0].volume->radii().R == 2);
  options.overCoverBudget = 0.006;
  const Body body = loadGeometry(model, options).bodies[0];
  CHECK(body.cover.max <= 0.006);
  CHECK(body.volume->radii().R > 2);
  options.overCoverBudget = 0.004;
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, options); }, ""), Contains("budget"));
  options = cachedIn("");
  options.radii.R = 100;
  options.overCoverBudget = 0.0102;  // large faces leave 0.2 mm of this for the bulge of R
  const TemporaryFolder other;
  const Body large = loadGeometry(tetrahedron(other, 20), options).bodies[0];
  CHECK(large.cover.max <= 0.0102);
  CHECK(large.volume->radii().R > 2e5);
  options = cachedIn("");
  options.links["nobody"] = {};
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, options); }, ""), Contains("nobody"));
}

TEST_CASE("an over-cover budget is spent on fewer vertices that still cover every point of the mesh") {
  const TemporaryFolder folder;
  const TestRobot robot = robots()[0];
  const auto model = std::make_shared<const RobotModel>(loadUrdf(robot.urdf));
  GeometryOptions options = cachedIn(folder / "cache");
  const RobotGeometry all = loadGeometry(*model, options);
  options.overCoverBudget = 0.02;
  options.budgets["BODY"] = 0.2;
  const RobotGeometry few = loadGeometry(*model, options);
  int before = 0, after = 0;
  for (std::size_t i = 0; i < few.bodies.size(); ++i) {
    const Body& body = few.bodies[i];
    INFO(body.name);
    before += all.bodies[i].volume->vertexCount();
    after += body.volume->vertexCount();
    const std::vector<Eigen::Vector3d> points =
        loadPoints(body.file, model->links[static_cast<std::size_t>(body.link)].collision[0].scale);
    CHECK(verify(*body.volume, points, options.radii.r).ok);
    const double budget = body.name == "BODY" ? 0.2 : 0.02;
    CHECK(overCover(*body.volume, points).max <= budget);
    CHECK(body.cover.max == overCover(*body.volume, points).max);
    if (body.name == "BODY") CHECK(body.volume->vertexCount() <= 2);
    if (body.full) CHECK(body.full->volume().vertexCount() > body.volume->vertexCount());
  }
  CHECK(after < before / 2);
  const RobotGeometry again = loadGeometry(*model, options);
  CHECK(again.fromCache >= static_cast<int>(2 * again.bodies.size()));  // full and reduced volumes
  for (std::size_t i = 0; i < few.bodies.size(); ++i)
    CHECK(sameVolume(*few.bodies[i].volume, *again.bodies[i].volume));
}

TEST_CASE("a mesh that is missing or broken names robot, link and file") {
  TemporaryFolder folder;
  const RobotModel model = tetrahedron(folder, 0.1);
  put(folder / "mesh.obj", "nothing");
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, cachedIn("")); }, ""),
             Contains("r.urdf") && Contains("'a'") && Contains("mesh.obj"));
  std::filesystem::remove(folder / "mesh.obj");
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, cachedIn("")); }, ""),
             Contains("'a'") && Contains("tried") && Contains(folder / "mesh.obj"));
  std::filesystem::create_directory(folder / "mesh.obj");
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, cachedIn("")); }, ""),
             Contains(folder / "mesh.obj" + ": is a folder, expected a file"));
  std::filesystem::remove(folder / "mesh.obj");
  std::filesystem::create_symlink("/dev/zero", folder / "mesh.obj");
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, cachedIn("")); }, ""),
             Contains(folder / "mesh.obj" + ": is a pipe or a device, expected a file"));
  const auto load = [](const std::string& path) { loadUrdf(path); };
  CHECK(refusal(load, folder / "none.urdf") == folder / "none.urdf" + ": no such file");
  std::filesystem::create_symlink("loop.urdf", folder / "loop.urdf");
  CHECK_THAT(refusal(load, folder / "loop.urdf"), Contains("loop.urdf: cannot be reached: Too many levels"));
}

TEST_CASE("primitives stay primitives") {
  const RobotModel model =
      parseUrdf(robot("<link name=\"a\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision>"
                      "<collision><geometry><box size=\"1 2 2\"/></geometry></collision></link>"),
                "p.urdf");
  const RobotGeometry geometry = loadGeometry(model, cachedIn(""));
  REQUIRE(geometry.bodies.size() == 2);
  CHECK(geometry.bodies[0].geometry->getNodeType() == fcl::GEOM_SPHERE);
  CHECK(geometry.bodies[1].radius == 1.5);
  CHECK(geometry.bodies[1].name == "a#2");
  CHECK(geometry.of(0) == std::pair<int, int>(0, 2));
}

TEST_CASE("a link that has only visual shapes beside others' collision shapes is named") {
  const auto link = [](const std::string& name, const std::string& use) {
    return "<link name=\"" + name + "\"><" + use + "><geometry><sphere radius=\"1\"/></geometry></" + use +
           "></link>";
  };
  const auto joint = [](const std::string& child) {
    return "<joint name=\"j" + child + "\" type=\"fixed\"><parent link=\"a\"/><child link=\"" + child +
           "\"/></joint>";
  };
  std::string text = link("a", "collision");
  GeometryOptions options = cachedIn("");
  CHECK(loadGeometry(parseUrdf(robot(text), "v.urdf"), options).warnings.empty());
  text += link("b", "visual") + joint("b") + "<link name=\"frame\"/>" + joint("frame");
  const RobotGeometry geometry = loadGeometry(parseUrdf(robot(text), "v.urdf"), options);
  REQUIRE(geometry.warnings.size() == 1);
  CHECK_THAT(geometry.warnings[0], Contains("1 link has visual shapes but no collision shape") &&
                                       Contains("\"b\"") && !Contains("frame"));
  options.visual = true;
  CHECK_THAT(loadGeometry(parseUrdf(robot(text), "v.urdf"), options).warnings.at(0),
             Contains("collision shapes but no visual one") && Contains("\"a\""));
}

TEST_CASE("a robot without collision shapes is used by its visual ones, with a warning") {
  const std::string visual =
      "<link name=\"a\"><visual><geometry><sphere radius=\"1\"/></geometry></visual></link>";
  const RobotGeometry geometry = loadGeometry(parseUrdf(robot(visual), "v.urdf"), cachedIn(""));
  CHECK(geometry.bodies.size() == 1);
  REQUIRE(geometry.warnings.size() == 1);
  CHECK_THAT(geometry.warnings[0], Contains("visual"));
  const RobotGeometry nothing = loadGeometry(parseUrdf(robot(link("a")), "n.urdf"), cachedIn(""));
  CHECK(nothing.bodies.empty());
  CHECK(nothing.warnings.size() == 1);
}

TEST_CASE("a flat link is its convex hull, and in a pair with a smooth one its gradient is as exact") {
  const TestRobot robot = robots()[0];
  const auto model = std::make_shared<const RobotModel>(loadUrdf(robot.urdf));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  GeometryOptions options = cachedIn("");
  options.flatLinks.insert("BODY");
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model, options));
  const int body = geometry->of(model->link("BODY")).first,
            hand = geometry->of(model->link("LARM_LINK5")).first;
  const Body& flat = geometry->bodies[static_cast<std::size_t>(body)];
  CHECK(!flat.volume);
  for (const Eigen::Vector3d& p :
       loadPoints(flat.file, model->links[static_cast<std::size_t>(flat.link)].collision[0].scale))
    CHECK((flat.pose * p - flat.centre).norm() <= flat.radius + 1e-12);
  CollisionConstraints constraints(kinematics, geometry, {{body, hand}});
  const int n = kinematics->size();
  Eigen::VectorXd q = kinematics->neutral(), d(1), to(1), from(1);
  Eigen::MatrixXd J(1, n);
  constraints.evaluate(q, d, J);
  CHECK(constraints.answer(0).status == DistanceStatus::exact);
  CHECK(constraints.answer(0).continuous);
  constexpr double kStep =
      1e-6;  // a central difference is then accurate to rounding of 1e-10 / 1e-6, and curvature times h^2
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd moved = q;
    moved[i] += kStep;
    constraints.evaluate(moved, to);
    moved[i] -= 2 * kStep;
    constraints.evaluate(moved, from);
    CHECK(std::abs((to[0] - from[0]) / (2 * kStep) - J(0, i)) <= 1e-8);
  }
  options.flatLinks = {"nobody"};
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(*model, options); }, ""), Contains("nobody"));
}
