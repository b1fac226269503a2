// Checks the builder, its self-check and the measures for a cloud, by code that shares nothing with them.
#pragma once

#include <string>

#include "test/fuzz/clouds.h"

namespace fcl_stpbv::fuzz {

/// Empty if the cloud builds, verify() succeeds, the over-cover is measured and checkBallHull() agrees;
/// otherwise what is wrong.
std::string complaintAbout(const CloudCase& c, test::Random& random);

}  // namespace fcl_stpbv::fuzz
