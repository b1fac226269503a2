// Inputs with a valid form but wrong contents; see structured.cpp.
#pragma once

#include <string>

#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

/// A robot. Property: every <collision> is in the model, or the robot is refused.
std::string randomRobot(test::Random& random);
void checkRobot(const std::string& text, const std::string& folder);
/// A .stpbv file. Property: a loaded volume contains its vertices.
std::string randomVolume(test::Random& random);
void checkVolume(const std::string& text, const std::string& folder);
/// A task. Property: a task that is set up has a finite start.
std::string randomTask(test::Random& random);
void checkTask(const std::string& text, const std::string& folder);
/// q and qd of a small robot. Property: rows, rates and Hessians contain no NaN, and no row without an answer
/// counts as clear.
std::string randomPosture(test::Random& random);
void checkPosture(const std::string& text, const std::string& folder);

}  // namespace fcl_stpbv::fuzz
