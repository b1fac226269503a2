// Single elements of a URDF, read by urdfdom one by one: an error in one does not affect the others.
#pragma once

#include <tinyxml2.h>
#include <urdf_model/joint.h>
#include <urdf_model/link.h>

namespace fcl_stpbv::detail {

/// A `<collision>`, or a `<visual>` in its place: only its `<origin>` and `<geometry>` count. A capsule,
/// newer than this urdfdom, comes as a cylinder.
/// @throws Error saying what is wrong, without the element's place.
urdf::CollisionSharedPtr readShapeElement(const tinyxml2::XMLElement& shape);

/// An `<inertial>`. @throws as above.
urdf::InertialSharedPtr readInertialElement(const tinyxml2::XMLElement& inertial);

/// A `<joint>`, all but its name and links. @throws as above.
urdf::JointSharedPtr readJointElement(const tinyxml2::XMLElement& joint);

}  // namespace fcl_stpbv::detail
