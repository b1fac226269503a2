// Small arms that cannot move all rows of a placement, and tasks for them.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/posture/find_posture.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

/// Joints a, b, c about parallel axes and links of 0.6, 0.4 and 0.3 m. The end of the last one is the link
/// `tip`. The arm is in the plane of x and z; `mount` is another origin in URDF.
PostureScene planarArm(const std::string& mount = "rpy='0 0 0'");

/// Joints a, b, d about z and c along it: x and y by links of 0.4 m, z within 0.2 m of 0.1, link `tool`.
PostureScene scara();

/// The arm in the plane of x and z, with a joint that would turn it out of there but is fixed by its limits.
PostureScene armWithFixedJoint(double angle);

/// Only the link `base`.
PostureScene block();

/// A robot with bodies and its obstacles, from URDFs. Without the second text there are no obstacles.
PostureScene bodiesOf(const std::string& robot, const std::string& obstacles = "");
/// A link that is a ball of 5 cm and 1 kg, this far along x.
std::string ball(const std::string& name, double x = 0);
/// A joint of a URDF. `more` contains origin, axis, limits and what it mimics.
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more);

/// The pose of a link at q.
Eigen::Isometry3d poseOf(const PostureScene& scene, const Eigen::VectorXd& q, const std::string& link);

/// A random configuration within the limits.
Eigen::VectorXd randomWithin(const PostureScene& scene, Random& random);

/// A placement of a link's whole pose.
PostureTask::Place wholePose(const std::string& link, const Eigen::Isometry3d& target);
/// A placement of a link's position. `name` is the link's name unless it is given.
PostureTask::Place position(const std::string& link, const Eigen::Vector3d& target,
                            const std::string& name = "");

/// The posture found for an arm on a fixed base, without collisions.
Posture found(const PostureScene& scene, const std::vector<PostureTask::Place>& places,
              const PostureOptions& options = {});

}  // namespace fcl_stpbv::test
