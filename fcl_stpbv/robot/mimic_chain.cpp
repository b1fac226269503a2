// Resolves mimic joints that follow mimic joints: walks along each chain to a joint that moves by itself, and
// refuses loops.
#include "fcl_stpbv/robot/mimic_chain.h"

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

MimicChains::MimicChains(std::vector<Follower> joints) : joints_(std::move(joints)) {
  std::unordered_map<std::string, int> index;
  for (std::size_t j = 0; j < joints_.size(); ++j) index[joints_[j].joint] = static_cast<int>(j);
  for (const Follower& joint : joints_) {
    const auto found = joint.mimics.empty() ? index.end() : index.find(joint.mimics);
    next_.push_back(found == index.end() ? -1 : found->second);
  }
  end_.resize(joints_.size());
  state_.resize(joints_.size(), State::open);
}

void MimicChains::follow(std::size_t joint) {
  std::vector<std::size_t> chain;
  int next = static_cast<int>(joint);
  for (; next >= 0 && state_[at(next)] == State::open; next = next_[at(next)]) {
    state_[at(next)] = State::entered;
    chain.push_back(at(next));
  }
  // If `next` was entered but is not done, the chain leads into a loop. The joints of a loop are never done.
  if (next >= 0 && state_[at(next)] == State::entered) return;
  for (; !chain.empty(); chain.pop_back()) tie(chain.back());
}

void MimicChains::tie(std::size_t joint) {
  state_[joint] = State::done;
  end_[joint] = {static_cast<int>(joint), 1, 0};
  if (next_[joint] < 0) return;
  const Mimic& ahead = end_[at(next_[joint])];
  const double multiplier = joints_[joint].multiplier;
  end_[joint] = {ahead.joint, multiplier * ahead.multiplier,
                 multiplier * ahead.offset + joints_[joint].offset};
}

std::string MimicChains::missing(std::size_t joint) {
  follow(joint);
  return state_[joint] == State::done ? joints_[at(end_[joint].joint)].mimics : "";
}

Mimic MimicChains::end(std::size_t joint) {
  follow(joint);
  if (state_[joint] != State::done) throw Error("mimics itself through others; break the loop");
  if (const std::string name = missing(joint); !name.empty()) {
    const auto known = [&] {
      std::vector<std::string> names;
      for (const Follower& each : joints_) names.push_back(each.joint);
      return names;
    };
    throw Error("mimics '" + name + "', which does not exist" + proposals_.of(name, known));
  }
  return end_[joint];
}

}  // namespace fcl_stpbv::detail
