// Reading URDF and SRDF: their contents are kept, and files that cannot describe a robot are refused with a
// reason.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/package_path.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/robot/srdf.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

RobotModel parse(const std::string& body) { return parseUrdf(robot(body), "small.urdf"); }

/// The result of reading a robot before main() began.
const std::string early = [] {
  try {
    parse("<link name=\"a\"><collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>");
  } catch (const Error& error) {
    return std::string(error.what());
  }
  return std::string("read");
}();

}  // namespace

TEST_CASE("links come parents first and joints in the order of the file") {
  const RobotModel model =
      parse(link("tip") + link("base") + link("mid") + joint("b", "revolute", "mid", "tip") +
            joint("a", "continuous", "base", "mid"));
  REQUIRE(model.links.size() == 3);
  CHECK(model.links[0].name == "base");
  CHECK(model.links[1].name == "mid");
  CHECK(model.links[2].name == "tip");
  CHECK(model.joints[0].name == "b");
  CHECK(model.joints[0].parent == 1);
  CHECK(model.links[2].parentJoint == 0);
  CHECK(model.joints[1].upper == Approx(M_PI));
  CHECK(model.link("nobody") == -1);
}

TEST_CASE("a robot may be read while the program starts") { CHECK(early == "read"); }

TEST_CASE("primitives keep their kind and sizes") {
  const RobotModel model = parse(
      "<link name=\"a\">"
      "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision>"
      "<collision><origin xyz=\"0 0 1\" rpy=\"0 1.5707963267948966 0\"/>"
      "<geometry><box size=\"1 2 3\"/></geometry></collision>"
      "<collision><geometry><capsule radius=\"0.2\" length=\"0.5\"/></geometry></collision>"
      "<collision><geometry><mesh filename=\"x.stl\" scale=\"1 -1 1\"/></geometry></collision></link>");
  const std::vector<ShapeModel>& shapes = model.links[0].collision;
  REQUIRE(shapes.size() == 4);
  CHECK(shapes[0].kind == ShapeModel::Kind::sphere);
  CHECK(shapes[1].kind == ShapeModel::Kind::box);
  CHECK((shapes[1].pose * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1, 0, 1)).norm() < 1e-15);
  CHECK(shapes[2].kind == ShapeModel::Kind::capsule);
  CHECK(shapes[2].size.y() == 0.5);
  CHECK(shapes[3].scale.y() == -1);
}

TEST_CASE("a cylinder with a sphere of its radius at either end is a capsule") {
  const std::string ends =
      "<collision><origin xyz=\"0 0 0.5\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>"
      "<collision><origin xyz=\"0 0 -0.5\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  const std::string cylinder =
      "<collision><geometry><cylinder radius=\"0.1\" length=\"1\"/></geometry></collision>";
  const RobotModel model = parse("<link name=\"a\">" + ends + cylinder + "</link>");
  REQUIRE(model.links[0].collision.size() == 1);
  CHECK(model.links[0].collision[0].kind == ShapeModel::Kind::capsule);
  CHECK(model.links[0].collision[0].size.y() == 1);
}

TEST_CASE("a capsule holds the spheres at its ends where their last digits differ") {
  const auto sphere = [](const std::string& xyz, const std::string& radius) {
    return "<collision><origin xyz=\"" + xyz + "\"/><geometry><sphere radius=\"" + radius +
           "\"/></geometry></collision>";
  };
  const std::string cylinder =
      "<collision><geometry><cylinder radius=\"0.1\" length=\"1\"/></geometry></collision>";
  const auto radiusWith = [&](const std::string& ends) {
    const RobotModel model = parse("<link name=\"a\">" + ends + cylinder + "</link>");
    REQUIRE(model.links[0].collision.size() == 1);
    return model.links[0].collision[0].size.x();
  };
  CHECK(radiusWith(sphere("0 0 0.5", "0.1000009") + sphere("0 0 -0.5", "0.1")) == 0.1000009);
  CHECK(radiusWith(sphere("0 0 -0.5", "0.1") + sphere("0 0 0.5000008", "0.1")) >= 0.1000008 - 1e-15);
  CHECK(radiusWith(sphere("0.0000005 0 0.5", "0.1") + sphere("0 0 -0.5", "0.0999995")) >= 0.1000005 - 1e-15);
  CHECK(radiusWith(sphere("0 0 0.5", "0.0999995") + sphere("0 0 -0.5", "0.0999995")) == 0.1);
}

TEST_CASE("a mimic joint is tied to the end of its chain") {
  const RobotModel model =
      parse(link("a") + link("b") + link("c") + link("d") + joint("j1", "revolute", "a", "b") +
            joint("j2", "revolute", "b", "c", "<mimic joint=\"j1\" multiplier=\"2\" offset=\"0.5\"/>") +
            joint("j3", "revolute", "c", "d", "<mimic joint=\"j2\" multiplier=\"-1\" offset=\"0.25\"/>"));
  REQUIRE(model.joints[2].mimic);
  CHECK(model.joints[2].mimic->joint == 0);
  CHECK(model.joints[2].mimic->multiplier == -2);
  CHECK(model.joints[2].mimic->offset == -0.25);
}

TEST_CASE("a joint without a range may have any limit") {
  for (const char* type : {"fixed", "continuous", "planar", "floating"}) {
    CAPTURE(type);
    const std::string text = "<joint name=\"j\" type=\"" + std::string(type) +
                             "\"><parent link=\"a\"/><child link=\"b\"/><limit lower=\"1\" upper=\"-1\" "
                             "effort=\"1\" velocity=\"1\"/></joint>";
    CHECK(parse(link("a") + link("b") + text).joints.size() == 1);
  }
}

TEST_CASE("a mimic joint that cannot follow is refused by what it is tied to") {
  const std::string links = link("a") + link("b") + link("c");
  for (const char* type : {"fixed", "planar"})
    CHECK_THAT(
        refused(robot(links + joint("j", type, "a", "b") +
                      joint("k", "revolute", "b", "c", "<mimic joint=\"j\"/>"))),
        Contains("joint 'k'") && Contains("mimics 'j', expected a joint that moves along or about one axis"));
}

TEST_CASE("the fault of a joint is not reported again as a fault of those that mimic it") {
  const std::string links = link("a") + link("b") + link("c") + link("d");
  const std::string followers = joint("k", "revolute", "b", "c", "<mimic joint=\"j\"/>") +
                                joint("m", "revolute", "c", "d", "<mimic joint=\"k\"/>");
  const auto check = [&](const std::string& leader, const std::string& fault) {
    const std::string message = refused(robot(links + leader + followers));
    CHECK_THAT(message, Contains(fault));
    CHECK_THAT(message, !Contains("does not exist") && !Contains("joint 'k'") && !Contains("joint 'm'"));
  };
  check(
      "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/>"
      "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/></joint>",
      "joint 'j': its limits must be finite");
  check(joint("j", "bendy", "a", "b"), "'bendy'");
  check(joint("j", "revolute", "z", "b"), "no link 'z'");
}

TEST_CASE("what cannot be a robot is refused with a reason") {
  const std::string ab = link("a") + link("b");
  CHECK_THAT(refused("hello"), Contains("small.urdf"));
  CHECK_THAT(refused(""), Contains("small.urdf"));
  CHECK_THAT(refused("<robot name=\"x\"/>"), Contains("has no links"));
  CHECK_THAT(refused("<sdf/>"), Contains("expected <robot>"));
  CHECK_THAT(refused(robot(ab)), Contains("have no parent"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "b") + joint("k", "revolute", "b", "a"))),
             Contains("form a loop"));
  CHECK_THAT(
      refused(robot(link("r") + ab + joint("j", "revolute", "a", "b") + joint("k", "revolute", "b", "a"))),
      Contains("form a loop"));
  CHECK_THAT(refused(robot(link("a") + joint("j", "fixed", "a", "a"))), Contains("form a loop"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "b") + joint("k", "revolute", "a", "b"))),
             Contains("child of two joints"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "z"))), Contains("no link 'z'"));
  const std::string arm = link("base") + link("arm");
  CHECK_THAT(refused(robot(arm + joint("j", "revolute", "base", "arn"))),
             Contains("no link 'arn'; add it or correct the name; did you mean 'arm'?"));
  CHECK_THAT(refused(robot(arm + joint("elbow", "revolute", "base", "arm", "<mimic joint=\"elbo\"/>"))),
             Contains("mimics 'elbo', which does not exist; did you mean 'elbow'?"));
  CHECK_THAT(refused(robot(ab + link("a"))), Contains("two links are named"));
  CHECK_THAT(refused(robot(ab + joint("j", "bendy", "a", "b"))), Contains("'bendy'; URDF knows fixed"));
  CHECK_THAT(refused(robot(link("a", "<plane normal=\"0 0 1\"/>"))),
             Contains("holds <plane>; give it a <box>"));
  CHECK_THAT(refused(robot(link("a", " "))), Contains("holds nothing; give it a <box>"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "b", "<axis xyz=\"0 0 0\"/>"))),
             Contains("axis"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "b", "<mimic joint=\"q\"/>"))), Contains("'q'"));
  CHECK_THAT(refused(robot(ab + joint("j", "revolute", "a", "b", "<mimic joint=\"\"/>"))),
             Contains("names no joint"));
  CHECK_THAT(refused(robot(ab + link("c") + joint("j", "revolute", "a", "b", "<mimic joint=\"k\"/>") +
                           joint("k", "revolute", "b", "c", "<mimic joint=\"j\"/>"))),
             Contains("mimics itself"));
  CHECK_THAT(refused(robot(link("a", "<sphere radius=\"-1\"/>"))), Contains("'a'"));
  CHECK_THAT(refused(robot(link("a", "<mesh filename=\"m.stl\" scale=\"1 0 1\"/>"))), Contains("scale"));
}

TEST_CASE("bombs of entities, depth and NUL bytes are refused at once") {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE robot [<!ENTITY a0 \"lol\">";
  for (int i = 1; i < 40; ++i)
    bomb += "<!ENTITY a" + std::to_string(i) + " \"&a" + std::to_string(i - 1) + ";&a" +
            std::to_string(i - 1) + ";\">";
  CHECK_THAT(refused(bomb + "]><robot name=\"&a39;\"/>"), Contains("small.urdf"));
  std::string deep = "<robot name=\"x\">";
  for (int i = 0; i < 100000; ++i) deep += "<link>";
  CHECK_THAT(refused(deep), Contains("nested deeper"));
  CHECK_THAT(refused(std::string("<robot name=\"x\">\0</robot>", 25)), Contains("NUL"));
}

TEST_CASE("a text cut short anywhere is refused or read, never a crash") {
  const std::string text =
      robot(link("a", "<box size=\"1 1 1\"/>") + link("b") + joint("j", "revolute", "a", "b"));
  for (std::size_t n = 0; n < text.size(); ++n) refused(text.substr(0, n));
  for (std::size_t n = 0; n < text.size(); ++n) {
    std::string changed = text;
    changed[n] = '"';
    refused(changed);
  }
}

TEST_CASE(
    "ten thousand links in one chain, each mimicking the joint before, are read; more than 20,000 are "
    "refused") {
  const auto chain = [](int links) {
    std::string body = link("l0");
    for (int i = 1; i < links; ++i) {
      const std::string mimic = "<mimic joint=\"j" + std::to_string(i + 1 < links ? i + 1 : i - 1) + "\"/>";
      body += link("l" + std::to_string(i));
      body += joint("j" + std::to_string(i), "revolute", "l" + std::to_string(i - 1), "l" + std::to_string(i),
                    i == links / 2 || i + 1 == links ? "" : mimic);
    }
    return body;
  };
  const RobotModel model = parse(chain(10000));
  REQUIRE(model.links.size() == 10000);
  CHECK(model.joints[0].mimic->joint == 4999);
  CHECK(model.joints[9000].mimic->joint == 9998);
  CHECK_THAT(refused(robot(chain(20001))), Contains("20001 links"));
}

TEST_CASE("package names are found in given folders, in the environment and around the URDF") {
  TemporaryFolder folder;
  put(folder / "robot.urdf", robot(link("a")));
  put(folder / "mesh.stl", "x");
  put(folder / "package.xml", "<package><name>pkg</name></package>");
  const PackagePath paths(folder / "robot.urdf");
  CHECK(paths.resolve("package://pkg/mesh.stl") == folder / "mesh.stl");
  CHECK(paths.resolve("mesh.stl") == folder / "mesh.stl");
  CHECK(paths.resolve("file://" + (folder / "mesh.stl")) == folder / "mesh.stl");
  CHECK(paths.resolve(folder / "mesh.stl") == folder / "mesh.stl");
  const PackagePath given("/somewhere/robot.urdf", {folder / ""});
  CHECK(given.resolve("package://pkg/mesh.stl") == folder / "mesh.stl");
}

TEST_CASE("names of a URDF that is a link lead beside the link, then beside the file behind it") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pkg/urdf");
  std::filesystem::create_directories(folder / "mine");
  put(folder / "pkg/package.xml", "<package><name>pkg</name></package>");
  put(folder / "pkg/urdf/robot.urdf", robot(link("a")));
  put(folder / "pkg/urdf/a.stl", "x");
  put(folder / "pkg/urdf/b.stl", "x");
  put(folder / "mine/b.stl", "another one's");
  std::filesystem::create_symlink("../pkg/urdf/robot.urdf", folder / "mine/robot.urdf");
  const PackagePath paths(folder / "mine/robot.urdf");
  CHECK(paths.resolve("a.stl") == folder / "pkg/urdf/a.stl");
  CHECK(paths.resolve("b.stl") == folder / "mine/b.stl");
  CHECK(paths.resolve("package://pkg/urdf/b.stl") == folder / "pkg/urdf/b.stl");
  put(folder / "pkg/urdf/c d.stl", "x");
  CHECK(paths.resolve("file://c%20d.stl") == folder / "pkg/urdf/c d.stl");
  CHECK(paths.folderOf("a.stl") == folder / "pkg/urdf");
  CHECK(paths.folderOf("b.stl") == folder / "mine");
  CHECK(paths.folderOf("file://c%20d.stl") == folder / "pkg/urdf");
  CHECK(paths.folderOf("none.stl") == folder / "mine");
}

TEST_CASE("names lead where their writer meant, whatever the working folder is") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pkg/meshes");
  std::filesystem::create_directories(folder / "other/meshes");
  put(folder / "pkg/package.xml", "<package><name>pkg</name></package>");
  put(folder / "pkg/meshes/a b.stl", "x");
  put(folder / "pkg/meshes/c%20d.stl", "x");
  put(folder / "pkg/meshes/e.stl", "x");
  put(folder / "other/meshes/e.stl", "another one's");
  const PackagePath paths(folder / "pkg/robot.urdf", {folder / "other"});
  const std::string meshes = folder / "pkg/meshes/";
  CHECK(paths.resolve("file://meshes/e.stl") == meshes + "e.stl");
  CHECK(paths.resolve("file://localhost" + meshes + "e.stl") == meshes + "e.stl");
  CHECK(paths.resolve("file://" + meshes + "a%20b.stl") == meshes + "a b.stl");
  CHECK(paths.resolve("package://pkg/meshes/a%20b.stl") == meshes + "a b.stl");
  CHECK(paths.resolve("package://pkg/meshes/c%20d.stl") == meshes + "c%20d.stl");
  CHECK(paths.resolve("package://pkg//meshes/e.stl") == meshes + "e.stl");
  // The other folder has the last folders of the name. The package itself has all of them.
  put(folder / "other/e.stl", "x");
  std::filesystem::create_directories(folder / "pkg/models/meshes");
  put(folder / "pkg/models/meshes/e.stl", "x");
  CHECK(paths.resolve("package://pkg/models/meshes/e.stl") == folder / "pkg/models/meshes/e.stl");
}

TEST_CASE("packages without a package.xml are found near the URDF, after all others") {
  const TemporaryFolder folder;
  for (const char* name : {"arm_description/urdf", "arm_meshes/v", "given/arm_meshes/v"})
    std::filesystem::create_directories(folder / name);
  put(folder / "arm_meshes/v/a.stl", "x");
  put(folder / "arm_meshes/v/b.stl", "x");
  put(folder / "given/arm_meshes/v/b.stl", "x");
  const PackagePath paths(folder / "arm_description/urdf/arm.urdf", {folder / "given"});
  CHECK(paths.resolve("package://arm_meshes/v/a.stl") == folder / "arm_meshes/v/a.stl");
  CHECK(paths.resolve("package://arm_meshes/v/b.stl") == folder / "given/arm_meshes/v/b.stl");
  const auto resolve = [&](const std::string& uri) { paths.resolve(uri); };
  CHECK_THAT(refusal(resolve, "package://arm_meshes/v/c.stl"), Contains(folder / "arm_meshes/v/c.stl"));
}

TEST_CASE("a package in a repository of a workspace is found where rospack finds it") {
  const TemporaryFolder folder;
  for (const char* name :
       {"repo/pkg/meshes", "repo/other/pkg", ".hidden/pkg", "off/pkg", "deep/er/two/meshes"})
    std::filesystem::create_directories(folder / "src" + ("/" + std::string(name)));
  const std::string src = folder / "src/";
  put(src + "repo/pkg/package.xml", "<package><name>pkg</name></package>");
  put(src + "repo/pkg/meshes/a.stl", "x");
  put(src + "repo/other/package.xml", "<package><name>other</name></package>");
  put(src + "off/CATKIN_IGNORE", "");
  // Inside a package, hidden, marked to be ignored.
  for (const char* none : {"repo/other/pkg", ".hidden/pkg", "off/pkg"}) {
    put(src + none + "/package.xml", "<package><name>none</name></package>");
    put(src + none + "/a.stl", "x");
  }
  put(src + "deep/er/two/package.xml", "<package><name>named otherwise</name></package>");
  put(src + "deep/er/two/meshes/b c.stl", "x");
  std::filesystem::create_directory_symlink("..", src + "repo/loop");
  ::setenv("ROS_PACKAGE_PATH", ("/none:" + src).c_str(), 1);
  const PackagePath paths("/home/robot.urdf");
  ::unsetenv("ROS_PACKAGE_PATH");
  CHECK(paths.resolve("package://pkg/meshes/a.stl") == src + "repo/pkg/meshes/a.stl");
  CHECK(paths.resolve("package://pkg//meshes/../meshes/a.stl") == src + "repo/pkg/meshes/a.stl");
  CHECK(paths.resolve("package://named%20otherwise/meshes/b%20c.stl") == src + "deep/er/two/meshes/b c.stl");
  const auto resolve = [&](const std::string& uri) { paths.resolve(uri); };
  CHECK_THAT(refusal(resolve, "package://none/a.stl"), !Contains("repo") && !Contains("off"));
  CHECK_THAT(refusal(resolve, "package://pkg/b.stl"), Contains(src + "repo/pkg/b.stl"));
}

TEST_CASE("names of another kind are refused as such") {
  const PackagePath paths("/home/robot.urdf");
  for (const char* uri : {"http://a.org/a.stl", "model://a/a.stl", "Package://a/a.stl", "package:/a/a.stl"})
    CHECK_THAT(refusal([&](const std::string& name) { paths.resolve(name); }, uri),
               Contains("not read; give one with package://"));
}

TEST_CASE("a missing file names every path that was tried") {
  ::setenv("ROS_PACKAGE_PATH", "/ros/one:/ros/two", 1);
  ::setenv("AMENT_PREFIX_PATH", "/ament", 1);
  const PackagePath paths("/home/robot.urdf", {"/given"});
  const std::string message =
      refusal([&](const std::string& uri) { paths.resolve(uri); }, "package://pkg/meshes/a.stl");
  ::unsetenv("ROS_PACKAGE_PATH");
  ::unsetenv("AMENT_PREFIX_PATH");
  for (const char* tried : {"/given/pkg/meshes/a.stl", "/ros/one/pkg/meshes/a.stl",
                            "/ros/two/pkg/meshes/a.stl", "/ament/share/pkg/meshes/a.stl", "--package-path"})
    CHECK_THAT(message, Contains(tried));
}

TEST_CASE("an SRDF's enabled pairs win, then its disabled ones, then its links without defaults") {
  Srdf srdf;
  srdf.enabled = {{"a", "b", ""}, {"e", "a", ""}};
  srdf.disabled = {{"b", "a", "Never"}, {"b", "c", "Adjacent"}, {"c", "b", "Never"}, {"e", "b", "Never"}};
  srdf.defaultsOff = {"e"};
  const SkipReasons reasons(&srdf), none(nullptr);
  const auto of = [&](const char* one, const char* other) {
    CHECK(reasons.of(one, other) == reasons.of(other, one));
    CHECK(none.of(one, other).empty());
    return reasons.of(one, other);
  };
  CHECK(of("a", "b").empty());
  CHECK(of("b", "c") == "Adjacent");
  CHECK(of("a", "c").empty());
  CHECK(of("a", "e").empty());
  CHECK(of("b", "e") == "Never");
  CHECK(of("c", "e") == "User");
}

TEST_CASE("an SRDF's reasons count in any case and with blanks around them") {
  TemporaryFolder folder;
  const RobotModel model = parse(link("a") + link("b") + joint("j", "revolute", "a", "b"));
  const auto entry = [](const std::string& reason) {
    return "<robot name=\"small\"><disable_collisions link1=\"a\" link2=\"b\" reason=\"" + reason +
           "\"/></robot>";
  };
  const std::pair<const char*, const char*> reasons[] = {
      {"never", "Never"},      {"NEVER", "Never"}, {"Never ", "Never"}, {"\tadjacent", "Adjacent"},
      {"ALWAYS", "Always"},    {"user ", "User"},  {"", "User"},        {"  ", "User"},
      {"too near", "too near"}};
  for (const auto& [written, counts] : reasons) {
    put(folder / "s.srdf", entry(written));
    const Srdf srdf = loadSrdf(folder / "s.srdf", model);
    CHECK(SkipReasons(&srdf).of("a", "b") == counts);
    // Pairs that the user left out stay.
    const bool stays = withPairs(folder / "s.srdf", "small", {}).find("link1") != std::string::npos;
    CHECK(stays == (counts == std::string("User")));
  }
}

TEST_CASE("an SRDF gives pairs, states and the way the base moves") {
  TemporaryFolder folder;
  const RobotModel model = parse(link("a") + link("b") + joint("j", "revolute", "a", "b"));
  put(folder / "s.srdf",
      "<robot name=\"small\"><virtual_joint name=\"v\" type=\"floating\" parent_frame=\"w\" "
      "child_link=\"a\"/>"
      "<disable_collisions link1=\"b\" link2=\"a\" reason=\"Adjacent\"/>"
      "<group_state name=\"up\" group=\"g\"><joint name=\"j\" value=\"0.5\"/></group_state></robot>");
  const Srdf srdf = loadSrdf(folder / "s.srdf", model);
  CHECK(SkipReasons(&srdf).of("a", "b") == "Adjacent");
  CHECK(srdf.baseType == "floating");
  CHECK(srdf.state("up").joints.at("j")[0] == 0.5);
  CHECK_THAT(refusal([&](const std::string& name) { srdf.state(name); }, "down"), Contains("up"));
  put(folder / "t.srdf", "<robot name=\"small\"><virtual_joint name=\"v\" type=\"floatin\"/></robot>");
  CHECK_THROWS_WITH(loadSrdf(folder / "t.srdf", model),
                    Contains("'floatin'; SRDF knows fixed, planar, floating"));
}

TEST_CASE("the virtual joint of the root link moves the base, others are ignored with a warning") {
  TemporaryFolder folder;
  const RobotModel model = parse(link("root") + link("a") + link("b") + joint("f", "fixed", "root", "a") +
                                 joint("j", "revolute", "a", "b"));
  const auto virtualJoint = [](const std::string& name, const std::string& child) {
    return "<virtual_joint name=\"" + name + "\" type=\"floating\" parent_frame=\"w\" child_link=\"" + child +
           "\"/>";
  };
  const auto state = [](const std::string& name, const std::string& joint, const std::string& value) {
    return "<group_state name=\"" + name + "\" group=\"g\"><joint name=\"" + joint + "\" value=\"" + value +
           "\"/></group_state>";
  };
  put(folder / "s.srdf", "<robot name=\"small\">" + virtualJoint("of_b", "b") + virtualJoint("of_a", "a") +
                             virtualJoint("too", "root") + state("away", "of_a", "5 0 1 0 0 0 1") +
                             state("turned", "of_a", "0 0 0 0 0 1 0") +
                             state("home", "of_a", "0 0 0 0 0 0 1") +
                             state("other", "of_b", "5 0 1 0 0 0 1") + "</robot>");
  const Srdf srdf = loadSrdf(folder / "s.srdf", model);
  CHECK(srdf.baseJoint == "of_a");
  REQUIRE(srdf.warnings.size() == 2);
  CHECK_THAT(srdf.warnings[0], Contains("'of_b'") && Contains("root link 'root'"));
  CHECK_THAT(srdf.warnings[1], Contains("'too'") && Contains("'of_a' carries the root link"));
  for (const char* moved : {"away", "turned"}) CHECK(srdf.movesBase(srdf.state(moved)));
  for (const char* still : {"home", "other"}) CHECK_FALSE(srdf.movesBase(srdf.state(still)));
}

TEST_CASE("misspelt names in an SRDF are reported with the nearest name") {
  const TemporaryFolder folder;
  put(folder / "small.urdf", robot(link("base") + link("arm") + joint("elbow", "revolute", "base", "arm")));
  const RobotModel model = loadUrdf(folder / "small.urdf");
  put(folder / "s.srdf",
      "<robot name=\"small\"><disable_collisions link1=\"bas\" link2=\"arm\"/>"
      "<group_state name=\"folded\" group=\"g\"><joint name=\"elbow_jnt\" value=\"1\"/>"
      "<joint name=\"wrist\" value=\"1\"/></group_state></robot>");
  const Srdf srdf = loadSrdf(folder / "s.srdf", model);
  REQUIRE(srdf.warnings.size() == 2);
  CHECK_THAT(srdf.warnings[0], Contains("no link 'bas'; did you mean 'base'?"));
  CHECK_THAT(srdf.warnings[1], Contains("'elbow_jnt' (did you mean 'elbow'?), 'wrist'."));
  CHECK_THROWS_WITH(srdf.state("foldet"), Contains("'foldet'; there are: folded; did you mean 'folded'?"));
}

TEST_CASE("new pairs replace old ones in an SRDF and leave the user's own alone") {
  TemporaryFolder folder;
  put(folder / "s.srdf",
      "<robot name=\"small\"><group name=\"g\"/><disable_collisions link1=\"a\" link2=\"b\" "
      "reason=\"Never\"/>"
      "<disable_collisions link1=\"a\" link2=\"c\" reason=\"User\"/></robot>");
  const std::string text = withPairs(folder / "s.srdf", "small", {{"b", "c", "Adjacent"}});
  CHECK_THAT(text, Contains("<group name=\"g\"") && Contains("reason=\"User\"") && Contains("Adjacent") &&
                       !Contains("Never"));
  CHECK_THAT(withPairs("", "small", {{"b", "c", "Adjacent"}}), Contains("<robot name=\"small\">"));
}

TEST_CASE("line ends and tabs in the names of links are references in an SRDF, and read as the same names") {
  TemporaryFolder folder;
  put(folder / "s.srdf",
      "<robot name=\"small\"><!-- two\nlines --><group name=\"g&#9;h\">\n<link name=\"a\"/></group></robot>");
  const std::vector<std::string> names{"a", "x\ny", "x\ty", "x\ry", "x &#10; & < \"y"};
  RobotModel model = parse(link("a"));
  for (const std::string& name : names) model.links.push_back({name, {}, {}, -1, 0, "", {0, 0, 0}});
  std::vector<Srdf::Pair> pairs;
  for (std::size_t i = 1; i < names.size(); ++i) pairs.push_back({"a", names[i], "Never"});
  const std::string text = withPairs(folder / "s.srdf", "small", pairs);
  for (const char* part : {"x&#10;y", "x&#9;y", "x&#13;y", "g&#9;h", "<!-- two\nlines -->"})
    CHECK_THAT(text, Contains(part));
  put(folder / "new.srdf", text);
  const Srdf srdf = loadSrdf(folder / "new.srdf", model);
  CHECK(srdf.warnings.empty());
  REQUIRE(srdf.disabled.size() == pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) CHECK(srdf.disabled[i].link2 == pairs[i].link2);
  CHECK(withPairs(folder / "new.srdf", "small", pairs) == text);
}

TEST_CASE(
    "an SRDF keeps what the user disabled without a reason, and what is enabled is not disabled again") {
  TemporaryFolder folder;
  put(folder / "s.srdf",
      "<robot name=\"small\"><enable_collisions link1=\"c\" link2=\"b\"/>"
      "<disable_collisions link1=\"a\" link2=\"c\" reason=\"\"/>"
      "<disable_collisions link1=\"a\" link2=\"d\"/></robot>");
  const std::string text =
      withPairs(folder / "s.srdf", "small", {{"a", "b", "Never"}, {"b", "c", "Adjacent"}});
  CHECK_THAT(text, Contains("link1=\"a\" link2=\"c\"") && Contains("link1=\"a\" link2=\"d\"") &&
                       Contains("Never") && !Contains("Adjacent"));
}

TEST_CASE("an SRDF's text around the pairs stays as it is, and a second run changes nothing") {
  TemporaryFolder folder;
  const RobotModel model = parse(link("a") + link("b") + link("c") + joint("j", "revolute", "a", "b") +
                                 joint("k", "revolute", "b", "c"));
  const std::vector<Srdf::Pair> pairs{{"a", "b", "Adjacent"}, {"a", "c", "Never"}, {"b", "c", "Adjacent"}};
  const auto run = [&](const std::string& text) {
    put(folder / "s.srdf", text);
    const Srdf srdf = loadSrdf(folder / "s.srdf", model);
    return withPairs(&srdf, "small", pairs, {"left out -- one"});
  };
  const std::string entry = "<disable_collisions link1=\"a\" link2=\"c\"";
  const std::string other = "\t<disable_collisions link1='a' link2='gripper'  reason='Never' />\n";
  const std::string head = "<?xml version='1.0'?>\n<!-- <robot> -->\n<robot  name='small'>\n";
  const std::string text = run(head + "    " + entry + " reason=\"Never\"/>\n" + other + "  " + entry +
                               " />\n\n</robot>\n<!-- end -->\n");
  CHECK_THAT(text, Catch::StartsWith(head + other + "  " + entry + " />\n\n    <!-- left out ~- one -->\n") &&
                       Catch::EndsWith("\n</robot>\n<!-- end -->\n"));
  CHECK(text.find(entry, text.find(entry) + 1) == std::string::npos);  // the user's entry is enough
  CHECK(run(text) == text);
  std::string windows = text;
  for (std::size_t i = 0; (i = windows.find('\n', i)) != std::string::npos; i += 2)
    windows.insert(i, 1, '\r');
  CHECK(run(windows) == windows);
  const std::string small = run("<robot name=\"small\" />");
  CHECK_THAT(small, Catch::StartsWith("<robot name=\"small\" >\n") && Catch::EndsWith("/>\n</robot>"));
  CHECK(run(small) == small);
  const std::string oneLine =
      run("<robot name=\"small\">" + entry + " reason=\"Never\"></disable_collisions></robot>");
  CHECK(run(oneLine) == oneLine);
}

TEST_CASE("a posture of several groups is taken whole, and nothing of it is left out without a word") {
  TemporaryFolder folder;
  const std::string mimic = joint("m", "revolute", "b", "c", "<mimic joint=\"j\" multiplier=\"2\"/>");
  const auto model = std::make_shared<const RobotModel>(parse(link("a") + link("b") + link("c") + link("d") +
                                                              joint("j", "revolute", "a", "b") + mimic +
                                                              joint("k", "revolute", "a", "d")));
  const auto srdfOf = [&](const std::string& states) {
    put(folder / "s.srdf", "<robot name=\"small\">" + states + "</robot>");
    return loadSrdf(folder / "s.srdf", *model);
  };
  const auto state = [](const char* name, const std::string& joint, const char* value) {
    return std::string("<group_state name=\"") + name + "\" group=\"of_" + joint + "\"><joint name=\"" +
           joint + "\" value=\"" + value + "\"/></group_state>";
  };
  const Srdf srdf = srdfOf(state("home", "j", "0.2") + state("home", "k", "0.3") + state("odd", "j", "0.2") +
                           state("odd", "j", "0.3") + state("typo", "jj", "1") +
                           state("follows", "m", "0.4") + state("still", "m", "0"));
  const Kinematics kinematics(model);
  const Eigen::VectorXd home = kinematics.configuration(srdf.state("home"));
  CHECK(home[kinematics.coordinate("j")] == 0.2);
  CHECK(home[kinematics.coordinate("k")] == 0.3);
  CHECK_THAT(refusal([&](const std::string& name) { srdf.state(name); }, "odd"), Contains("'j'"));
  CHECK_THAT(refusal([&](const std::string& name) { srdf.state(name); }, "hom"), Contains("home, home, odd"));
  std::vector<std::string> names;
  for (const Srdf::State& each : srdf.allStates()) {
    names.push_back(each.name);
    CHECK(each.joints == srdf.state(each.name).joints);
  }
  // the two states named "odd" contradict each other.
  CHECK(names == std::vector<std::string>{"home", "typo", "follows", "still"});
  REQUIRE(srdf.warnings.size() == 1);
  CHECK_THAT(srdf.warnings[0], Contains("'typo'") && Contains("'jj'"));
  CHECK(kinematics.configuration(srdf.state("still")) == kinematics.neutral());
  CHECK_THAT(
      refusal([&](const std::string& name) { kinematics.configuration(srdf.state(name), Eigen::VectorXd()); },
              "still"),
      Contains("the rest has 0 values"));
  const auto taken = [&](const std::string& name) { kinematics.configuration(srdf.state(name)); };
  CHECK_THAT(refusal(taken, "follows"), Contains("'m'") && Contains("follows 'j'"));
  Srdf::State both = srdf.state("follows");
  both.joints["j"] = {0.2};
  CHECK(kinematics.configuration(both)[kinematics.coordinate("j")] == 0.2);
  put(folder / "r.urdf", robot(link("a") + link("b") + joint("j", "revolute", "a", "b")));
  CHECK_THAT(refusal([&](const std::string& path) { loadSrdf(path, *model); }, folder / "r.urdf"),
             Contains("is a URDF"));
}

TEST_CASE("a joint that follows a continuous joint at another speed reaches all of its positions") {
  const auto leader = [&](const std::string& type, const std::string& ratio) {
    const RobotModel model =
        parse(link("a") + link("b") + link("c") + joint("j", "continuous", "a", "b") +
              joint("m", type, "a", "c", "<mimic joint=\"j\" multiplier=\"" + ratio + "\"/>"));
    return std::pair(model.joints[0].lower, model.joints[0].upper);
  };
  for (const char* whole : {"1", "-1", "3", "0"})
    CHECK(leader("continuous", whole) == std::pair(-M_PI, M_PI));
  CHECK(leader("continuous", "0.5") == std::pair(-2 * M_PI, 2 * M_PI));
  CHECK(leader("revolute", "-0.333333") == std::pair(-3 * M_PI, 3 * M_PI));
  CHECK(leader("continuous", "0.7") == std::pair(-10 * M_PI, 10 * M_PI));
  CHECK(leader("continuous", "0.314159265") == std::pair(-1e6, 1e6));  // never comes back to the start
  CHECK(leader("continuous", "9e-6") == std::pair(-1e6, 1e6));         // not within 64 turns
  // A rack with the limits -1 and 1 (urdf_texts.h).
  CHECK(leader("prismatic", "0.02") == std::pair(-50.0, 50.0));
  CHECK(leader("prismatic", "5") == std::pair(-M_PI, M_PI));
  // Two racks, and a wheel that never comes back: as far as all limits allow, and at least half a turn in
  // both directions.
  const auto rack = [](const std::string& name, const std::string& lower, const std::string& upper,
                       const std::string& ratio) {
    return "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"a\"/><child link=\"" + name +
           "\"/><limit lower=\"" + lower + "\" upper=\"" + upper +
           "\" effort=\"1\" velocity=\"1\"/><mimic joint=\"j\" multiplier=\"" + ratio + "\"/></joint>" +
           link(name);
  };
  const auto range = [&](const std::string& racks) {
    const RobotModel screw =
        parse(link("a") + link("b") + link("c") + joint("j", "continuous", "a", "b") +
              joint("w", "continuous", "a", "c", "<mimic joint=\"j\" multiplier=\"0.314159265\"/>") + racks);
    return std::pair(screw.joints[0].lower, screw.joints[0].upper);
  };
  CHECK(range(rack("r", "0", "0.5", "0.03125")) == std::pair(-M_PI, 16.0));
  CHECK(range(rack("r", "-1", "0.5", "0.03125") + rack("s", "-0.25", "10", "-0.5")) ==
        std::pair(-20.0, M_PI));
  CHECK(range(rack("r", "-1", "0.5", "0.03125") + rack("s", "0", "0", "0.5")) == std::pair(-32.0, 16.0));
  CHECK(range(rack("r", "-1e16", "1e16", "0.01")) == std::pair(-1e6, 1e6));
  // The common multiple of many followers: 2^6 and the primes to 61 have a product of 1e23.
  std::string gears = link("a") + link("b") + joint("j", "continuous", "a", "b");
  for (const int teeth : {64, 61, 59, 53, 47, 43, 41, 37, 31, 29, 23, 19, 17, 13, 11, 7, 5, 3}) {
    const std::string name = "g" + std::to_string(teeth);
    gears += link(name) + joint("m" + name, "continuous", "a", name,
                                "<mimic joint=\"j\" multiplier=\"" + std::to_string(1.0 / teeth) + "\"/>");
  }
  const RobotModel model = parse(gears);
  CHECK((model.joints[0].lower == -1e6 && model.joints[0].upper == 1e6));
}
