// Single elements of a URDF, read by urdfdom one by one: an error in one does not affect the others.
#pragma once

#include <tinyxml2.h>
#include <urdf_model/joint.h>
#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>

namespace fcl_stpbv::detail {

/// Reads a `<collision>`, or a `<visual>` in its place. Only its `<origin>` and `<geometry>` count. A capsule
/// is returned as a cylinder, because this urdfdom does not know capsules.
/// @throws Error saying what is wrong, without the element's place.
urdf::CollisionSharedPtr readShapeElement(const tinyxml2::XMLElement& shape);

/// ShapeModel::place of a shape: the `number`th `use` ("collision" or "visual") of
/// its link, from 1. `path` is the URDF's.
std::string shapePlace(const tinyxml2::XMLElement& shape, const std::string& path, const std::string& link,
                       const char* use, int number);

/// Reads an `<inertial>`. @throws as above.
urdf::InertialSharedPtr readInertialElement(const tinyxml2::XMLElement& inertial);

/// Reads a `<joint>`, except its name and links. @throws as above.
urdf::JointSharedPtr readJointElement(const tinyxml2::XMLElement& joint);

/// Whether a length or a position is finite, and at most kLargestValue.
bool isUsable(const Eigen::Vector3d& v);
Eigen::Vector3d toEigen(const urdf::Vector3& v);
/// @throws Error where it is not usable.
Eigen::Isometry3d toEigen(const urdf::Pose& pose);

}  // namespace fcl_stpbv::detail
