// --neutral, --pose and --trajectory, read in this order: a pose may leave joints out, which stay neutral.
// Values beyond the joint limits give a warning.
#include "fcl_stpbv/report/asked_postures.h"

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/report/named_posture.h"
#include "fcl_stpbv/report/trajectory_file.h"

namespace fcl_stpbv::report {

AskedPostures readPostures(const ReportRequest& request, const Kinematics& kinematics, const Srdf* srdf) {
  AskedPostures postures{kinematics.neutral(), std::nullopt, {}, {}};
  const auto posture = [&](const char* option, const std::string& name) {
    return namedPosture(option, name, kinematics, srdf, postures.neutral, !request.files.obstacles.empty());
  };
  const auto warn = [&](const std::string& warning) {
    if (!warning.empty()) postures.warnings.push_back(warning);
  };
  const auto warnOfLimits = [&](const std::string& name, const std::vector<Eigen::VectorXd>& list) {
    warn(limitWarning(name, list, kinematics, "what the pair list proves holds within the limits"));
  };
  if (!request.neutral.empty()) {
    postures.neutral = posture("--neutral", request.neutral);
    warnOfLimits("--neutral " + request.neutral, {postures.neutral});
  }
  if (!request.pose.empty()) {
    postures.asked = posture("--pose", request.pose);
    warnOfLimits("--pose " + request.pose, {*postures.asked});
  }
  if (!request.trajectory.empty()) {
    postures.trajectory = readTrajectory(request.trajectory, kinematics, postures.neutral);
    const std::string name = "--trajectory " + request.trajectory;
    warnOfLimits(name, postures.trajectory.points);
    warn(turnWarning(name, postures.trajectory, kinematics));
    if (postures.trajectory.start != 0)
      warn(name + ": times count from its first one, " + detail::toDecimal(postures.trajectory.start) + " s");
  }
  return postures;
}

}  // namespace fcl_stpbv::report
