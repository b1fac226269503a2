// Trajectories in files: names in quotes, and the warning about way points whose angles were wrapped, as the
// checked motion is the long way.
#include <catch2/catch.hpp>
#include <fstream>
#include <memory>

#include "fcl_stpbv/report/trajectory_file.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::report;
using test::joint;
using test::link;
using test::TemporaryFolder;

namespace {

std::string saidOf(const std::string& type, const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const Kinematics kinematics(std::make_shared<const RobotModel>(
      parseUrdf(test::robot(link("a") + link("b") + joint("j", type, "a", "b")), "small.urdf")));
  Trajectory trajectory;
  trajectory.points = {from, from, to};
  return turnWarning("way.csv", trajectory, kinematics);
}

Eigen::VectorXd of(double angle) { return Eigen::VectorXd::Constant(1, angle); }

/// The last way point of a file way.csv of this text, for a robot of two joints of these names.
Eigen::VectorXd lastPoint(const std::string& text, const std::string& first, const std::string& second) {
  const TemporaryFolder folder;
  const std::string path = folder / "way.csv";
  std::ofstream(path) << text;
  const Kinematics kinematics(std::make_shared<const RobotModel>(
      parseUrdf(test::robot(link("a") + link("b") + link("c") + joint(first, "revolute", "a", "b") +
                            joint(second, "revolute", "b", "c")),
                "small.urdf")));
  return readTrajectory(path, kinematics, Eigen::VectorXd::Zero(2)).points.back();
}

}  // namespace

TEST_CASE("a turn by more than half a turn between two way points is told, with where the short one ends") {
  const std::string said = saidOf("continuous", of(3.1), of(-3.1));
  CHECK(said.find("way.csv: way point 2 (from 0): 'j' turns by -6.2 rad") == 0);
  CHECK(said.find("this longer rotation is checked, not the short one, which would end at 3.18318") !=
        std::string::npos);
  CHECK(saidOf("planar", Eigen::Vector3d(0, 0, -3), Eigen::Vector3d(5, 9, 3))
            .find("'j/angle' turns by 6 rad") != std::string::npos);
}

TEST_CASE("a floating joint's rotation vector that was kept within half a turn is told") {
  Eigen::VectorXd from(6), to(6);
  from << 9, 0, 0, 0, 0.6 * 3.1, 0.8 * 3.1;
  to << 0, 0, 0, 0, -0.6 * 3.1, -0.8 * 3.1;
  const std::string said = saidOf("floating", from, to);
  CHECK(said.find("way.csv: way point 2 (from 0): 'j' turns by 6.2 rad") == 0);
  CHECK(said.find("end at 0, 1.90991") != std::string::npos);  // 2 pi - 3.1 along the axis
  to.tail(3) << 3, 0, 0;  // as long, but about another axis: nearer than after another whole turn
  CHECK(saidOf("floating", from, to).empty());
  to.tail(3).setZero();
  CHECK(saidOf("floating", from, to).empty());
}

TEST_CASE("half a turn, a long slide and a joint with limits are nothing to tell") {
  CHECK(saidOf("continuous", of(0), of(-3.14159265)).empty());
  CHECK(saidOf("planar", Eigen::Vector3d(0, -9, 0), Eigen::Vector3d(9, 9, 1)).empty());
  CHECK(saidOf("revolute", of(-4), of(4)).empty());
}

TEST_CASE("a name with line feeds is read in quotes, and lines are counted with them") {
  const auto read = [](const std::string& text) { return lastPoint(text, "x&#10;y", "l&#10;&quot;"); };
  CHECK(read("\n\"x\ny\",\"l\n\"\"\"\n0,0\n0.5,0.25\n") == Eigen::Vector2d(0.5, 0.25));
  CHECK_THROWS_WITH(read("\n\"x\ny\",\"l\n\"\"\"\n0,0\n1\n"), Catch::Contains("way.csv:6: has 1 values"));
  CHECK_THROWS_WITH(read("\"x,l\n0,0\n1,1\n"), Catch::Contains("no moving joint '\"x'"));
}

TEST_CASE("names in quotes are read as CSV files quote them") {
  const auto read = [](const std::string& text) { return lastPoint(text, "x,y", "l&quot;r"); };
  CHECK(read("\"x,y\",\"l\"\"r\"\n0,0\n0.5,0.25\n") == Eigen::Vector2d(0.5, 0.25));
  CHECK(read(" \"l\"\"r\" ,\t\"x,y\" \r\n\"0\",0\r\n0.5, \"0.25\" \r\n") == Eigen::Vector2d(0.25, 0.5));
  CHECK(read("l\"r,\"x,y\"\n0,0\n0.5,0.25") == Eigen::Vector2d(0.25, 0.5));
  CHECK_THROWS_WITH(read("\"x,y,l\"\"r\n0,0\n1,1\n"), Catch::Contains("the first line names 3"));
  CHECK_THROWS_WITH(read("\"x,y\"z,\"l\"\"r\"\n0,0\n1,1\n"), Catch::Contains("no moving joint"));
}
