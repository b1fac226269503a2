// Loads robot, SRDF, scene and posture for a tool, and gathers what is wrong with any of them into one
// message.
#include "fcl_stpbv/report/robot_files.h"

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::report {
namespace {

using namespace detail;

// Nothing can be said about a robot of which nothing was loaded, least of all that it is clear.
void requireBodies(const RobotModel& robot, const RobotGeometry& geometry) {
  if (geometry.bodies.empty())
    throw Error(robot.path +
                ": no link has a shape that could be checked; give a URDF with <collision> shapes" +
                ", or --visual where only the visual ones are there");
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

void RobotLoader::read() {
  robot_ = std::make_shared<const RobotModel>(loadUrdf(files_.urdf, faults_));
  shapes_ = readGeometry(*robot_, files_.geometry, faults_);
  if (!files_.srdf.empty()) {
    LoadFaults::gather(faults_.errors, [&] {
      srdf_ = std::make_shared<const Srdf>(loadSrdf(files_.srdf, *robot_, faults_));
    });
  }
  if (files_.obstacles.empty()) return;
  LoadFaults scene;  // apart: whether visual shapes are taken depends on it
  LoadFaults::gather(faults_.errors, [&] {
    scene_ = std::make_shared<const RobotModel>(loadUrdf(files_.obstacles, scene));
    sceneShapes_ = readGeometry(*scene_, files_.sceneGeometry, scene);
  });
  append(faults_.errors, scene.errors);
  append(faults_.shapes, scene.shapes);
  append(faults_.warnings, scene.warnings);
}

void RobotLoader::build() {
  faults_.refuse(files_.skipInvalid);
  geometry_ =
      std::make_shared<const RobotGeometry>(buildGeometry(*robot_, files_.geometry, shapes_, faults_));
  if (scene_) sceneGeometry_ = buildGeometry(*scene_, files_.sceneGeometry, sceneShapes_, faults_);
  faults_.refuse(files_.skipInvalid);
  requireBodies(*robot_, *geometry_);
  if (scene_) requireBodies(*scene_, sceneGeometry_);
}

std::vector<std::string> RobotLoader::warnings() const {
  std::vector<std::string> all;
  for (const std::string& shape : skipped()) all.push_back("left out and not checked: " + shape);
  append(all, faults_.warnings);
  if (srdf_) append(all, srdf_->warnings);
  append(all, geometry_->warnings);
  append(all, sceneGeometry_.warnings);
  return all;
}

}  // namespace fcl_stpbv::report
