// Errors in a URDF that urdfdom silently ignores: misspelt names, duplicates, shapes in the wrong place.
#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Checks a `<collision>` or `<visual>`: one geometry of one shape, at most one origin, and no attribute or
/// element that may be a misspelt one. Names with a prefix (`drake:...`) are other tools' own, and so is an
/// attribute of an element that has all of URDF's.
/// @throws Error saying what is wrong, without the element's place.
void checkShapeWords(const tinyxml2::XMLElement& shape);

/// Checks a `<joint>` in the same way.
void checkJointWords(const tinyxml2::XMLElement& joint);

/// A link's `<inertial>`, or an element of an unknown name that holds what one does; null without.
const tinyxml2::XMLElement* inertialOf(const tinyxml2::XMLElement& link);

/// Checks what inertialOf() found in the same way as a joint.
void checkInertialWords(const tinyxml2::XMLElement& inertial);

/// Finds `<collision>` and `<geometry>` where no robot has them, and boxes and the like outside of any
/// geometry, and an `<origin>` right in a link, but for those in `<gazebo>`, whose content is the
/// simulator's, and `<self_filter>`. Finds names in a link that are nearly `<collision>` or `<visual>`,
/// whatever they hold. A geometry, a box or such a name in a link is an entry of `faults.shapes`, all else of
/// `faults.errors`; `incomplete` gets the links of the former, where it may be a shape of theirs.
/// @returns the number of `<collision>` elements of links.
int checkPlaces(const tinyxml2::XMLElement& robot, const std::string& path, LoadFaults& faults,
                std::set<const tinyxml2::XMLElement*>& incomplete);

}  // namespace fcl_stpbv::detail
