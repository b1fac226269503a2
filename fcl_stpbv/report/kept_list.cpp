// The key of a list in the cache is the text of all inputs of the search: the tree of joints, each body with
// its pose, the SRDF's pairs, the obstacles and the options. A list is stored as the numbers of its
// entries.
#include "fcl_stpbv/report/kept_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// All inputs of a search, as text.
class Question {
 public:
  Question(const Kinematics& kinematics, const RobotGeometry& geometry, const Srdf* srdf,
           const PairListOptions& options) {
    robot(kinematics);
    for (const Body& body : geometry.bodies) {
      add(body.link, body.partOf, body.parts, body.radius);
      add(body.centre);
      add(body.pose);
      add(*body.geometry);
    }
    for (const LinkPair& pair : geometry.byParts) add(pair.link1, pair.link2, pair.obstacle);
    if (!geometry.incomplete.empty()) text_ += "incomplete\n";
    for (const int link : geometry.incomplete) add(link);
    // An SRDF without pairs is not the same as none: it has adjacent links searched.
    text_ += srdf ? "srdf\n" : "no srdf\n";
    if (srdf) skipped(kinematics.robot(), *srdf);
    for (const Obstacle& obstacle : options.obstacles) {
      add(obstacle.radius());
      add(obstacle.centre());
      add(obstacle.pose());
      add(*obstacle.geometry());
    }
    search(options);
  }

  /// Whether the text is complete. It is not if a body is neither a volume nor one convex shape.
  bool whole() const { return whole_; }
  const std::string& text() const { return text_; }

 private:
  void add(double value) {
    appendNumber(text_, value);
    text_ += ' ';
  }
  template <class... More>
  void add(double first, double second, More... more) {
    add(first);
    add(second, static_cast<double>(more)...);
  }
  void add(const Vector3d& v) { add(v.x(), v.y(), v.z()); }
  void add(const Isometry3d& pose) {
    for (int c = 0; c < 4; ++c) add(Vector3d(pose.matrix().col(c).head<3>()));
    text_ += '\n';
  }

  void add(const fcl::CollisionGeometryd& geometry) {
    ConvexBody body;
    if (!isConvex(geometry, body)) {
      whole_ = false;
    } else if (body.volume) {
      std::ostringstream volume;
      saveStpBv(volume, *body.volume);
      text_ += volume.str();
    } else {
      const Shape& shape = body.shape;
      add(static_cast<int>(shape.kind), shape.margin, shape.radius, shape.half, shape.offset, shape.reach);
      for (const Vector3d& v : {shape.size, shape.normal, shape.centre}) add(v);
      for (const Vector3d& v : shape.corner) add(v);
      for (int i = 0; i < shape.vertexCount; ++i) add(shape.vertices[i]);
      text_ += '\n';
    }
  }

  void robot(const Kinematics& kinematics) {
    const RobotModel& robot = kinematics.robot();
    add(static_cast<double>(robot.links.size()), kinematics.size(), kinematics.baseMoves());
    for (const LinkModel& link : robot.links) add(link.parentJoint);
    for (const JointModel& joint : robot.joints) {
      add(static_cast<int>(joint.type), joint.parent, joint.child, joint.lower, joint.upper);
      add(joint.axis);
      if (joint.mimic) add(joint.mimic->joint, joint.mimic->multiplier, joint.mimic->offset);
      add(joint.origin);
    }
  }

  // The search asks whether a pair is left out, and whether by the user. Other reasons are any text, even of
  // several lines, so they would not be safe here.
  void skipped(const RobotModel& robot, const Srdf& srdf) {
    const SkipReasons known(&srdf);
    for (std::size_t i = 0; i < robot.links.size(); ++i)
      for (std::size_t j = i + 1; j < robot.links.size(); ++j) {
        const std::string reason = known.of(robot.links[i].name, robot.links[j].name);
        if (reason.empty()) continue;
        add(static_cast<double>(i), static_cast<double>(j), reason == "User");
        text_ += '\n';
      }
  }

  void search(const PairListOptions& options) {
    text_ += "search 4 " + std::to_string(options.seed) + " ";
    add(options.samples, options.descents, options.randomDescents, static_cast<double>(options.proofBoxes));
    add(options.margin, options.alwaysFraction);
    for (const double value : options.neutral) add(value);
  }

  std::string text_;
  bool whole_ = true;
};

constexpr std::size_t kFields = 12;  // number of values of an entry before its configuration

std::vector<double> toNumbers(const std::vector<PairEntry>& list) {
  std::vector<double> numbers;
  for (const PairEntry& e : list) {
    for (const double value : {double(e.link1), double(e.link2), double(e.obstacle), double(e.reason),
                               double(e.samples), double(e.collisions), e.minDistance, double(e.byDescent),
                               e.neutralDistance, double(e.boxes), e.security, e.influence})
      numbers.push_back(value);
    numbers.insert(numbers.end(), e.closest.begin(), e.closest.end());
  }
  return numbers;
}

/// Reads numbers from a file one by one. None of them is trusted.
class Numbers {
 public:
  explicit Numbers(const double* first) : next_(first) {}

  double any() { return *next_++; }
  /// A whole number from `least` to `most`; else fine() becomes false.
  int whole(int least, int most) {
    const double value = any();
    const bool fits = value >= least && value <= most && value == std::trunc(value);
    fine_ = fine_ && fits;
    return fits ? static_cast<int>(value) : least;
  }
  Eigen::VectorXd list(std::size_t count) {
    const double* const first = next_;
    next_ += count;
    return Eigen::Map<const Eigen::VectorXd>(first, static_cast<Eigen::Index>(count));
  }
  bool fine() const { return fine_; }

 private:
  const double* next_;
  bool fine_ = true;
};

/// None for numbers that are no list of this robot's pairs.
std::optional<std::vector<PairEntry>> toList(const std::vector<double>& numbers, std::size_t links,
                                             std::size_t obstacles, std::size_t coordinates) {
  if (numbers.size() % (kFields + coordinates) != 0) return std::nullopt;
  constexpr int kMost = std::numeric_limits<int>::max();
  std::vector<PairEntry> list(numbers.size() / (kFields + coordinates));
  Numbers from(numbers.data());
  for (PairEntry& e : list) {
    e.link1 = from.whole(0, static_cast<int>(links) - 1);
    e.link2 = from.whole(0, kMost);
    e.obstacle = from.whole(0, 1) != 0;
    if (at(e.link2) >= (e.obstacle ? obstacles : links)) return std::nullopt;
    e.reason = static_cast<PairReason>(from.whole(0, static_cast<int>(PairReason::neverProven)));
    e.samples = from.whole(0, kMost);
    e.collisions = from.whole(0, kMost);
    e.minDistance = from.any();
    e.byDescent = from.whole(0, 1) != 0;
    e.neutralDistance = from.any();
    e.boxes = from.whole(0, kMost);
    e.security = from.any();
    e.influence = from.any();
    e.closest = from.list(coordinates);
    if (!from.fine() || (!e.obstacle && e.link1 == e.link2)) return std::nullopt;
  }
  return list;
}

}  // namespace

std::vector<PairEntry> keptPairList(const std::shared_ptr<const Kinematics>& kinematics,
                                    const std::shared_ptr<const RobotGeometry>& geometry, const Srdf* srdf,
                                    const PairListOptions& options, VolumeCache& cache) {
  const auto search = [&] { return pairList(kinematics, geometry, srdf, options); };
  constexpr std::size_t kMostNumbers = 2000000;  // some 30 MB
  const std::size_t links = kinematics->robot().links.size(), coordinates = at(kinematics->size());
  const std::size_t most = links * (links + options.obstacles.size()) * (kFields + coordinates);
  if (options.proofSeconds > 0 || most > kMostNumbers) return search();
  const Question question(*kinematics, *geometry, srdf, options);
  if (!question.whole()) return search();
  std::vector<PairEntry> list;
  const std::vector<double> numbers = cache.numbers(question.text(), "pairs", [&] {
    list = search();
    return toNumbers(list);
  });
  if (!list.empty()) return list;
  const auto kept = toList(numbers, links, options.obstacles.size(), coordinates);
  return kept ? *kept : search();
}

// The stored numbers: number of colliding pairs in the neutral posture and in the better one; index of the
// SRDF's state that is better, or -1; the named pairs; the better posture.
NeutralPosture keptNeutral(const std::shared_ptr<const Kinematics>& kinematics,
                           const std::shared_ptr<const RobotGeometry>& geometry,
                           const std::vector<PairEntry>& list, const Srdf* srdf,
                           const PairListOptions& options, VolumeCache& cache) {
  const auto judge = [&] {
    return judgeNeutral(kinematics, geometry, list, options.neutral, srdf, options.margin);
  };
  const Question question(*kinematics, *geometry, srdf, options);
  if (!question.whole()) return judge();
  std::string asked = question.text() + "neutral, named";
  std::vector<std::string> states;
  for (const auto& [name, q] : namedPostures(*kinematics, srdf)) {
    states.push_back(name);
    for (const double value : q) appendNumber(asked += ' ', value);
  }
  for (const PairEntry& entry : list) asked += ' ' + std::to_string(static_cast<int>(entry.reason));
  const auto measure = [&] {
    const NeutralPosture found = judge();
    const auto state = std::find(states.begin(), states.end(), found.state);
    std::vector<double> numbers{double(found.colliding), double(found.collidingThere),
                                found.state.empty() ? -1.0 : double(state - states.begin())};
    for (std::size_t i = 0; i < NeutralPosture::kNamed; ++i) {
      const bool there = i < found.named.size();
      numbers.push_back(there ? double(found.named[i].link1) : -1);
      numbers.push_back(there ? double(found.named[i].link2) : -1);
    }
    numbers.insert(numbers.end(), found.better.begin(), found.better.end());
    return numbers;
  };
  const std::vector<double> kept = cache.numbers(asked, "neutral", measure);
  const std::size_t coordinates = at(kinematics->size());
  constexpr std::size_t kFirst = 3 + 2 * NeutralPosture::kNamed;
  if (kept.size() != kFirst && kept.size() != kFirst + coordinates) return judge();
  constexpr int kMost = std::numeric_limits<int>::max();
  Numbers from(kept.data());
  NeutralPosture found;
  found.colliding = from.whole(0, kMost);
  found.collidingThere = from.whole(0, kMost);
  const int state = from.whole(-1, static_cast<int>(states.size()) - 1);
  if (state >= 0) found.state = states[at(state)];
  const int lastLink = static_cast<int>(kinematics->robot().links.size()) - 1;
  for (std::size_t i = 0; i < NeutralPosture::kNamed; ++i) {
    const int link1 = from.whole(-1, lastLink), link2 = from.whole(-1, lastLink);
    if (link1 >= 0 && link2 >= 0) found.named.push_back({link1, link2, false});
  }
  found.better = from.list(kept.size() - kFirst);
  return from.fine() ? found : judge();
}

}  // namespace fcl_stpbv::report
