// See pair_list.h.
#include "fcl_stpbv/robot/pair_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/pair_search.h"

namespace fcl_stpbv {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Without the standard library's distributions, which differ from one to another.
double uniform(std::mt19937_64& random, double low, double high) {
  return low + static_cast<double>(random() >> 11) * 0x1p-53 * (high - low);
}

class Search {
 public:
  Search(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
         const PairListOptions& options)
      : kinematics_(std::move(kinematics)), geometry_(std::move(geometry)), options_(options) {}

  std::vector<PairEntry> run(const Srdf* srdf) {
    enumerate(srdf);
    sample();
    for (std::size_t i = 0; i < open_.size(); ++i) {
      tell("descents", i, open_.size());
      if (open_[i].entry->reason == PairReason::neverSampled) descend(open_[i]);
    }
    prove();
    for (PairEntry& entry : list_) propose(entry);
    return std::move(list_);
  }

 private:
  struct Open {  // a pair still to be decided
    PairEntry* entry;
    std::vector<std::pair<double, Eigen::VectorXd>> closest;  // samples, closest first
  };

  void tell(const char* what, std::size_t done, std::size_t all) const {
    if (options_.progress) options_.progress(done, all, what);
  }

  void enumerate(const Srdf* srdf) {
    const RobotModel& robot = kinematics_->robot();
    const int links = static_cast<int>(robot.links.size());
    const auto none = [&](int link) { return geometry_->of(link).first == geometry_->of(link).second; };
    const auto add = [&](int first, int second, bool obstacle) {
      PairEntry entry;
      entry.link1 = first;
      entry.link2 = second;
      entry.obstacle = obstacle;
      entry.closest = kinematics_->neutral();
      list_.push_back(entry);
    };
    for (int i = 0; i < links; ++i) {
      for (int j = i + 1; j < links; ++j) {
        if (none(i) || none(j)) continue;
        add(i, j, false);
        const std::string &name1 = robot.links[at(i)].name, &name2 = robot.links[at(j)].name;
        if (srdf && srdf->reasonToSkip(name1, name2) == "User")
          list_.back().reason = PairReason::user;
        else if (adjacent(robot, *geometry_, i, j))
          list_.back().reason = PairReason::adjacent;
      }
    }
    const auto& motions = kinematics_->motions();
    const bool baseMoves = !motions.empty() && motions.front().joint < 0;
    for (int i = 0; i < links; ++i)
      for (int o = 0; o < static_cast<int>(options_.obstacles.size()); ++o)
        if (!none(i) && moves(robot, i, baseMoves)) add(i, o, true);
  }

  std::vector<CheckedPair> bodiesOf(const PairEntry& entry) const {
    return entry.obstacle ? pairsWithObstacle(*geometry_, entry.link1, entry.link2)
                          : pairsOfLinks(*geometry_, entry.link1, entry.link2);
  }

  PairSearch searchOf(const PairEntry& entry) const {
    return entry.obstacle
               ? PairSearch(kinematics_, geometry_, entry.link1, options_.obstacles[at(entry.link2)])
               : PairSearch(kinematics_, geometry_, entry.link1, entry.link2);
  }

  // Distances of all pairs of bodies at once, then the least of each pair of links.
  void sample() {
    std::vector<CheckedPair> pairs;
    std::vector<std::size_t> entryOf;
    for (std::size_t e = 0; e < list_.size(); ++e) {
      for (const CheckedPair& pair : bodiesOf(list_[e])) {
        pairs.push_back(pair);
        entryOf.push_back(e);
      }
    }
    ConstraintOptions settings;
    settings.threads = options_.threads;
    settings.obstacles = options_.obstacles;
    CollisionConstraints neutral(kinematics_, geometry_, pairs, settings);
    Eigen::VectorXd d(neutral.rows()), least(static_cast<Eigen::Index>(list_.size()));
    const auto leastOf = [&](CollisionConstraints& constraints, const std::vector<std::size_t>& owner,
                             const Eigen::VectorXd& q) {
      constraints.evaluate(q, d);
      least.setConstant(std::numeric_limits<double>::infinity());
      for (Eigen::Index row = 0; row < d.size(); ++row) {
        double& value = least[static_cast<Eigen::Index>(owner[static_cast<std::size_t>(row)])];
        value = std::min(value, d[row]);
      }
    };
    leastOf(neutral, entryOf, kinematics_->neutral());
    for (std::size_t e = 0; e < list_.size(); ++e) {
      PairEntry& entry = list_[e];
      entry.neutralDistance = entry.minDistance = least[static_cast<Eigen::Index>(e)];
      if (entry.reason == PairReason::sometimes && !entry.obstacle &&
          entry.neutralDistance <= options_.margin)
        entry.reason = PairReason::byDefault;
    }
    // From here on the pairs that are still open only.
    std::vector<CheckedPair> openPairs;
    std::vector<std::size_t> owner;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      if (list_[entryOf[p]].reason != PairReason::sometimes) continue;
      openPairs.push_back(pairs[p]);
      owner.push_back(entryOf[p]);
    }
    for (PairEntry& entry : list_)
      if (entry.reason == PairReason::sometimes) open_.push_back({&entry, {}});
    if (openPairs.empty()) return;
    CollisionConstraints constraints(kinematics_, geometry_, openPairs, settings);
    d.resize(constraints.rows());
    std::mt19937_64 random(options_.seed);
    for (int s = 0; s < options_.samples; ++s) {
      if (s % 50 == 0) tell("samples", at(s), at(options_.samples));
      const Eigen::VectorXd q = randomConfiguration(random);
      leastOf(constraints, owner, q);
      for (Open& open : open_) note(open, least[open.entry - list_.data()], q);
    }
    for (Open& open : open_) {
      PairEntry& entry = *open.entry;
      if (entry.collisions == 0)
        entry.reason = PairReason::neverSampled;
      else if (entry.collisions >= options_.alwaysFraction * entry.samples)
        entry.reason = PairReason::always;
    }
  }

  Eigen::VectorXd randomConfiguration(std::mt19937_64& random) const {
    Eigen::VectorXd q(kinematics_->size());
    for (Eigen::Index i = 0; i < q.size(); ++i)  // a floating joint has no limits: a metre around
      q[i] = uniform(random, std::max(kinematics_->lower()[i], -1e3) < -999 ? -1 : kinematics_->lower()[i],
                     std::min(kinematics_->upper()[i], 1e3) > 999 ? 1 : kinematics_->upper()[i]);
    return q;
  }

  void note(Open& open, double distance, const Eigen::VectorXd& q) const {
    PairEntry& entry = *open.entry;
    ++entry.samples;
    entry.collisions += distance <= options_.margin;
    if (distance < entry.minDistance) {
      entry.minDistance = distance;
      entry.closest = q;
    }
    if (entry.collisions > 0) return;  // decided
    auto& closest = open.closest;
    if (closest.size() == at(options_.descents) && (closest.empty() || distance >= closest.back().first))
      return;
    const auto place = std::upper_bound(closest.begin(), closest.end(), distance,
                                        [](double value, const auto& item) { return value < item.first; });
    closest.insert(place, {distance, q});
    if (closest.size() > at(options_.descents)) closest.pop_back();
  }

  void descend(Open& open) {
    PairEntry& entry = *open.entry;
    PairSearch search = searchOf(entry);
    for (auto& [start, q] : open.closest) {
      const double reached = search.descend(q, options_.margin);
      if (reached >= entry.minDistance) continue;
      entry.minDistance = reached;
      entry.closest = q;
      entry.byDescent = true;
      if (reached <= options_.margin) {
        entry.reason = PairReason::sometimes;
        return;
      }
    }
  }

  // What is left of the time is shared evenly among the pairs still open, the ones farthest apart first.
  void prove() {
    if (!(options_.proofSeconds > 0)) return;
    std::vector<PairEntry*> never;
    for (PairEntry& entry : list_)
      if (entry.reason == PairReason::neverSampled) never.push_back(&entry);
    std::stable_sort(never.begin(), never.end(),
                     [](const PairEntry* a, const PairEntry* b) { return a->minDistance > b->minDistance; });
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(options_.proofSeconds));
    for (std::size_t i = 0; i < never.size(); ++i) {
      tell("proofs", i, never.size());
      const Clock::time_point now = Clock::now();
      PairSearch search = searchOf(*never[i]);
      Eigen::VectorXd q;
      const auto proof =
          search.prove(options_.margin, now + (end - now) / static_cast<long>(never.size() - i), q);
      if (proof == PairSearch::Proof::clear) never[i]->reason = PairReason::neverProven;
      if (proof == PairSearch::Proof::collision) {
        never[i]->reason = PairReason::sometimes;
        never[i]->closest = q;
        never[i]->minDistance = search.distance(q);
      }
    }
  }

  // The neutral configuration must stay outside the influence, or an optimiser starts in the brake.
  static void propose(PairEntry& entry) {
    const double room = std::max(0.0, entry.neutralDistance);
    entry.security = std::min(0.01, 0.25 * room);
    entry.influence = std::min(0.1, 0.75 * room);
  }

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  const PairListOptions& options_;
  std::vector<PairEntry> list_;
  std::vector<Open> open_;
};

}  // namespace

const char* srdfReason(PairReason reason) {
  switch (reason) {
    case PairReason::adjacent:
      return "Adjacent";
    case PairReason::byDefault:
      return "Default";
    case PairReason::always:
      return "Always";
    case PairReason::user:
      return "User";
    case PairReason::neverSampled:
    case PairReason::neverProven:
      return "Never";
    default:
      return "";
  }
}

const char* reasonText(PairReason reason) {
  switch (reason) {
    case PairReason::adjacent:
      return "adjacent";
    case PairReason::byDefault:
      return "default";
    case PairReason::always:
      return "always";
    case PairReason::user:
      return "user";
    case PairReason::neverSampled:
      return "never (sampled)";
    case PairReason::neverProven:
      return "never (proven)";
    default:
      return "sometimes";
  }
}

std::vector<PairEntry> pairList(std::shared_ptr<const Kinematics> kinematics,
                                std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                const PairListOptions& options) {
  if (options.samples < 1) throw Error("pairList: samples must be 1 or more");
  // A pair keeps a configuration and a row of the Jacobian with its structure.
  constexpr double kMostBytes = 4e9;
  double links = 0;
  for (std::size_t l = 0; l < kinematics->robot().links.size(); ++l) {
    const auto [first, last] = geometry->of(static_cast<int>(l));
    links += first != last;
  }
  const double pairs = links * (links - 1) / 2 + links * static_cast<double>(options.obstacles.size());
  if (pairs * (1000.0 + 40.0 * kinematics->size()) > kMostBytes)
    throw Error("pairList: the " + std::to_string(static_cast<long>(pairs)) + " pairs of " +
                std::to_string(static_cast<long>(links)) + " links and " +
                std::to_string(options.obstacles.size()) +
                " obstacles do not fit into memory; give collision shapes to fewer links");
  return Search(std::move(kinematics), std::move(geometry), options).run(srdf);
}

std::vector<Srdf::Pair> toSrdf(const RobotModel& robot, const std::vector<PairEntry>& list) {
  std::vector<Srdf::Pair> pairs;
  for (const PairEntry& entry : list) {
    if (entry.obstacle || entry.reason == PairReason::sometimes || entry.reason == PairReason::user) continue;
    Srdf::Pair pair{robot.links[at(entry.link1)].name, robot.links[at(entry.link2)].name,
                    srdfReason(entry.reason)};
    if (pair.link2 < pair.link1) std::swap(pair.link1, pair.link2);
    pairs.push_back(std::move(pair));
  }
  std::sort(pairs.begin(), pairs.end(), [](const Srdf::Pair& a, const Srdf::Pair& b) {
    return std::tie(a.link1, a.link2) < std::tie(b.link1, b.link2);
  });
  return pairs;
}

}  // namespace fcl_stpbv
