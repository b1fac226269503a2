// Loads robot, SRDF, scene and posture for a tool, and gathers what is wrong
// with any of them into one message.
#include "fcl_stpbv/report/robot_files.h"

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/posture/mimic_limits.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/load_warnings.h"
#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::report {
namespace {

using namespace detail;

constexpr char kLargerR[] = "give a larger --R, or take the primitives as they are (--primitives flat)";

// Nothing can be said about a robot or a scene if no shape of it was loaded, least of all that it is clear.
void requireBodies(const RobotModel& robot, const RobotGeometry& geometry, bool visual,
                   const std::vector<std::string>& leftOut) {
  if (geometry.bodies.empty() && !geometry.incomplete.empty())
    throw Error(robot.path + ": no shape could be read, so that nothing can be checked; the first one: " +
                leftOut.front());
  if (geometry.bodies.empty())
    throw Error(robot.path + ": no link has a shape that could be checked; give a URDF with " +
                (visual ? "<visual> shapes, or leave out --visual where only <collision> ones are there"
                        : "<collision> shapes, or --visual where only the visual ones are there"));
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// All pairs that any posture or task may have to keep apart. Pairs that only samples would leave out are
// among them, because sampling needs the bodies first.
std::vector<CheckedPair> pairsToCover(const Kinematics& kinematics, const RobotGeometry& bodies,
                                      const Srdf* srdf, std::size_t obstacles) {
  std::vector<CheckedPair> pairs = selfPairs(kinematics.robot(), bodies, srdf);
  const std::vector<CheckedPair> around =
      obstaclePairs(kinematics.robot(), bodies, obstacles, kinematics.baseMoves());
  pairs.insert(pairs.end(), around.begin(), around.end());
  return pairs;
}

}  // namespace

RobotLoader::RobotLoader(RobotFiles files) : files_(std::move(files)), sceneOptions_(files_.geometry) {
  sceneOptions_.links.clear();  // these name the robot's links
  sceneOptions_.budgets.clear();
  sceneOptions_.advice.reset();  // large obstacles should rather be flat (docs/choosing_r_and_R.md)
  sceneOptions_.flatLinks.clear();
  sceneOptions_.flat = files_.flatObstacles;
}

void RobotLoader::read() {
  robot_ = std::make_shared<const RobotModel>(loadUrdf(files_.urdf, faults_));
  if (faults_.errors.empty()) kinematics_ = std::make_shared<const Kinematics>(robot_, files_.base);
  shapes_ = readGeometry(*robot_, files_.geometry, faults_);
  if (!files_.srdf.empty()) {
    LoadFaults::gather(faults_.errors, [&] {
      srdf_ = std::make_shared<const Srdf>(loadSrdf(files_.srdf, *robot_, faults_));
    });
  }
  if (files_.obstacles.empty()) return;
  LoadFaults scene;  // kept apart, because whether visual shapes are taken depends on these faults
  LoadFaults::gather(faults_.errors, [&] {
    scene_ = std::make_shared<const RobotModel>(loadUrdf(files_.obstacles, scene));
    sceneShapes_ = readGeometry(*scene_, sceneOptions_, scene);
  });
  append(faults_.errors, scene.errors);
  append(faults_.shapes, scene.shapes);
  append(faults_.warnings, scene.warnings);
}

void RobotLoader::build() {
  faults_.refuse(files_.skipInvalid);
  RobotGeometry bodies = buildGeometry(*robot_, files_.geometry, shapes_, faults_), around;
  if (scene_) around = buildGeometry(*scene_, sceneOptions_, sceneShapes_, faults_);
  faults_.refuse(files_.skipInvalid);
  requireBodies(*robot_, bodies, files_.geometry.visual, faults_.shapes);
  if (scene_) requireBodies(*scene_, around, files_.geometry.visual, faults_.shapes);
  requireRoomForPairs(*kinematics_, bodies, around.bodies.size());
  if (!files_.flatPrimitives)
    coverPrimitives(pairsToCover(*kinematics_, bodies, srdf_.get(), around.bodies.size()), bodies, &around);
  geometry_ = std::make_shared<const RobotGeometry>(std::move(bodies));
  sceneGeometry_ = std::make_shared<const RobotGeometry>(std::move(around));
}

std::vector<Obstacle> RobotLoader::obstacles() const {
  return scene_ ? obstaclesOf(scene_, *sceneGeometry_) : std::vector<Obstacle>{};
}

std::vector<std::string> RobotLoader::meshFiles() const {
  std::vector<std::string> files;
  for (const auto& geometry : {geometry_, sceneGeometry_})
    for (const Body& body : geometry->bodies)
      if (!body.file.empty()) files.push_back(body.file);
  return files;
}

std::vector<std::string> RobotLoader::warnings() const {
  std::vector<std::string> all = faults_.warnings;
  if (srdf_) append(all, srdf_->warnings);
  if (srdf_ && !files_.writesPairs) append(all, leavesOutNone(*robot_, *geometry_, *srdf_));
  append(all, stillJoints(*robot_));
  append(all, impossibleMimics(*kinematics_));
  if (scene_) append(all, stillObstacles(*scene_));
  append(all, raisedR(*robot_, *geometry_, files_.geometry, kLargerR));
  if (scene_) append(all, raisedR(*scene_, *sceneGeometry_, sceneOptions_, kLargerR));
  append(all, geometry_->warnings);
  append(all, sceneGeometry_->warnings);
  return all;
}

}  // namespace fcl_stpbv::report
