// The key of a list in the cache is the text of all inputs of the search: the tree of joints, each body with
// its pose, the SRDF's reasons, the obstacles and the options. A list is stored as the numbers of its
// entries.
#include "fcl_stpbv/report/kept_list.h"

#include <algorithm>
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
    text_ += "srdf\n";
    if (srdf) reasons(kinematics.robot(), *srdf);
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

  void reasons(const RobotModel& robot, const Srdf& srdf) {
    const SkipReasons known(&srdf);
    for (std::size_t i = 0; i < robot.links.size(); ++i)
      for (std::size_t j = i + 1; j < robot.links.size(); ++j) {
        const std::string reason = known.of(robot.links[i].name, robot.links[j].name);
        if (reason.empty()) continue;
        add(static_cast<double>(i), static_cast<double>(j));
        text_ += reason + "\n";
      }
  }

  void search(const PairListOptions& options) {
    text_ += "search 3 " + std::to_string(options.seed) + " ";
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

std::vector<PairEntry> toList(const std::vector<double>& numbers, std::size_t coordinates) {
  std::vector<PairEntry> list(numbers.size() / (kFields + coordinates));
  const double* from = numbers.data();
  const auto whole = [&from] { return static_cast<int>(*from++); };
  for (PairEntry& e : list) {
    e.link1 = whole();
    e.link2 = whole();
    e.obstacle = whole() != 0;
    e.reason = static_cast<PairReason>(whole());
    e.samples = whole();
    e.collisions = whole();
    e.minDistance = *from++;
    e.byDescent = whole() != 0;
    e.neutralDistance = *from++;
    e.boxes = static_cast<long>(*from++);
    e.security = *from++;
    e.influence = *from++;
    e.closest = Eigen::Map<const Eigen::VectorXd>(from, static_cast<Eigen::Index>(coordinates));
    from += coordinates;
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
  return numbers.size() % (kFields + coordinates) == 0 ? toList(numbers, coordinates) : search();
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
  NeutralPosture found;
  found.colliding = static_cast<int>(kept[0]);
  found.collidingThere = static_cast<int>(kept[1]);
  if (kept[2] >= 0 && kept[2] < static_cast<double>(states.size()))
    found.state = states[static_cast<std::size_t>(kept[2])];
  const auto links = static_cast<double>(kinematics->robot().links.size());
  for (std::size_t i = 3; i < kFirst; i += 2)
    if (kept[i] >= 0 && kept[i] < links && kept[i + 1] >= 0 && kept[i + 1] < links)
      found.named.push_back({static_cast<int>(kept[i]), static_cast<int>(kept[i + 1]), false});
  found.better = Eigen::Map<const Eigen::VectorXd>(kept.data() + kFirst,
                                                   static_cast<Eigen::Index>(kept.size() - kFirst));
  return found;
}

}  // namespace fcl_stpbv::report
