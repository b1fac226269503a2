// All faults of a robot's files are reported at once, by name and line, and do not affect anything else.
#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

const std::string kBox = "<collision><geometry><box size=\"1 1 1\"/></geometry></collision>";

std::size_t shapesIn(const std::string& insideLink) {
  return parseUrdf(robot("<link name=\"a\">" + insideLink + "</link>"), "small.urdf")
      .links[0]
      .collision.size();
}

}  // namespace

TEST_CASE("a fault outside of collision shapes removes no collision shape") {
  for (const char* broken :
       {"<visual/>", "<visual><geometry/></visual>",
        "<visual><geometry><mesh filename=\"m.stl\" scale=\"1\"/></geometry></visual>",
        "<visual><geometry><box size=\"1 1 1\"/></geometry><material/></visual>", "<inertial/>",
        "<inertial><mass value=\"heavy\"/></inertial>", "<material/>", "<contact><stiffness/></contact>"}) {
    CAPTURE(broken);
    CHECK(shapesIn(broken + kBox + kBox) == 2);
    CHECK(shapesIn(kBox + broken + kBox) == 2);
  }
}

TEST_CASE("an inertial that cannot be read is a warning and known to the link") {
  const std::string inertia = "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>";
  const auto link = [&](const std::string& inertial, LoadFaults& faults) {
    return parseUrdf(robot("<link name=\"a\"><inertial>" + inertial + inertia + "</inertial></link>"),
                     "small.urdf", faults)
        .links[0];
  };
  for (const char* wrong :
       {"", "<mass/>", "<mas value=\"1\"/>", "<mass value=\"5kg\"/>", "<mass value=\"5,0\"/>",
        "<mass value=\"nan\"/>", "<mass value=\"inf\"/>", "<mass value=\"-1\"/>", "<mass value=\"\"/>",
        "<mass value=\"1\"/><origin xyz=\"1 2\"/>", "<mass value=\"1\"/><origin xyz=\"0 nan 0\"/>",
        "<mass value=\"1\"/><origin xzy=\"0 1 0\"/>", "<mass value=\"1\"/><orign xyz=\"0 1 0\"/>"}) {
    CAPTURE(wrong);
    LoadFaults faults;
    const LinkModel read = link(wrong, faults);
    CHECK(read.mass == 0);
    CHECK_THAT(read.massFault, Contains("small.urdf:") && Contains("link 'a'"));
    REQUIRE(faults.warnings.size() == 1);
    CHECK_THAT(faults.warnings[0], Contains("link 'a' counts as without mass"));
  }
  LoadFaults faults;
  const LinkModel sound = link("<mass value=\"5\"/><origin xyz=\"0 1 0\"/>", faults);
  CHECK(sound.mass == 5);
  CHECK(sound.centreOfMass == Eigen::Vector3d(0, 1, 0));
  CHECK((sound.massFault.empty() && faults.warnings.empty()));
}

TEST_CASE("a misspelt <inertial> is a warning and no link without mass") {
  const std::string mass = "<mass value=\"5\"/>";
  LoadFaults faults;
  const RobotModel model = parseUrdf(robot("<link name=\"a\"><gazebo>" + mass + "</gazebo><x:y>" + mass +
                                           "</x:y><inertal>" + mass + "</inertal></link>"),
                                     "small.urdf", faults);
  CHECK_THAT(model.links[0].massFault, Contains("<inertal>"));
  REQUIRE(faults.warnings.size() == 1);
  CHECK_THAT(faults.warnings[0], Contains("small.urdf:") && Contains("misspelt <inertial>"));
}

TEST_CASE("each collision element that is lost is named, with its line") {
  const std::string text =
      robot("\n<link name=\"a\">\n" + kBox +
            "\n<collision/>\n<collision><geometry/></collision>"
            "\n<collision><geometry><box size=\"1 1\"/></geometry></collision>"
            "\n<collision><geometry><sphere radius=\"0\"/></geometry></collision>"
            "\n<collision><geometry><mesh filename=\"m\" scale=\"1\"/></geometry></collision>"
            "\n<collision><origin xyz=\"0 0\"/><geometry><sphere radius=\"1\"/></geometry></collision>"
            "\n<collision><geometry><sphere radius=\"1\"/><sphere radius=\"2\"/></geometry></collision>"
            "\n</link>");
  const std::string message = refused(text);
  for (int i = 2; i <= 8; ++i)
    CHECK_THAT(message, Contains("small.urdf:" + std::to_string(i + 3) + ": link 'a', collision " +
                                 std::to_string(i)));
  CHECK_THAT(message, Contains("7 things are wrong") && Contains("has no <geometry>"));
}

TEST_CASE("words that look misspelt are refused, those of other tools are not") {
  const std::string box = "<geometry><box size=\"1 1 1\"/></geometry>";
  CHECK_THAT(refused(robot(link("a", "<mesh filename=\"m\" scael=\"1 1 1\"/>"))), Contains("'scael'"));
  CHECK_THAT(
      refused(robot("<link name=\"a\"><collision><orign xyz=\"0 0 1\"/>" + box + "</collision></link>")),
      Contains("<orign>"));
  CHECK_THAT(refused(robot("<link name=\"a\"><colision>" + box + "</colision></link>")),
             Contains("<colision>"));
  CHECK_THAT(refused(robot("<link name=\"a\"><origin xyz=\"0 0 1\"/>" + kBox + "</link>")),
             Contains("<origin> within <link>"));
  CHECK_THAT(refused(robot("<lnk name=\"a\"><collision>" + box + "</collision></lnk>" + link("b"))),
             Contains("<lnk>"));
  CHECK(shapesIn("<collision concave=\"yes\" x:y=\"1\"><x:proximity/><contact/>" + box + "</collision>") ==
        1);
  CHECK(parseUrdf(robot(link("a") + "<gazebo><collision><geometry/></collision></gazebo>"), "g.urdf")
            .links.size() == 1);
  CHECK(shapesIn(kBox + "<self_filter>" + box + "</self_filter><x:filter>" + box + "</x:filter>") == 1);
}

TEST_CASE("an element that would move a body, but stands where it does nothing, is refused") {
  const std::string origin = "<origin xyz=\"0.1 0 0\"/>", axis = "<axis xyz=\"0 1 0\"/>",
                    limit = "<limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"1\"/>";
  const auto shape = [](const std::string& inGeometry, const std::string& inBox = "") {
    return robot("<link name=\"a\"><collision><geometry><box size=\"1 1 1\">" + inBox + "</box>" +
                 inGeometry + "</geometry></collision></link>");
  };
  const auto joint = [](const std::string& inOrigin, const std::string& inChild, const std::string& inAxis) {
    return robot(link("a") + link("b") + "<joint name=\"j\" type=\"continuous\"><origin xyz=\"0 0 1\">" +
                 inOrigin + "</origin><parent link=\"a\"/><child link=\"b\">" + inChild +
                 "</child><axis xyz=\"0 0 1\">" + inAxis + "</axis></joint>");
  };
  for (const std::string& text : {shape(origin), shape("", origin), shape(limit), joint(axis, "", ""),
                                  joint("", origin, ""), joint("", "", origin), robot(link("a") + origin),
                                  robot(link("a") + axis), robot(link("a") + limit)}) {
    CAPTURE(text);
    CHECK_THAT(refused(text), Contains("it belongs into a <"));
  }
  for (const std::string& text : {shape(""), joint("", "", ""), joint("<origin xyz=\"0 0 0\"/>", "", ""),
                                  robot(link("a") + "<ros2_control><joint name=\"j\">" + limit + axis +
                                        "</joint></ros2_control><transmission>" + "<joint name=\"j\">" +
                                        limit + "</joint></transmission><sensor>" + origin + "</sensor>")})
    CHECK(parseUrdf(text, "fine.urdf").links.size() >= 1);
}

TEST_CASE("a link or a joint within a link is refused") {
  const std::string joint =
      "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>";
  for (const std::string& inner : {link("b"), joint, std::string("<link name=\"b\"/>") + joint}) {
    CAPTURE(inner);
    CHECK_THAT(refused(robot("<link name=\"a\">" + kBox + inner + "</link>")),
               Contains("it belongs into <robot>"));
  }
}

TEST_CASE("an origin without an offset is accepted in any place") {
  const auto jointWith = [](const std::string& element) {
    return robot(link("a") + link("b") +
                 "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/>" + element +
                 "</joint>");
  };
  for (const char* zeros : {"xyz=\"0 0 0\"", "xyz=\"0.0 -0 +0.\" rpy=\"0 0 0\"", ""}) {
    CAPTURE(zeros);
    CHECK(shapesIn(std::string("<origin ") + zeros + "/>" + kBox) == 1);
    CHECK(parseUrdf(jointWith(std::string("<anchor ") + zeros + "/>"), "small.urdf").joints.size() == 1);
  }
  for (const char* moves : {"xyz=\"0 0 1\"", "xyz=\"0 0 0\" rpy=\"0 1e-9 0\"", "xyz=\"a b c\""}) {
    CAPTURE(moves);
    CHECK_THAT(refused(robot(std::string("<link name=\"a\"><origin ") + moves + "/>" + kBox + "</link>")),
               Contains("<origin> within <link>"));
    CHECK_THAT(refused(jointWith(std::string("<anchor ") + moves + "/>")), Contains("misspelt <origin>"));
  }
  CHECK_THAT(refused(robot("<link name=\"a\"><origin xzy=\"0 0 0\"/>" + kBox + "</link>")),
             Contains("<origin> within <link>"));
}

TEST_CASE("another tool's attribute is let pass where none of URDF's is missing") {
  const auto jointWith = [](const std::string& limit, const std::string& type = "revolute") {
    return robot(link("a") + link("b") + "<joint name=\"j\" type=\"" + type +
                 "\"><parent link=\"a\"/><child link=\"b\"/><limit " + limit + "/></joint>");
  };
  const RobotModel model =
      parseUrdf(jointWith("lower=\"-1\" upper=\"2\" effort=\"3\" velocity=\"4\" current=\"5\""), "a.urdf");
  CHECK(model.joints[0].lower == -1);
  CHECK(model.joints[0].upper == 2);
  CHECK_THAT(refused(jointWith("lowr=\"-1\" upper=\"2\" effort=\"3\" velocity=\"4\"")), Contains("'lowr'"));
  CHECK_THAT(refused(jointWith("upper=\"2\" effort=\"3\" velocity=\"4\" current=\"5\"")),
             Contains("'current'"));
  // What cannot be a range, and what is beside a whole one or on a joint that has none, has no effect.
  CHECK(parseUrdf(jointWith("upper=\"2\" k_velocity=\"3\""), "a.urdf").joints[0].upper == 2);
  CHECK(parseUrdf(jointWith("lower=\"-1\" upper=\"2\" velocty=\"3\""), "a.urdf").joints[0].lower == -1);
  CHECK(parseUrdf(jointWith("effort=\"1\" gear=\"3\"", "continuous"), "a.urdf").joints.size() == 1);
  CHECK_THAT(refused(jointWith("lower=\"-1\" uper=\"2\" velocity=\"4\"")), Contains("did you mean 'upper'?"));
  CHECK_THAT(refused(jointWith("min=\"-1\" max=\"2\" k_velocity=\"4\"", "prismatic")), Contains("'min'"));
  CHECK_THAT(refused(jointWith("soft_lower_limit=\"-1\" velocity=\"4\"")), Contains("'soft_lower_limit'"));
  CHECK(shapesIn("<collision><geometry><box size=\"1 1 1\" colour=\"red\"/></geometry></collision>") == 1);
  CHECK_THAT(refused(robot(link("a", "<mesh filename=\"m\" convex=\"yes\"/>"))), Contains("'convex'"));
}

TEST_CASE("a geometry in an element of unknown name costs a shape, which may be left out") {
  const std::string text = robot(
      "<link name=\"a\"><colision><geometry><box size=\"1 1 1\"/></geometry></colision>" + kBox + "</link>");
  LoadFaults faults;
  const RobotModel model = parseUrdf(text, "small.urdf", faults);
  CHECK(faults.errors.empty());
  REQUIRE(faults.shapes.size() == 1);
  CHECK_THAT(faults.shapes[0], Contains("<colision>") && Contains("misspelt"));
  CHECK(model.links[0].collision.size() == 1);
}

TEST_CASE("a shape whose collision and geometry are both misspelt is not lost without a word") {
  for (const char* shape : {"<colision><geometri><box size=\"1 1 1\"/></geometri></colision>",
                            "<Collision><Geometry><mesh filename=\"m.stl\"/></Geometry></Collision>",
                            "<colision><sphere radius=\"1\"/></colision>", "<sphere radius=\"1\"/>",
                            "<colision><geometri><mesh file=\"m.stl\"/></geometri></colision>",
                            "<set><colision><geometri><box size=\"1 1 1\"/></geometri></colision></set>"}) {
    CAPTURE(shape);
    LoadFaults faults;
    const RobotModel model =
        parseUrdf(robot("<link name=\"a\">" + kBox + shape + "</link>"), "small.urdf", faults);
    CHECK(faults.errors.empty());
    REQUIRE(faults.shapes.size() == 1);
    CHECK_THAT(faults.shapes[0], Contains("small.urdf:") && Contains("where no robot has one"));
    CHECK(model.links[0].collision.size() == 1);
  }
  CHECK_THAT(refused(robot(link("a") + "<lnk name=\"b\"><colision><geometri><box size=\"1 1 1\"/></geometri>"
                                       "</colision></lnk>")),
             Contains("<geometri> misspelt"));
  CHECK(shapesIn(kBox + "<box/><sensor><mesh/></sensor><x:c><box size=\"1 1 1\"/></x:c>") == 1);
}

TEST_CASE("a name in a link that is nearly <collision> costs a shape, whatever it holds") {
  for (const char* shape : {"<collison/>", "<Collision/>", "<colision name=\"f\"/>", "<collisions/>",
                            "<visul/>", "<Collision><Geometry><Box size=\"1 1 1\"/></Geometry></Collision>",
                            "<collison><geometri><bx size=\"1 1 1\"/></geometri></collison>"}) {
    CAPTURE(shape);
    LoadFaults faults;
    const RobotModel model =
        parseUrdf(robot("<link name=\"a\">" + kBox + "\n" + shape + "</link>"), "small.urdf", faults);
    CHECK(faults.errors.empty());
    REQUIRE(faults.shapes.size() == 1);
    CHECK_THAT(faults.shapes[0], Contains("small.urdf:3: <") && Contains("misspelt <"));
    CHECK(model.links[0].collision.size() == 1);
  }
  CHECK(shapesIn(kBox + "<collision_checking/><contact/><virtual/><x:collison/><sensor/>") == 1);
  CHECK(shapesIn(kBox + "<collision_checking><capsule name=\"forearm\"/></collision_checking>") == 1);
}

TEST_CASE("a misspelt <joint> is named where a link is left without a parent") {
  CHECK_THAT(
      refused(robot(link("a") + link("b") +
                    "\n<jiont name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></jiont>")),
      Contains("'a' and 'b'") && Contains("<jiont> in line 3"));
}

TEST_CASE("tabs and line ends between the numbers of a vector count as spaces, as XML has it") {
  const RobotModel model = parseUrdf(
      robot("<link name=\"a\"><collision><origin xyz=\"1\t2\n3\" rpy=\"0\t0 0\"/><geometry>"
            "<box size=\"1\r\n2\t3\"/></geometry></collision></link>" +
            link("b") + joint("j", "revolute", "a", "b", "<origin xyz=\"0\t0 1\"/><axis xyz=\"0\n1\t0\"/>")),
      "small.urdf");
  CHECK(model.links[0].collision.at(0).size == Eigen::Vector3d(1, 2, 3));
  CHECK(model.links[0].collision.at(0).pose.translation() == Eigen::Vector3d(1, 2, 3));
  CHECK(model.joints.at(0).origin.translation() == Eigen::Vector3d(0, 0, 1));
  CHECK(model.joints.at(0).axis == Eigen::Vector3d(0, 1, 0));
  CHECK_THAT(refused(robot(link("a", "<box size=\"1\t2\"/>"))), Contains("3 expected"));
}

TEST_CASE("control characters in names are refused by line and name, as XML has none") {
  CHECK_THAT(refused("<robot name=\"r\">\n" + link("a&#x1;b") + "</robot>"),
             Contains("small.urdf:2: the 'name' of <link>, 'a?b', has a control character"));
  CHECK_THAT(refused(robot(link("a") + "<material name=\"m\x02\"/>")), Contains("of <material>, 'm?'"));
  CHECK(parseUrdf(robot(link("a&#9;&#10;&#13;b")), "small.urdf").links[0].name == "a\t\n\rb");
}

TEST_CASE("xacro is told by its elements and attributes, not by comments, texts or a bare declaration") {
  const auto accepted = [](const std::string& body) {
    parseUrdf(body, "small.urdf");
    return true;
  };
  CHECK(accepted("<robot name=\"r\" xmlns:xacro=\"http://ros.org/wiki/xacro\">" + link("a") + "</robot>"));
  CHECK(accepted(robot("<!-- <xacro:macro name=\"m\"/> ${x} -->" + link("a"))));
  CHECK(accepted(robot("<gazebo><![CDATA[<xacro:if value=\"${x}\"/>]]></gazebo>" + link("a"))));
  CHECK(accepted(robot("<gazebo reference=\"a\"><plugin filename=\"$(find x)\"/></gazebo>" + link("a"))));
  CHECK_THAT(refused(robot("\n<xacro:include filename=\"x\"/>" + link("a"))),
             Contains(":3: ") && Contains("xacro"));
  CHECK_THAT(
      refused("<robot name=\"r\" xmlns:x=\"http://ros.org/wiki/xacro\"><x:macro/>" + link("a") + "</robot>"),
      Contains("<x:macro> is xacro"));
  CHECK_THAT(refused(robot(link("a", "<sphere radius=\"${r}\"/>"))), Contains("xacro"));
  CHECK_THAT(refused(robot(link("a", "<mesh filename=\"$(find x)/m.stl\"/>"))), Contains("xacro"));
}

TEST_CASE("all faults of a robot are reported at once, before a volume is built") {
  const TemporaryFolder folder;
  put(folder / "good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
  put(folder / "bad.obj", "no mesh");
  put(folder / "r.urdf",
      robot(link("a", "<mesh filename=\"good.obj\"/>") + link("b", "<sphere radius=\"0\"/>") +
            link("c", "<mesh filename=\"missing.obj\"/>") + link("d", "<mesh filename=\"bad.obj\"/>") +
            "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>"
            "<limit lower=\"1\" upper=\"-1\"/></joint>" +
            joint("k", "bendy", "a", "c") + joint("l", "fixed", "a", "d")));
  put(folder / "r.srdf",
      "<robot name=\"small\">\n<group_state name=\"s\"><joint name=\"j\" "
      "value=\"x\"/></group_state></robot>");
  LoadFaults faults;
  const RobotModel model = loadUrdf(folder / "r.urdf", faults);
  loadSrdf(folder / "r.srdf", model, faults);
  GeometryOptions options;
  options.cacheFolder.clear();
  options.progress = [](std::size_t, std::size_t, const std::string&) { FAIL("a volume is built"); };
  options.budgets["nobody"] = 1;
  readGeometry(model, options, faults);
  const std::string message = refusal([&](const std::string&) { faults.refuse(); }, "");
  for (const char* part : {"7 things are wrong", "link 'b', collision 1", "missing.obj: no such file",
                           "bad.obj", "joint 'j'", "limits", "bendy", "r.srdf:2", "'nobody'"})
    CHECK_THAT(message, Contains(part));
}

TEST_CASE("a joint that needs limits and has none is told so by its name") {
  const auto told = [](const std::string& type) {
    return refused(robot(link("a") + link("b") + "\n<joint name=\"turn\" type=\"" + type +
                         "\"><parent link=\"a\"/><child link=\"b\"/></joint>"));
  };
  CHECK_THAT(told("revolute"), Contains("small.urdf:3") &&
                                   Contains("joint 'turn': is revolute and needs a <limit>") &&
                                   Contains("make it continuous") && !Contains("REVOLUTE"));
  CHECK_THAT(told("prismatic"), Contains("small.urdf:3") &&
                                    Contains("joint 'turn': is prismatic and needs a <limit>") &&
                                    !Contains("continuous"));
  CHECK(told("continuous").empty());
}

TEST_CASE("what an SRDF holds within another element is ignored, with a warning") {
  const TemporaryFolder folder;
  const RobotModel model =
      parseUrdf(robot(link("a") + link("b") + joint("j", "revolute", "a", "b")), "small.urdf");
  const std::string pair = " link1=\"a\" link2=\"b\"";
  const auto read = [&](const std::string& entries) {
    put(folder / "s.srdf", "<robot name=\"small\">\n" + entries + "</robot>");
    return loadSrdf(folder / "s.srdf", model);
  };
  for (const std::string inner : {"disable_collisions", "enable_collisions"})
    for (const std::string& around :
         {std::string("group"), "disable_collisions" + pair, "enable_collisions" + pair}) {
      const std::string name = around.substr(0, around.find(' '));
      const Srdf srdf = read("<" + around + ">\n<" + inner + pair + "/></" + name + ">");
      CAPTURE(inner, around);
      REQUIRE(srdf.warnings.size() == 1);
      CHECK_THAT(srdf.warnings[0],
                 Contains("s.srdf:3") && Contains("<" + inner + "> within <" + name + "> is ignored"));
      CHECK(srdf.disabled.size() == (name == "disable_collisions"));
      CHECK(srdf.enabled.size() == (name == "enable_collisions"));
    }
  CHECK_THAT(read("<group name=\"g\"><disable_colisions" + pair + "/></group>").warnings.at(0),
             Contains("misspelt"));
  CHECK(read("<group name=\"g\"><group name=\"h\"/><joint name=\"j\"/><chain base_link=\"a\" "
             "tip_link=\"b\"/></group>")
            .warnings.empty());
}

TEST_CASE("each value of a joint in a group_state must be a number to its end") {
  const TemporaryFolder folder;
  const RobotModel model =
      parseUrdf(robot(link("a") + link("b") + joint("j", "revolute", "a", "b")), "small.urdf");
  const auto read = [&](const std::string& value) {
    put(folder / "s.srdf", "<robot name=\"small\"><group_state name=\"s\"><joint name=\"j\" value=\"" +
                               value + "\"/></group_state></robot>");
    LoadFaults faults;
    loadSrdf(folder / "s.srdf", model, faults);
    return faults.errors.size();
  };
  for (const char* sound : {"0.5", " -5e-1 ", "+0.5"}) CHECK(read(sound) == 0);
  for (const char* broken : {"", "0.5 1e999", "0.5 -", "0.5 1e", "0.5 .", "5e-1.", "0,5", "nan", "0.5x"}) {
    INFO(broken);
    CHECK(read(broken) == 1);
  }
  CHECK(read("0.5\"/><joint name=\"k\" value=\"1") == 0);
  put(folder / "s.srdf",
      "<robot name=\"small\"><group_state name=\"s\"><joint name=\"j\" value=\"1\"/>\n<joint name=\"j\" "
      "value=\"1\"/></group_state></robot>");
  CHECK_THAT(refusal([&](const std::string& path) { loadSrdf(path, model); }, folder / "s.srdf"),
             Contains("s.srdf:2") && Contains("'s'") && Contains("names the joint 'j' twice"));
}

TEST_CASE("entries of an SRDF for links that the robot does not have are ignored with a warning") {
  const TemporaryFolder folder;
  const RobotModel model =
      parseUrdf(robot(link("a") + link("b") + joint("j", "revolute", "a", "b")), "small.urdf");
  put(folder / "s.srdf",
      "<robot name=\"large\">\n<disable_collisions link1=\"a\" link2=\"z\"/>\n"
      "<disable_collision link1=\"a\" link2=\"b\"/>\n<group name=\"g\"/></robot>");
  const Srdf srdf = loadSrdf(folder / "s.srdf", model);
  CHECK(srdf.disabled.empty());
  REQUIRE(srdf.warnings.size() == 3);
  CHECK_THAT(srdf.warnings[0], Contains("s.srdf:1") && Contains("'large'") && Contains("'small'"));
  CHECK_THAT(srdf.warnings[1], Contains("s.srdf:2") && Contains("is ignored") && Contains("'z'"));
  CHECK_THAT(srdf.warnings[2], Contains("s.srdf:3") && Contains("<disable_collision>") &&
                                   Contains("is ignored") && Contains("misspelt <disable_collisions>"));
}

TEST_CASE("visual shapes that are wrong matter only where they are used") {
  const RobotModel model =
      parseUrdf(robot("<link name=\"a\">" + kBox +
                      "<visual><geometry><sphere radius=\"0\"/></geometry></visual></link>"),
                "v.urdf");
  GeometryOptions options;
  CHECK(loadGeometry(model, options).bodies.size() == 1);
  options.visual = true;
  CHECK_THAT(refusal([&](const std::string&) { loadGeometry(model, options); }, ""), Contains("visual 1"));
}

TEST_CASE(
    "a configuration that is not finite gives pessimistic rows without NaN, status invalid, and false") {
  const auto model = std::make_shared<const RobotModel>(parseUrdf(
      robot(link("a", "<sphere radius=\"0.1\"/>") + link("b") + link("c", "<sphere radius=\"0.1\"/>") +
            joint("j", "revolute", "a", "b") + joint("k", "prismatic", "b", "c", "<origin xyz=\"1 0 0\"/>")),
      "small.urdf"));
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  CollisionConstraints constraints(kinematics, geometry, {{0, 1}});
  Eigen::VectorXd d(1), q = kinematics->neutral();
  auto jacobian = constraints.makeJacobian();
  CHECK(constraints.evaluate(q, d, jacobian));
  CHECK(d[0] == Approx(0.8));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    q[1] = bad;
    CHECK_FALSE(constraints.evaluate(q, d, jacobian));
    CHECK(d[0] == std::numeric_limits<double>::lowest());
    CHECK(Eigen::MatrixXd(jacobian).isZero(0));
    CHECK(constraints.answer(0).status == DistanceStatus::invalid);
    Eigen::MatrixXd dense(1, 2);
    CHECK_FALSE(constraints.evaluate(q, d, dense));
    CHECK(dense.isZero(0));
  }
}
