// Distances of all pairs in the neutral and in random configurations, with the closest ones kept as starts.
#include "fcl_stpbv/robot/pair_samples.h"

#include <algorithm>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Index;

std::vector<CheckedPair> allBodies(const RobotGeometry& geometry, const std::vector<LinkPair>& pairs) {
  std::vector<CheckedPair> bodies;
  for (const LinkPair& pair : pairs)
    for (const CheckedPair& both : bodiesOf(geometry, pair)) bodies.push_back(both);
  return bodies;
}

ConstraintOptions optionsOf(const std::vector<Obstacle>& obstacles) {
  ConstraintOptions options;
  options.obstacles = obstacles;
  return options;
}

// Adds a distance to the `keep` closest ones.
void note(double distance, const Eigen::VectorXd& q, std::size_t keep, PairSamples& pair) {
  auto& closest = pair.closest;
  if (closest.size() == keep && distance >= closest.back().first) return;
  const auto place = std::upper_bound(closest.begin(), closest.end(), distance,
                                      [](double value, const auto& item) { return value < item.first; });
  closest.insert(place, {distance, q});
  if (closest.size() > keep) closest.pop_back();
}

}  // namespace

PairSampler::PairSampler(std::shared_ptr<const Kinematics> kinematics,
                         std::shared_ptr<const RobotGeometry> geometry, const std::vector<LinkPair>& pairs,
                         const std::vector<Obstacle>& obstacles, int threads)
    : kinematics_(kinematics),
      room_(searchRoom(*kinematics, *geometry, obstacles)),
      constraints_(kinematics, geometry, allBodies(*geometry, pairs), optionsOf(obstacles)),
      batch_(constraints_, std::max(1, threads)),
      rows_(constraints_.rows()),
      least_(static_cast<Index>(pairs.size())) {
  for (std::size_t p = 0; p < pairs.size(); ++p)
    pairOf_.insert(pairOf_.end(), bodiesOf(*geometry, pairs[p]).size(), static_cast<Index>(p));
}

const Eigen::VectorXd& PairSampler::distances(const Eigen::VectorXd& q) {
  constraints_.evaluate(q, rows_);
  return leastOf(rows_);
}

const Eigen::VectorXd& PairSampler::leastOf(const Eigen::Ref<const Eigen::VectorXd>& rows) {
  least_.setConstant(kInfinity);
  for (Index row = 0; row < rows.size(); ++row) {
    double& value = least_[pairOf_[static_cast<std::size_t>(row)]];
    value = std::min(value, rows[row]);
  }
  return least_;
}

std::vector<PairSamples> PairSampler::sample(int count, std::uint64_t seed, double margin, int keep,
                                             const std::function<void(int)>& progress) {
  std::vector<PairSamples> found(static_cast<std::size_t>(least_.size()));
  std::mt19937_64 random(seed);
  constexpr int kBlock = 512;  // gives each thread a few pieces of a batch, and needs little memory
  Eigen::MatrixXd q(kinematics_->size(), kBlock), rows(constraints_.rows(), kBlock);
  for (int done = 0; done < count && !found.empty(); done += kBlock) {
    progress(done);
    const Index block = std::min(kBlock, count - done);
    for (Index s = 0; s < block; ++s) q.col(s) = randomConfiguration(*kinematics_, room_, random);
    batch_.evaluate(q.leftCols(block), Sequence::path, rows.leftCols(block));
    for (Index s = 0; s < block; ++s) {
      leastOf(rows.col(s));
      for (std::size_t p = 0; p < found.size(); ++p) {
        PairSamples& pair = found[p];
        const double d = least_[static_cast<Index>(p)];
        ++pair.samples;
        pair.collisions += d <= margin;
        note(d, q.col(s), static_cast<std::size_t>(std::max(1, keep)), pair);
        if (pair.farthest.size() == 0 || d > pair.largest) {
          pair.largest = d;
          pair.farthest = q.col(s);
        }
      }
    }
  }
  return found;
}

}  // namespace fcl_stpbv::detail
