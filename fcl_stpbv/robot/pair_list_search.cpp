// Finds the reasons for pairs by samples, as MoveIt's setup assistant does, and then by descents and proofs.
// Each stage handles the pairs that are still undecided.
// 1. The tree of joints: pairs that are adjacent, rigidly joined, or left out by the user's SRDF
//    (pair_tree.h).
// 2. Random samples: a collision in the neutral configuration, in (nearly) all samples, in some, or in none.
// 3. Without a collision: descents of the distance from the closest samples, then a short proof by boxes of
//    joint values (pair_proof.h), then descents from random configurations.
// 4. Longer proofs, with twice the boxes in each round, until the seconds allowed are spent.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <random>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_path.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_list_again.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_samples.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "fcl_stpbv/robot/pair_tree.h"
#include "fcl_stpbv/robot/search_room.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

class Search {
 public:
  Search(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
         const PairListOptions& options)
      : kinematics_(std::move(kinematics)), geometry_(std::move(geometry)), options_(options) {
    if (options.samples < 1) throw Error("pairList: samples must be 1 or more");
    requireRoomForPairs(*kinematics_, *geometry_, options.obstacles.size());
    constexpr double kLargest = 1e9;  // m, s
    requireNumber("PairListOptions: margin", options.margin, -kLargest, kLargest);
    requireNumber("PairListOptions: proofSeconds", options.proofSeconds, 0, kLargest);
    requireNumber("PairListOptions: alwaysFraction", options.alwaysFraction, 0, 1);
    neutral_ = options.neutral.size() > 0 ? options.neutral : kinematics_->neutral();
    if (neutral_.size() != kinematics_->size() || !neutral_.allFinite())
      throw Error("PairListOptions: neutral must be a finite number for each of the " +
                  std::to_string(kinematics_->size()) + " coordinates");
  }

  // `before`, null for none: entries to keep for pairs that are not among `changed`.
  std::vector<PairEntry> run(const Srdf* srdf, const std::vector<PairEntry>* before = nullptr,
                             const std::set<LinkPair>& changed = {}) {
    for (const TreePair& pair : pairsOfTree(*kinematics_, *geometry_, srdf, options_.obstacles.size())) {
      PairEntry entry;
      static_cast<LinkPair&>(entry) = pair;
      entry.reason = pair.reason;
      entry.closest = neutral_;
      list_.push_back(entry);
      isJoined_.push_back(pair.joined);
    }
    std::vector<PairEntry*> fresh;
    for (std::size_t e = 0; e < list_.size(); ++e) {
      isFresh_.push_back(!before || changed.count(list_[e]) > 0);
      if (isFresh_.back())
        fresh.push_back(&list_[e]);
      else
        list_[e] = (*before)[e];
    }
    PairSampler all = sampler([](const PairEntry&) { return true; });
    const Eigen::VectorXd least = all.distances(neutral_);
    for (std::size_t e = 0; e < fresh.size(); ++e)
      fresh[e]->neutralDistance = fresh[e]->minDistance = least[static_cast<Eigen::Index>(e)];
    sample();
    prove();
    for (PairEntry* entry : fresh) propose(*entry);
    for (std::size_t e = 0; e < list_.size(); ++e)
      if (isFresh_[e] && isJoined_[e]) list_[e].reason = PairReason::adjacent;
    return std::move(list_);
  }

 private:
  struct Open {  // a pair that no proof has decided yet
    PairEntry* entry;
    PairProof proof;
  };

  void tell(const char* what, std::size_t done, std::size_t all) const {
    if (options_.progress) options_.progress(done, all, what);
  }

  // Of those wanted among the fresh ones.
  template <class Wanted>
  PairSampler sampler(Wanted wanted) const {
    std::vector<LinkPair> pairs;
    for (std::size_t e = 0; e < list_.size(); ++e)
      if (isFresh_[e] && wanted(list_[e])) pairs.push_back(list_[e]);
    return PairSampler(kinematics_, geometry_, pairs, options_.obstacles, options_.threads);
  }

  PairSearch searchOf(const PairEntry& entry) const {
    return {kinematics_, geometry_, entry, options_.obstacles};
  }

  // Judges the pairs that the tree left open by samples. Pairs found clear go on to descents and proofs.
  void sample() {
    std::vector<PairEntry*> open;
    for (std::size_t e = 0; e < list_.size(); ++e)
      if (isFresh_[e] && list_[e].reason == PairReason::sometimes) open.push_back(&list_[e]);
    PairSampler random = sampler([](const PairEntry& e) { return e.reason == PairReason::sometimes; });
    const std::vector<PairSamples> found =
        random.sample(options_.samples, options_.seed, options_.margin, options_.descents,
                      [&](int done) { tell("samples", at(done), at(options_.samples)); });
    std::vector<std::size_t> clear;
    for (std::size_t i = 0; i < open.size(); ++i) {
      judge(*open[i], found[i]);
      if (open[i]->reason == PairReason::neverSampled) clear.push_back(i);
    }
    if (options_.proofBoxes > 0 || options_.proofSeconds > 0)
      scene_ = proofScene(kinematics_, geometry_, options_.obstacles, options_.margin);
    settleAll(clear.size(), [&](std::size_t i) { return settle(*open[clear[i]], found[clear[i]]); });
  }

  // Settles each pair by itself, so that the result does not depend on the number of threads.
  template <class Settle>
  void settleAll(std::size_t count, Settle settleOne) {
    std::vector<std::optional<Open>> left(count);
    shareOut(
        count, options_.threads, [&](std::size_t i) { left[i] = settleOne(i); },
        [&](std::size_t i) { tell("descents", i, count); });
    for (std::optional<Open>& open : left)
      if (open) open_.push_back(std::move(*open));
  }

  void judge(PairEntry& entry, const PairSamples& found) {
    constexpr int kFewest =
        60;  // a pair that is clear in 5 % of the samples is missed with probability 0.95^60 = 5 %
    entry.samples = found.samples;
    entry.collisions = found.collisions;
    note(entry, found.closest.front().first, found.closest.front().second);
    if (!entry.obstacle && entry.neutralDistance <= options_.margin) {
      Eigen::VectorXd q = found.farthest;
      const bool clears =
          found.largest > options_.margin || searchOf(entry).climb(q, options_.margin) > options_.margin;
      entry.reason = clears ? PairReason::defaultClears : PairReason::byDefault;
    } else if (entry.neutralDistance > options_.margin && entry.collisions == 0) {
      entry.reason = PairReason::neverSampled;
    } else if (entry.samples >= kFewest && entry.collisions >= options_.alwaysFraction * entry.samples) {
      entry.reason = PairReason::always;
    }
  }

  bool note(PairEntry& entry, double distance, const Eigen::VectorXd& q) const {
    if (distance >= entry.minDistance) return false;
    entry.minDistance = distance;
    entry.closest = q;
    return true;
  }

  // Descents from the closest samples, a short proof, descents from random configurations, until one of them
  // decides. @return the proof that is left open; no value if the pair is decided.
  std::optional<Open> settle(PairEntry& entry, const PairSamples& found) const {
    PairSearch search = searchOf(entry);
    const auto descend = [&](Eigen::VectorXd q) {
      const double reached = search.descend(q, options_.margin);
      entry.byDescent |= note(entry, reached, q);
      if (reached <= options_.margin) entry.reason = PairReason::sometimes;
      return reached <= options_.margin;
    };
    for (int i = 0; i < options_.descents && at(i) < found.closest.size(); ++i)
      if (descend(found.closest[at(i)].second)) return std::nullopt;
    Open open{&entry, {}};
    // Robots of hundreds of links get fewer descents for each of their many pairs, so that the list takes a
    // minute and not hours.
    constexpr double kUsualWork = 1e5;  // pairs times coordinates
    const double work = static_cast<double>(list_.size()) * static_cast<double>(kinematics_->size());
    double descents = options_.randomDescents * std::min(1.0, kUsualWork / work);
    if (scene_.kinematics) {
      open.proof = unproven(scene_, entry);
      // Pairs with more joints than usual get fewer boxes and random descents, because a box takes time in
      // proportion to the square of the joints, a descent to their number, and a robot with long chains has
      // many pairs.
      constexpr double kUsual = 24;  // joints
      const double joints =
          std::max<double>(static_cast<double>(open.proof.open.front().lower.size()), movingJoints(entry));
      const double share = std::min(1.0, kUsual / joints);
      descents *= std::pow(share, 2);
      constexpr double kUnlimited = 1e18;  // a whole number of any size is less than the largest long
      const double boxes = static_cast<double>(options_.proofBoxes) * std::pow(share, 3);
      if (advance(open, std::lround(std::min(boxes, kUnlimited)))) {
        if (entry.reason != PairReason::neverProven) return std::nullopt;
        constexpr double kOfProven = 50;  // to find how close the pair comes; they take 3 % of a list's time
        descents = std::min(descents, kOfProven);
      }
    }
    // Each pair has its own random numbers, so that they do not depend on the pairs before it.
    std::mt19937_64 random(options_.seed +
                           0x9e3779b97f4a7c15u * (1 + static_cast<std::size_t>(&entry - list_.data())));
    for (int i = 0; i < descents; ++i)
      if (descend(randomConfiguration(*kinematics_, search.room(), random))) return std::nullopt;
    if (entry.reason == PairReason::neverProven) return std::nullopt;
    return open;
  }

  // Number of moving joints between the two. Mimic joints count too, because many may follow one coordinate.
  int movingJoints(const LinkPair& pair) const {
    const RobotModel& robot = kinematics_->robot();
    const std::vector<int> path = jointPath(robot, pair.link1, pair.obstacle ? 0 : pair.link2).joints;
    return static_cast<int>(std::count_if(path.begin(), path.end(), [&](int joint) {
      return robot.joints[at(joint)].type != JointType::fixed;
    }));
  }

  // Continues a proof. @return whether that decided the pair.
  bool advance(Open& open, long boxes) const {
    const long before = open.proof.boxes;
    open.proof = provePair(scene_, *open.entry, std::move(open.proof.open), boxes);
    open.proof.boxes += before;
    PairEntry& entry = *open.entry;
    entry.boxes = open.proof.boxes;
    if (open.proof.collision) {
      entry.reason = PairReason::sometimes;
      note(entry, searchOf(entry).distance(*open.proof.collision), *open.proof.collision);
      return true;
    }
    if (open.proof.proven()) entry.reason = PairReason::neverProven;
    return open.proof.proven();
  }

  // Goes round the pairs that are still open, with twice the boxes in each round. So pairs that need few
  // boxes are decided first.
  void prove() {
    using Clock = std::chrono::steady_clock;
    constexpr long kBoxesAtOnce = 500;  // some 10 ms
    const auto end = Clock::now() + std::chrono::duration<double>(options_.proofSeconds);
    const std::size_t all = open_.size();
    bool looked = options_.proofSeconds > 0;  // whether the last round examined any box
    for (long round = kBoxesAtOnce; !open_.empty() && looked; round *= 2) {
      looked = false;
      const auto decided = [&](Open& open) {
        tell("proofs", all - open_.size(), all);
        for (long boxes = 0; boxes < round; boxes += kBoxesAtOnce) {
          if (Clock::now() >= end) return false;
          const long before = open.proof.boxes;
          if (advance(open, kBoxesAtOnce)) return true;
          if (open.proof.boxes == before) return false;  // no box can be covered
          looked = true;
        }
        return false;
      };
      open_.erase(std::remove_if(open_.begin(), open_.end(), decided), open_.end());
      if (Clock::now() >= end) return;
    }
  }

  // The neutral configuration must stay outside the influence. Otherwise an optimiser starts inside the
  // damping zone.
  static void propose(PairEntry& entry) {
    const double room = std::max(0.0, entry.neutralDistance);
    entry.security = std::min(0.01, 0.25 * room);
    entry.influence = std::min(0.1, 0.75 * room);
  }

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  const PairListOptions& options_;
  Eigen::VectorXd neutral_;
  std::vector<PairEntry> list_;
  std::vector<char> isFresh_;   // for each entry, whether it is searched
  std::vector<char> isJoined_;  // whether its links are adjacent and it is searched nevertheless
  ProofScene scene_;
  std::vector<Open> open_;
};

}  // namespace

namespace detail {

std::vector<PairEntry> pairListAgain(std::shared_ptr<const Kinematics> kinematics,
                                     std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                     const PairListOptions& options, const std::vector<PairEntry>& before,
                                     const std::set<LinkPair>& changed) {
  return Search(std::move(kinematics), std::move(geometry), options).run(srdf, &before, changed);
}

}  // namespace detail

std::vector<PairEntry> pairList(std::shared_ptr<const Kinematics> kinematics,
                                std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                const PairListOptions& options) {
  return Search(std::move(kinematics), std::move(geometry), options).run(srdf);
}

}  // namespace fcl_stpbv
