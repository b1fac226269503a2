// Counts the pairs that collide in the neutral configuration, and looks for a posture with fewer: each
// group_state, then 200 random configurations.
#include "fcl_stpbv/robot/neutral_posture.h"

#include <cmath>
#include <random>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/pair_samples.h"

namespace fcl_stpbv::detail {

std::vector<std::pair<std::string, Eigen::VectorXd>> namedPostures(const Kinematics& kinematics,
                                                                   const Srdf* srdf) {
  std::vector<std::pair<std::string, Eigen::VectorXd>> postures;
  if (!srdf) return postures;
  for (const Srdf::State& state : srdf->allStates()) {
    try {
      postures.emplace_back(state.name, kinematics.configuration(state));
    } catch (const Error&) {  // an invalid state is no posture
    }
  }
  return postures;
}

NeutralPosture judgeNeutral(std::shared_ptr<const Kinematics> kinematics,
                            std::shared_ptr<const RobotGeometry> geometry, const std::vector<PairEntry>& list,
                            const Eigen::VectorXd& neutral, const Srdf* srdf, double margin) {
  constexpr int kRandom = 200;  // they take about 0.1 s for a humanoid
  std::vector<LinkPair> pairs;
  for (const PairEntry& entry : list)
    if (!entry.obstacle && entry.reason != PairReason::adjacent && entry.reason != PairReason::rigid)
      pairs.push_back(entry);
  PairSampler sampler(kinematics, geometry, pairs, {}, 1);
  const auto collidingAt = [&](const Eigen::VectorXd& q) {
    return static_cast<int>((sampler.distances(q).array() <= margin).count());
  };
  NeutralPosture found;
  found.colliding = collidingAt(neutral);
  const Eigen::VectorXd& distances = sampler.distances(neutral);
  for (std::size_t i = 0; i < pairs.size() && found.named.size() < NeutralPosture::kNamed; ++i)
    if (distances[static_cast<Eigen::Index>(i)] <= margin) found.named.push_back(pairs[i]);
  found.collidingThere = found.colliding;
  const auto consider = [&](const Eigen::VectorXd& q, const std::string& state) {
    if (found.collidingThere == 0) return;
    const int colliding = collidingAt(q);
    if (colliding >= found.collidingThere) return;
    found.collidingThere = colliding;
    found.better = q;
    found.state = state;
  };
  for (const auto& [name, q] : namedPostures(*kinematics, srdf)) consider(q, name);
  std::mt19937_64 random(1);
  SearchRoom room = searchRoom(*kinematics, *geometry, {});
  for (Eigen::Index i = 0; i < room.lower.size(); ++i) {
    if (!std::isfinite(kinematics->lower()[i])) room.lower[i] = -1;
    if (!std::isfinite(kinematics->upper()[i])) room.upper[i] = 1;
  }
  for (int i = 0; i < kRandom; ++i) consider(randomConfiguration(*kinematics, room, random), "");
  return found;
}

}  // namespace fcl_stpbv::detail
