// See task_marks.h. The errors come from the solver's own rows.
#include "fcl_stpbv/report/task_marks.h"

#include <cmath>

namespace fcl_stpbv::report {

TaskMarks marksOf(const PostureTask& task, const Kinematics& kinematics, const Eigen::VectorXd& q) {
  TaskMarks marks;
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(q, state);
  const auto poseOf = [&](const std::string& link) {
    return state.link[static_cast<std::size_t>(kinematics.robot().link(link))];
  };
  for (const PostureTask::Place& place : task.placements) {
    Placement placement = place.placement;
    placement.link = kinematics.robot().link(place.link);
    TargetMark mark{placement.name, placement.target, poseOf(place.link) * placement.frame};
    PlacementRows rows(kinematics, placement);
    Eigen::VectorXd values(rows.size());
    RowMatrix jacobian = RowMatrix::Zero(rows.size(), kinematics.size());
    rows.evaluate({q, state}, values, jacobian);
    int row = 0;
    for (std::size_t k = 0; k < placement.free.size(); ++k) {
      if (placement.free[k]) continue;
      double& sum = k < 3 ? mark.off : mark.turned;
      sum = std::hypot(sum, values[row++]);
      mark.turns |= k >= 3;
    }
    marks.targets.push_back(std::move(mark));
  }
  for (const PostureTask::Touch& touch : task.contacts) {
    ContactMark mark{touch.link, {}};
    for (const Eigen::Vector3d& point : touch.points) mark.points.push_back(poseOf(touch.link) * point);
    marks.contacts.push_back(std::move(mark));
  }
  return marks;
}

}  // namespace fcl_stpbv::report
