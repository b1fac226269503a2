// What urdfdom does not check: the tree of names, and words newer than it.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fcl_stpbv {

/// A link's name and the index of its collision element.
using CapsuleNames = std::set<std::pair<std::string, int>>;

/// A URDF whose links form one tree.
struct CheckedUrdf {
  std::string xml;                  ///< written anew: urdfdom never sees the file's own bytes
  std::vector<std::string> links;   ///< parents before their children
  std::vector<std::string> joints;  ///< in the order of the file
  CapsuleNames capsules;            ///< written as cylinders, which this urdfdom knows
};

/// @throws Error naming the file and the link or joint at fault.
CheckedUrdf checkUrdf(const std::string& text, const std::string& path);

}  // namespace fcl_stpbv
