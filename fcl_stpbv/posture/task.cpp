// Makes the optimisation problem of a task in a scene: resolves names, chooses the pairs, the start and the
// cost, and adds the constraints of placements, stability and collisions.
#include "fcl_stpbv/posture/task.h"

#include <algorithm>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/collision_rows.h"
#include "fcl_stpbv/posture/task_start.h"
#include "fcl_stpbv/robot/near_name.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/search_room.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

int linkNamed(const std::string& name, const PostureScene& scene, const std::string& where) {
  const int link = scene.robot->link(name);
  if (link >= 0) return link;
  throw Error(where + ": the robot has no link '" + name + "'" +
              didYouMean(name, namesOf(scene.robot->links)));
}

// An obstacle of this link of the scene: the link's first shape has its name, others #2, #3 after it.
bool isOf(const Obstacle& obstacle, const std::string& link) {
  if (obstacle.name == link) return true;
  if (obstacle.name.compare(0, link.size() + 1, link + "#") != 0) return false;
  return obstacle.name.find_first_not_of("0123456789", link.size() + 1) == std::string::npos;
}

std::vector<int> linksNamed(const std::vector<std::string>& names, const PostureScene& scene,
                            const std::string& where) {
  std::vector<int> links;
  links.reserve(names.size());
  for (const std::string& name : names) links.push_back(linkNamed(name, scene, where));
  return links;
}

// An empty list means all links.
bool holds(const std::vector<int>& links, int link) {
  return links.empty() || std::find(links.begin(), links.end(), link) != links.end();
}

// The pairs of the robot's own bodies, without those that the task ignores.
std::vector<CheckedPair> ownPairs(const PostureTask& task, const PostureScene& scene) {
  std::vector<CheckedPair> pairs = scene.selfPairs ? *scene.selfPairs
                                   : scene.srdf ? selfPairs(*scene.robot, *scene.geometry, scene.srdf.get())
                                                : searchedPairs(scene.robot, scene.geometry);
  for (std::size_t i = 0; i < task.ignore.size(); ++i) {
    if (!task.ignore[i].self) continue;
    const std::string here = task.path + ": collisions.ignore[" + std::to_string(i) + "]";
    const std::vector<int> some = linksNamed(task.ignore[i].links, scene, here + ".links");
    const std::vector<int> others = linksNamed(*task.ignore[i].self, scene, here + ".self");
    const auto ignored = [&](const CheckedPair& pair) {
      const int a = scene.geometry->bodies[static_cast<std::size_t>(pair.body)].link;
      const int b = scene.geometry->bodies[static_cast<std::size_t>(pair.other)].link;
      return (holds(some, a) && holds(others, b)) || (holds(some, b) && holds(others, a));
    };
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), ignored), pairs.end());
  }
  return pairs;
}

// For each of some pairs with obstacles, whether one of these lists names it.
std::vector<bool> named(const std::vector<LinkObstacles>& lists, const std::vector<CheckedPair>& pairs,
                        const PostureScene& scene, const std::string& where) {
  std::vector<bool> found(pairs.size(), false);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!lists[i].withObstacles()) continue;
    const std::string here = where + "[" + std::to_string(i) + "]";
    const std::vector<int> links = linksNamed(lists[i].links, scene, here + ".links");
    for (const std::string& name : lists[i].obstacles) {
      if (std::none_of(scene.obstacles.begin(), scene.obstacles.end(),
                       [&](const Obstacle& o) { return isOf(o, name); }))
        throw Error(
            here + ".obstacles: there is no obstacle '" + name + "'" +
            (scene.obstacles.empty() ? "; give --obstacles" : didYouMean(name, namesOf(scene.obstacles))));
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const int link = scene.geometry->bodies[static_cast<std::size_t>(pairs[p].body)].link;
      const Obstacle& obstacle = scene.obstacles[static_cast<std::size_t>(pairs[p].other)];
      const std::vector<std::string>& names = lists[i].obstacles;
      const bool linkToo = holds(links, link);
      const bool obstacleToo =
          names.empty() ||
          std::any_of(names.begin(), names.end(), [&](const auto& name) { return isOf(obstacle, name); });
      if (linkToo && obstacleToo) found[p] = true;
    }
  }
  return found;
}

}  // namespace

std::vector<CheckedPair> searchedPairs(std::shared_ptr<const RobotModel> robot,
                                       std::shared_ptr<const RobotGeometry> geometry) {
  PairListOptions options;  // pairs that never meet need not be known, because they are checked anyway
  options.descents = options.randomDescents = 0;
  options.proofBoxes = 0;
  const auto kinematics = std::make_shared<const Kinematics>(std::move(robot));
  return checkedPairs(*geometry, pairList(kinematics, geometry, nullptr, options));
}

std::vector<CheckedPair> pairsOf(const PostureTask& task, const PostureScene& scene) {
  std::vector<CheckedPair> pairs;
  if (task.selfCollisions) pairs = ownPairs(task, scene);
  // Pairs of links that nothing moves are included. They are checked once.
  const std::vector<CheckedPair> all =
      obstaclePairs(*scene.robot, *scene.geometry, scene.obstacles.size(), true);
  const std::vector<bool> wanted = named(task.pairs, all, scene, task.path + ": collisions.pairs");
  const std::vector<bool> ignored = named(task.ignore, all, scene, task.path + ": collisions.ignore");
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((task.pairs.empty() || wanted[i]) && !ignored[i]) pairs.push_back(all[i]);
  return pairs;
}

namespace {

Eigen::VectorXd spreadOf(const SearchRoom& room, const Kinematics& kinematics) {
  Eigen::VectorXd spread = Eigen::VectorXd::Constant(kinematics.size(), kInfinity);
  for (const Eigen::Index i : room.narrowed) {
    const double neutral = kinematics.neutral()[i];
    spread[i] = std::max(room.upper[i] - neutral, neutral - room.lower[i]);
  }
  return spread;
}

// The problem without collisions, for a task whose base is at the origin.
PostureSetup placed(const PostureTask& task, const PostureScene& scene) {
  const auto kinematics = std::make_shared<const Kinematics>(scene.robot, task.base);
  PostureSetup setup;
  setup.start = startOf(task, scene, *kinematics);
  setup.spread = spreadOf(searchRoom(*kinematics, *scene.geometry, scene.obstacles), *kinematics);
  setup.problem =
      std::make_shared<PostureProblem>(kinematics, costOf(task, *kinematics, setup.start), setup.start);
  for (std::size_t i = 0; i < task.placements.size(); ++i) {
    const std::string where = task.path + ": placements[" + std::to_string(i) + "]";
    Placement placement = task.placements[i].placement;
    placement.link = linkNamed(task.placements[i].link, scene, where + ".link");
    setup.problem->add(
        within(where, [&] { return std::make_shared<PlacementRows>(*kinematics, placement); }));
  }
  if (task.contacts.empty()) return setup;
  const std::string where = task.path + ": stability";
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < task.contacts.size(); ++i)
    contacts.push_back(
        {linkNamed(task.contacts[i].link, scene, where + ".contacts[" + std::to_string(i) + "].link"),
         task.contacts[i].points});
  const auto stability = within(where, [&] {
    return std::make_shared<StaticStability>(kinematics, contacts, task.stabilityMargin,
                                             setup.problem->variables(), task.toWorld);
  });
  setup.problem->addVariables(stability->weights());
  setup.problem->add(stability);
  if (const auto room = stability->room()) setup.problem->add(room);
  return setup;
}

}  // namespace

PostureSetup setUpWithoutCollisions(const PostureTask& task, const PostureScene& scene) {
  const auto [moved, around] = withBaseAtOrigin(task, scene);
  return placed(moved, around);
}

PostureSetup setUp(const PostureTask& asked, const PostureScene& given, double influence) {
  const std::pair<PostureTask, PostureScene> moved = withBaseAtOrigin(asked, given);
  const PostureTask& task = moved.first;
  const PostureScene& scene = moved.second;
  PostureSetup setup = placed(task, scene);
  setup.pairs = pairsOf(task, scene);
  const std::shared_ptr<const Kinematics> kinematics = setup.problem->sharedKinematics();
  std::vector<CheckedPair> moving, still;
  for (const CheckedPair& pair : setup.pairs) {
    const LinkPair links = linksOf(pair, *scene.geometry);
    const bool moves = !(pair.obstacle ? kinematics->dependence(links.link1)
                                       : kinematics->dependence(links.link1, links.link2))
                            .empty();
    (moves ? moving : still).push_back(pair);
  }
  setup.problem->addUnavoidable(nearerThan(task.collisionMargin, still, scene, kinematics, setup.start));
  if (moving.empty()) return setup;
  // The lengths over which rows are exact and pairs have influence begin at the margin (or at 0, if it is
  // negative). So they are the same as without a margin.
  const double from = std::max(0.0, task.collisionMargin);
  ConstraintOptions options;
  options.influence = from + influence;
  options.exactUpTo = from + influence / 2;
  options.obstacles = scene.obstacles;
  setup.problem->add(std::make_shared<CollisionRows>(
      CollisionConstraints(kinematics, scene.geometry, moving, std::move(options)),
      task.collisionMargin + kBeyondMargin));
  return setup;
}

}  // namespace fcl_stpbv
