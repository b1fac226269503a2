// What the builder, its self-check and the measures make of a cloud, against a
// check that shares no code with them.
#pragma once

#include <string>

#include "test/fuzz/clouds.h"

namespace fcl_stpbv::fuzz {

/// Empty where the cloud builds, verify() is content, the over-cover is measured and checkBallHull() agrees;
/// else what is wrong.
std::string complaintAbout(const CloudCase& c, test::Random& random);

}  // namespace fcl_stpbv::fuzz
