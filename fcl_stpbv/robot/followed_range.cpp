// A continuous joint that others mimic: its range is as many turns as bring all followers back to where they
// were, the least common multiple of each one's, and where a prismatic joint follows, what that one's limits
// allow.
#include "fcl_stpbv/robot/followed_range.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

// Of how many turns of the leader a joint that follows it at `ratio` comes back; 0 for too many.
int turnsOf(double ratio) {
  constexpr int kMostTurns = 64;
  constexpr double kOff = 1e-5;  // what decimals such as 0.333333 are off by
  for (int turns = 1; turns <= kMostTurns; ++turns) {
    const double whole = std::round(turns * ratio);
    if (whole != 0 && std::abs(turns * ratio - whole) <= kOff) return turns;
  }
  return 0;
}

}  // namespace

void widenFollowed(std::vector<JointModel>& joints) {
  std::map<int, long> turns;  // by leader; 0 for any number
  for (const JointModel& follower : joints) {
    if (!follower.mimic || follower.mimic->multiplier == 0) continue;
    JointModel& leader = joints[static_cast<std::size_t>(follower.mimic->joint)];
    if (leader.type != JointType::continuous) continue;
    const auto [ratio, offset] = std::pair(follower.mimic->multiplier, follower.mimic->offset);
    if (follower.type == JointType::prismatic) {
      const auto [low, high] =
          std::minmax({(follower.lower - offset) / ratio, (follower.upper - offset) / ratio});
      leader.lower = std::max(std::min(leader.lower, low), -kLargestValue);
      leader.upper = std::min(std::max(leader.upper, high), kLargestValue);
    } else {
      long& all = turns.emplace(follower.mimic->joint, 1).first->second;
      all = std::lcm(all, static_cast<long>(turnsOf(ratio)));       // 0 stays 0
      if (kPi * static_cast<double>(all) > kLargestValue) all = 0;  // before the next would overflow
    }
  }
  for (const auto& [joint, all] : turns) {
    JointModel& leader = joints[static_cast<std::size_t>(joint)];
    const double reach = all > 0 ? std::min(kPi * static_cast<double>(all), kLargestValue) : kLargestValue;
    leader.lower = std::min(leader.lower, -reach);
    leader.upper = std::max(leader.upper, reach);
  }
}

}  // namespace fcl_stpbv::detail
