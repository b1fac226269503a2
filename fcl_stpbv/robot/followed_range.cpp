// Computes the range of a continuous joint that others mimic. Its range is the number of turns after which
// all followers are back where they were: the least common multiple of their numbers of turns. If prismatic
// joints follow, the range is what the limits of all of these allow.
#include "fcl_stpbv/robot/followed_range.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

// Number of the leader's turns after which a joint that follows it at `ratio` is back where it was; 0 if
// there are too many.
int turnsOf(double ratio) {
  constexpr int kMostTurns = 64;
  constexpr double kOff = 1e-5;  // tolerance for decimals such as 0.333333
  for (int turns = 1; turns <= kMostTurns; ++turns) {
    const double whole = std::round(turns * ratio);
    if (whole != 0 && std::abs(turns * ratio - whole) <= kOff) return turns;
  }
  return 0;
}

}  // namespace

void widenFollowed(std::vector<JointModel>& joints) {
  struct Leader {
    long turns = 1;  // 0: no common number of turns
    bool slides = false;
    double low = -kInfinity, high = kInfinity;  // range that all prismatic followers allow
  };
  std::map<int, Leader> leaders;
  for (const JointModel& follower : joints) {
    if (!follower.mimic || follower.mimic->multiplier == 0) continue;
    if (joints[at(follower.mimic->joint)].type != JointType::continuous) continue;
    Leader& leader = leaders[follower.mimic->joint];
    const auto [ratio, offset] = std::pair(follower.mimic->multiplier, follower.mimic->offset);
    if (follower.type == JointType::prismatic) {
      if (follower.lower == follower.upper) continue;  // the joint is left out, or its limits are not known
      const auto [low, high] =
          std::minmax({(follower.lower - offset) / ratio, (follower.upper - offset) / ratio});
      leader.slides = true;
      leader.low = std::max(leader.low, low);
      leader.high = std::min(leader.high, high);
    } else {
      leader.turns = std::lcm(leader.turns, static_cast<long>(turnsOf(ratio)));       // 0 stays 0
      if (kPi * static_cast<double>(leader.turns) > kLargestValue) leader.turns = 0;  // before it overflows
    }
  }
  for (auto& [index, leader] : leaders) {
    if (!leader.slides || leader.low > leader.high) {
      leader.high = leader.turns > 0 ? kPi * static_cast<double>(leader.turns) : kLargestValue;
      leader.low = -leader.high;
    }
    JointModel& joint = joints[at(index)];
    joint.lower = std::max(std::min(joint.lower, leader.low), -kLargestValue);
    joint.upper = std::min(std::max(joint.upper, leader.high), kLargestValue);
  }
}

}  // namespace fcl_stpbv::detail
