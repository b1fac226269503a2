// Resolves chains of mimic joints.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "fcl_stpbv/robot/near_name.h"
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// A joint as the URDF writes it.
struct Follower {
  std::string joint;
  std::string mimics;  ///< the joint it follows, "" for none
  double multiplier = 1, offset = 0;
};

/// Finds the joint at the end of each chain. Every joint is visited once, however long the chains are.
class MimicChains {
 public:
  explicit MimicChains(std::vector<Follower> joints);

  /// The rule that gives the value of a joint from the value of the joint at its chain's end. For a joint
  /// that follows none, its own value.
  /// @throws Error if the chain has no end. The message does not contain the joint's place.
  Mimic end(std::size_t joint);

  /// The name at the joint's chain's end, if no joint has it; "" if one has, or if the chain is a loop.
  std::string missing(std::size_t joint);

 private:
  enum class State { open, entered, done };

  void follow(std::size_t joint);
  void tie(std::size_t joint);

  std::vector<Follower> joints_;
  std::vector<int> next_;  // index of the joint that is followed, -1 for none
  std::vector<Mimic> end_;
  std::vector<State> state_;
  FirstProposals proposals_;
};

}  // namespace fcl_stpbv::detail
