// Inputs that are whole in form and wrong in substance; see structured.cpp.
#pragma once

#include <string>

#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

/// A robot: every <collision> is in the model or it is refused.
std::string randomRobot(test::Random& random);
void checkRobot(const std::string& text, const std::string& folder);
/// A .stpbv file: what is loaded holds its vertices.
std::string randomVolume(test::Random& random);
void checkVolume(const std::string& text, const std::string& folder);
/// A task: what is set up has a finite start.
std::string randomTask(test::Random& random);
void checkTask(const std::string& text, const std::string& folder);
/// q and qd of a small robot: rows, rates and Hessians hold no NaN, and none
/// reads as clear without an answer.
std::string randomPosture(test::Random& random);
void checkPosture(const std::string& text, const std::string& folder);

}  // namespace fcl_stpbv::fuzz
