// Runs a method on all situations in a child process. So the others continue even if the method ends the
// process or never returns.
#pragma once

#include <vector>

#include "test/reference/stability/contestant.h"

namespace fcl_stpbv::stability {

/// The answers to each placement of each situation. After an abort or a hang the rest of that situation stays
/// `none` and a new child goes on with the next. A query counts as hanging after `seconds` of processor time,
/// so a busy machine is not mistaken for a slow method.
std::vector<std::vector<Answer>> answersOf(const Method& method, const std::vector<Situation>& situations,
                                           double seconds = 2);

}  // namespace fcl_stpbv::stability
