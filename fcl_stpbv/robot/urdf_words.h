// Errors in a URDF that urdfdom silently ignores: misspelt names, duplicates, shapes in the wrong place.
#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Checks a `<collision>` or `<visual>`: one geometry of one shape, at most one origin, and no attribute or
/// element that may be a misspelt one. Names with a prefix (`drake:...`) are other tools' own, and so is an
/// attribute of an element that has all of URDF's that move or shape a body.
/// @throws Error saying what is wrong, without the element's place.
void checkShapeWords(const tinyxml2::XMLElement& shape);

/// Checks a `<joint>` in the same way.
void checkJointWords(const tinyxml2::XMLElement& joint);

/// A link's `<inertial>`, or an element with an unknown name but the contents of one; null if there is none.
const tinyxml2::XMLElement* inertialOf(const tinyxml2::XMLElement& link);

/// Checks what inertialOf() found in the same way as a joint.
void checkInertialWords(const tinyxml2::XMLElement& inertial);

/// Finds elements in the wrong place: `<collision>` and `<geometry>` where they have no effect, shapes such
/// as `<box>` outside of a geometry, and an `<origin>` directly in a link. The contents of `<gazebo>` (for
/// the simulator) and `<self_filter>` are ignored. Also finds names in a link that are similar to
/// `<collision>` or `<visual>`. A geometry, a shape or such a name in a link is added to `faults.shapes`,
/// everything else to `faults.errors`. `incomplete` receives the links of the former that may lack a shape.
/// @returns the number of `<collision>` elements of links.
int checkPlaces(const tinyxml2::XMLElement& robot, const std::string& path, LoadFaults& faults,
                std::set<const tinyxml2::XMLElement*>& incomplete);

}  // namespace fcl_stpbv::detail
