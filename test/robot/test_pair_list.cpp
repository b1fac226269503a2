// Reasons for leaving pairs out: on robots for which they are obvious, and on real ones.
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <limits>
#include <set>

#include "fcl_stpbv/robot/neutral_posture.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_list_again.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"
#include "test/robot/arm.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

// Three bars of 0.2 m in a row, on z axes 0.25 m apart. Each joint turns by up to `limit` in both directions.
// At 1 rad the third bar comes near the first one but cannot touch it.
Arm bars(double limit) {
  const TemporaryFolder folder;
  std::string bar;
  for (const Eigen::Vector3d& p : box(0.2, 0.02, 0.02))
    bar += "v " + std::to_string(p.x() + 0.125) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
           "\n";
  put(folder / "bar.obj", bar + "f 1 2 3\nf 1 3 5\nf 2 4 6\nf 5 6 7\nf 7 8 3\n");
  const std::string mesh = "<mesh filename=\"bar.obj\"/>", half = std::to_string(limit);
  const auto turn = [&](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name +
           "\" type=\"revolute\"><origin xyz=\"0.25 0 0\"/><axis xyz=\"0 0 1\"/><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/><limit lower=\"-" + half + "\" upper=\"" + half +
           "\" effort=\"1\" velocity=\"1\"/></joint>";
  };
  put(folder / "r.urdf", robot(link("a", mesh) + link("b", mesh) + link("c", mesh) + turn("j1", "a", "b") +
                               turn("j2", "b", "c")));
  return armFrom(load({"", folder / "r.urdf", "", {}}));
}

}  // namespace

TEST_CASE("a pair that cannot meet is proven never, one that can comes with the configuration") {
  PairListOptions options;
  options.samples = 50;
  options.proofSeconds = 20;
  for (const double limit : {1.0, 2.9}) {
    const Arm arm = bars(limit);
    const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
    REQUIRE(list.size() == 3);
    CHECK(list[0].reason == PairReason::adjacent);
    const PairEntry& ends = list[1];
    PairSearch search(arm.kinematics, arm.geometry, {0, 2});
    CHECK(search.distance(ends.closest) == Approx(ends.minDistance).margin(1e-12));
    if (limit < 2) {
      CHECK(ends.reason == PairReason::neverProven);
    } else {
      CHECK(ends.reason == PairReason::sometimes);
      CHECK(ends.minDistance < 0);
    }
  }
}

TEST_CASE("a proof without a limit of boxes is a proof, and one that no box can bring on ends at once") {
  const Arm arm = bars(1.0);
  PairListOptions options;
  options.samples = 10;
  options.proofBoxes = std::numeric_limits<long>::max();
  CHECK(pairList(arm.kinematics, arm.geometry, nullptr, options)[1].reason == PairReason::neverProven);
  // There is no bound for bodies across a planar joint.
  const std::string ball = "<sphere radius=\"0.1\"/>";
  const Arm planar = armFrom(
      parsed(robot(link("a", ball) + link("m", ball) + link("b", ball) +
                   joint("p", "planar", "a", "m", "<origin xyz=\"0 0 1\"/><axis xyz=\"0 0 1\"/>") +
                   joint("j", "revolute", "m", "b", "<origin xyz=\"0 0 0.5\"/><axis xyz=\"0 0 1\"/>"))));
  options.proofBoxes = 200;
  options.proofSeconds = 60;
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<PairEntry> list = pairList(planar.kinematics, planar.geometry, nullptr, options);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(30));
  CHECK(list[1].reason == PairReason::neverSampled);
}

TEST_CASE("adjacent links that an SRDF has checked are searched like all others") {
  // Two boxes on either side of a joint, apart at zero. At -2 rad one is where the other is.
  const std::string beside =
      "<collision><origin xyz=\"0.3 0 0\"/><geometry><box size=\"0.4 0.1 0.1\"/>"
      "</geometry></collision></link>";
  const Arm arm = armFrom(
      parsed(robot("<link name=\"a\">" + beside + "<link name=\"b\">" + beside +
                   joint("j", "revolute", "a", "b", "<origin rpy=\"0 0 2\"/><axis xyz=\"0 0 1\"/>", 3))));
  const auto searched = [&](const Srdf* srdf) {
    return pairList(arm.kinematics, arm.geometry, srdf).front();
  };
  Srdf checked, leftOut;
  leftOut.disabled.push_back({"a", "b", "Adjacent"});
  CHECK(searched(&checked).reason == PairReason::adjacent);
  CHECK(searched(&checked).minDistance < 0);
  PairSearch search(arm.kinematics, arm.geometry, {0, 1});
  CHECK(search.distance(searched(&checked).closest) == Approx(searched(&checked).minDistance).margin(1e-12));
  for (const Srdf* srdf : {static_cast<const Srdf*>(nullptr), static_cast<const Srdf*>(&leftOut)}) {
    CHECK(searched(srdf).reason == PairReason::adjacent);
    // Found in the neutral configuration, the only one that is examined.
    CHECK(searched(srdf).minDistance > 0);
  }
}

TEST_CASE("a descent finds the collision that few samples miss") {
  const Arm arm = bars(2.9);
  PairListOptions options;
  options.samples = 3;
  const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
  CHECK(list[1].reason == PairReason::sometimes);
  CHECK(list[1].minDistance < 0);
}

TEST_CASE("obstacles enter the search: met with the configuration, or proven out of reach") {
  const Arm arm = bars(1.0);  // reaches 0.735 m from the origin along x
  const auto ball = std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.1, 2)));
  const auto at = [&](const std::shared_ptr<fcl::CollisionGeometryd>& geometry, double x, double y) {
    fcl::CollisionObjectd object(geometry);
    object.setTranslation(Eigen::Vector3d(x, y, 0));
    return obstacleOf(object, "obstacle");
  };
  PairListOptions options;
  options.samples = 20;
  options.proofSeconds = 20;
  options.obstacles = {at(ball, 0.35, 0.25), at(ball, 0, 1.2),
                       at(std::make_shared<fcl::Sphered>(0.1), 0.35, 0.25)};
  const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
  REQUIRE(list.size() == 3 + 2 * 3);  // the first bar does not move
  for (const PairEntry& entry : list) {
    if (!entry.obstacle) continue;
    INFO("link " << entry.link1 << ", obstacle " << entry.link2);
    PairSearch search(arm.kinematics, arm.geometry, entry, options.obstacles);
    CHECK(search.distance(entry.closest) == Approx(entry.minDistance).margin(1e-12));
    if (entry.link2 == 1) {
      CHECK(entry.reason == PairReason::neverProven);
      CHECK(entry.minDistance > 0.3);
    } else {
      CHECK(entry.reason == PairReason::sometimes);
      CHECK(entry.minDistance <= 0);
    }
  }
  CHECK(toSrdf(arm.kinematics->robot(), list).size() == 3);
}

TEST_CASE("a search with an obstacle takes the parts of its own pair, not those of another obstacle's") {
  const Arm arm = bars(1);
  RobotGeometry geometry = *arm.geometry;
  Body part = geometry.bodies.back();
  part.partOf = 2;
  geometry.bodies.back().parts = 1;
  geometry.bodies.push_back(part);
  geometry.byParts = {{2, 1, true}};
  const auto both = std::make_shared<const RobotGeometry>(geometry);
  const Obstacle ball("ball", std::make_shared<fcl::Sphered>(0.1));
  for (const int obstacle : {0, 1}) {
    const PairSearch search(arm.kinematics, both, {2, obstacle, true}, {ball, ball});
    REQUIRE(search.constraints().pairs().size() == 1);
    CHECK(search.constraints().pairs()[0].body == 2 + obstacle);
  }
}

TEST_CASE("what is proven never stays apart in samples and descents of another seed") {
  for (const TestRobot& robot : robots()) {
    const Arm arm = armFrom(load(robot));
    INFO(robot.name);
    PairListOptions options;
    options.samples = 200;
    options.randomDescents = 0;
    const auto isProven = [](const PairEntry& entry) { return entry.reason == PairReason::neverProven; };
    std::vector<PairEntry> list;
    std::ptrdiff_t proven = 0;
    for (const double seconds : {3, 12, 48}) {  // a slow machine, or one under a sanitizer, needs longer
      options.proofSeconds = seconds;
      list = pairList(arm.kinematics, arm.geometry, nullptr, options);
      proven = std::count_if(list.begin(), list.end(), isProven);
      if (proven >= 10) break;
    }
    Random random(23);
    for (const PairEntry& entry : list) {
      if (!isProven(entry)) continue;
      PairSearch search(arm.kinematics, arm.geometry, entry);
      Eigen::VectorXd q(arm.kinematics->size());
      for (int trial = 0; trial < 10; ++trial) {
        for (int k = 0; k < q.size(); ++k)
          q[k] = random.uniform(arm.kinematics->lower()[k], arm.kinematics->upper()[k]);
        CHECK(search.descend(q, 0) > 0);
      }
    }
    CHECK(proven >= 10);
  }
}

TEST_CASE("a proven pair has the closest configuration of all, not of one valley") {
  // A wheel with two knobs at +-90 degrees passes a ball. The larger knob comes nearer.
  const auto knob = [](const std::string& at, const std::string& radius) {
    return "<collision><origin xyz=\"" + at + "\"/><geometry><sphere radius=\"" + radius +
           "\"/></geometry></collision>";
  };
  const Arm arm = armFrom(parsed(robot(
      "<link name=\"ball\">" + knob("1.5 0 0", "0.1") + "</link>" + link("hub", "<sphere radius=\"0.1\"/>") +
      "<link name=\"wheel\">" + knob("0 1 0", "0.1") + knob("0 -1 0", "0.12") + "</link>" +
      joint("aim", "revolute", "ball", "hub", "<axis xyz=\"0 0 1\"/>") +
      joint("turn", "revolute", "hub", "wheel", "<axis xyz=\"0 0 1\"/>", 3))));
  PairListOptions options;
  options.samples = options.descents = 1;
  for (options.seed = 1; options.seed <= 8; ++options.seed) {
    const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
    REQUIRE(list.size() == 3);
    CHECK(list[1].reason == PairReason::neverProven);
    CHECK(list[1].minDistance == Approx(0.28).margin(1e-6));
  }
}

TEST_CASE("robots of many pairs and coordinates get fewer random descents for each pair") {
  const auto closestOf = [](int links, int randomDescents) {
    std::string parts = link("base");  // discs above each other, which never meet
    for (int i = 0; i < links; ++i) {
      const std::string number = std::to_string(i), height = std::to_string(0.3 * i);
      parts += link("l" + number, "<box size=\"0.3 0.2 0.1\"/>") +
               joint("j" + number, "planar", "base", "l" + number,
                     "<origin xyz=\"0 0 " + height + "\"/><axis xyz=\"0 0 1\"/>");
    }
    const Arm arm = armFrom(parsed(robot(parts)));
    PairListOptions options;
    options.samples = 5;
    options.descents = 0;
    options.randomDescents = randomDescents;
    Eigen::VectorXd distances(0);
    for (const PairEntry& entry : pairList(arm.kinematics, arm.geometry, nullptr, options)) {
      CHECK(entry.reason == PairReason::neverSampled);
      distances.conservativeResize(distances.size() + 1);
      distances[distances.size() - 1] = entry.minDistance;
    }
    return distances;
  };
  // 1770 pairs with 180 coordinates: a third of the descents, which is one.
  CHECK(closestOf(60, 3) == closestOf(60, 1));
  CHECK(closestOf(10, 3) != closestOf(10, 1));
}

TEST_CASE("pairs that are searched again come out as in a search of all, the others are kept as they were") {
  const Arm arm = armFrom(load(robots()[0]));
  PairListOptions options;
  options.samples = 30;
  options.randomDescents = 5;
  const std::vector<PairEntry> all = pairList(arm.kinematics, arm.geometry, nullptr, options);
  std::vector<PairEntry> before = all;
  std::set<LinkPair> changed;
  for (std::size_t e = 0; e < all.size(); ++e) {
    if (e % 3 != 0) continue;
    before[e].reason = PairReason::user;  // a value that a search would not give here
    before[e].minDistance = before[e].security = 1e9;
    before[e].closest = Eigen::VectorXd();
    if (e % 2 == 0) changed.insert(all[e]);
  }
  const std::vector<PairEntry> again =
      pairListAgain(arm.kinematics, arm.geometry, nullptr, options, before, changed);
  REQUIRE(again.size() == all.size());
  REQUIRE(changed.size() > 2);
  for (std::size_t e = 0; e < all.size(); ++e) {
    const PairEntry& expected = changed.count(all[e]) > 0 ? all[e] : before[e];
    CHECK(again[e].reason == expected.reason);
    CHECK(again[e].minDistance == expected.minDistance);
    CHECK(again[e].collisions == expected.collisions);
    CHECK(again[e].closest == expected.closest);
    CHECK(again[e].neutralDistance == expected.neutralDistance);
    CHECK(again[e].security == expected.security);
    CHECK(again[e].boxes == expected.boxes);
  }
}

TEST_CASE("no slope of the distance exceeds its Lipschitz bound") {
  const auto ball = std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.1, 2)));
  fcl::CollisionObjectd object(ball);
  object.setTranslation(Eigen::Vector3d(0.5, 0.7, 0.9));
  const std::vector<Obstacle> obstacles{obstacleOf(object, "ball")};
  for (const TestRobot& robot : robots()) {
    const Arm arm = armFrom(load(robot));
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
      const int count = static_cast<int>(arm.geometry->bodies.size());
      const int i = arm.geometry->bodies[static_cast<std::size_t>(random.below(count))].link;
      const int j = arm.geometry->bodies[static_cast<std::size_t>(random.below(count))].link;
      if (i == j) continue;
      const bool obstacle = trial % 4 == 0 && moves(arm.kinematics->robot(), i);
      PairSearch search(arm.kinematics, arm.geometry, {i, obstacle ? 0 : j, obstacle}, obstacles);
      Eigen::VectorXd q(arm.kinematics->size());
      for (int k = 0; k < q.size(); ++k)
        q[k] = random.uniform(arm.kinematics->lower()[k], arm.kinematics->upper()[k]);
      const double here = search.distance(q);
      for (std::size_t k = 0; k < search.coordinates().size(); ++k) {
        Eigen::VectorXd near = q;
        near[search.coordinates()[k]] += 1e-3;
        const double there = search.distance(near);
        if (here <= 0 || there <= 0) continue;  // FCL's boxes are cut off at 0
        CHECK(std::abs(there - here) <= search.lipschitz()[k] * 1e-3 + 1e-9);
      }
    }
  }
}

TEST_CASE("the list is the same for the same seed, sorted, and keeps the user's entries") {
  const TestRobot robot = robots()[0];
  const Arm arm = armFrom(load(robot));
  const Srdf srdf = loadSrdf(robot.srdf, arm.kinematics->robot());
  PairListOptions options;
  options.samples = 100;
  options.randomDescents = 20;
  const std::vector<PairEntry> once = pairList(arm.kinematics, arm.geometry, &srdf, options);
  options.threads = 3;
  const std::vector<PairEntry> again = pairList(arm.kinematics, arm.geometry, &srdf, options);
  REQUIRE(once.size() == 465);
  int user = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    CHECK(once[i].reason == again[i].reason);
    CHECK(once[i].minDistance == again[i].minDistance);
    CHECK(once[i].closest == again[i].closest);
    CHECK(once[i].boxes == again[i].boxes);
    user += once[i].reason == PairReason::user;
  }
  CHECK(user == 266);
  const std::vector<Srdf::Pair> pairs = toSrdf(arm.kinematics->robot(), once);
  for (std::size_t i = 1; i < pairs.size(); ++i)
    CHECK(std::make_pair(pairs[i - 1].link1, pairs[i - 1].link2) <
          std::make_pair(pairs[i].link1, pairs[i].link2));
}

namespace {

// A ball, a bar that turns about its middle, a ball on the bar that touches the first one at zero and swings
// away, and a ball that stays inside the first one at any angle.
Arm folded() {
  const auto turn = [](const std::string& name, const std::string& parent, const std::string& child,
                       const std::string& origin) {
    return joint(name, "revolute", parent, child, "<origin xyz=\"" + origin + "\"/><axis xyz=\"0 0 1\"/>");
  };
  const auto ball = [](const std::string& radius) { return "<sphere radius=\"" + radius + "\"/>"; };
  const std::string bar = "<box size=\"0.6 0.02 0.02\"/>";
  const std::string text = robot(
      link("a", ball("0.1")) + link("b", bar) + link("elbow") + link("c", ball("0.05")) +
      link("d", ball("0.05")) + turn("j1", "a", "b", "0 0 0") + turn("j2", "b", "elbow", "0.3 0 0") +
      joint("j3", "fixed", "elbow", "c", "<origin xyz=\"-0.25 0 0\"/>") + turn("j4", "b", "d", "0 0 0.05"));
  return armFrom(parsed(text));
}

const PairEntry& entryOf(const Arm& arm, const std::vector<PairEntry>& list, const std::string& one,
                         const std::string& other) {
  const RobotModel& robot = arm.kinematics->robot();
  const int a = robot.link(one), b = robot.link(other);
  return *std::find_if(list.begin(), list.end(), [&](const PairEntry& e) {
    return !e.obstacle && ((e.link1 == a && e.link2 == b) || (e.link1 == b && e.link2 == a));
  });
}

}  // namespace

TEST_CASE("what collides in the neutral posture stays checked where some posture clears it") {
  const Arm arm = folded();
  for (const int samples : {1, 50}) {  // with one sample only the climb can find it
    PairListOptions options;
    options.samples = samples;
    const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
    CHECK(entryOf(arm, list, "a", "c").reason == PairReason::defaultClears);
    CHECK(entryOf(arm, list, "a", "d").reason == PairReason::byDefault);
    const auto writes = [&](bool defaultToo, const std::string& other) {
      const std::vector<Srdf::Pair> pairs = toSrdf(arm.kinematics->robot(), list, defaultToo);
      return std::count_if(pairs.begin(), pairs.end(), [&](const Srdf::Pair& p) {
        return p.link1 == "a" && p.link2 == other && p.reason == "Default";
      });
    };
    CHECK(writes(false, "c") == 0);
    CHECK(writes(true, "c") == 1);
    CHECK(writes(false, "d") == 1);
    const std::vector<CheckedPair> checked = checkedPairs(*arm.geometry, list);
    CHECK(std::any_of(checked.begin(), checked.end(), [&](const CheckedPair& pair) {
      return arm.geometry->bodies[static_cast<std::size_t>(pair.body)].name == "a" &&
             arm.geometry->bodies[static_cast<std::size_t>(pair.other)].name == "c";
    }));
  }
}

TEST_CASE("what is clear in the neutral posture stays checked where nearly all others make it collide") {
  const std::string arm =
      link("joint", "<sphere radius=\"0.01\"/>") +
      "<link name=\"arm\"><collision><origin xyz=\"0.5 0 0\"/><geometry>"
      "<sphere radius=\"0.05\"/></geometry></collision></link>"
      "<joint name=\"j\" type=\"revolute\"><parent link=\"base\"/><child link=\"joint\"/>"
      "<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"0.1\" effort=\"1\" velocity=\"1\"/></joint>" +
      joint("f", "fixed", "joint", "arm");
  const auto slab = [](const std::string& name) {
    return "<link name=\"" + name +
           "\"><collision><origin xyz=\"0 -0.56 0\"/><geometry>"
           "<box size=\"4 1 1\"/></geometry></collision></link>";
  };
  const auto load = [&](const std::string& text) { return armFrom(parsed(robot(text))); };
  const Arm itself = load(slab("base") + arm), beside = load(link("base") + arm), scene = load(slab("slab"));
  for (const bool obstacle : {false, true}) {
    const Arm& one = obstacle ? beside : itself;
    PairListOptions options;
    if (obstacle)
      options.obstacles =
          obstaclesOf(std::make_shared<const RobotModel>(scene.kinematics->robot()), *scene.geometry);
    const std::vector<PairEntry> list = pairList(one.kinematics, one.geometry, nullptr, options);
    const int moved = one.kinematics->robot().link("arm");
    const auto entry = std::find_if(list.begin(), list.end(), [&](const PairEntry& e) {
      return e.obstacle == obstacle && (e.link1 == moved || (!obstacle && e.link2 == moved)) &&
             e.reason != PairReason::rigid;
    });
    REQUIRE(entry != list.end());
    CHECK(entry->reason == PairReason::always);
    const std::vector<CheckedPair> checked = checkedPairs(*one.geometry, list),
                                   own = bodiesOf(*one.geometry, *entry);
    CHECK(std::any_of(checked.begin(), checked.end(), [&](const CheckedPair& pair) {
      return pair.body == own[0].body && pair.other == own[0].other && pair.obstacle == own[0].obstacle;
    }));
    for (const bool defaultToo : {false, true}) {
      const std::vector<Srdf::Pair> out = toSrdf(one.kinematics->robot(), list, defaultToo);
      CHECK(std::any_of(out.begin(), out.end(), [](const Srdf::Pair& p) { return p.reason == "Always"; }) ==
            (defaultToo && !obstacle));
    }
  }
}

TEST_CASE(
    "few samples do not say that a pair always collides, nor half a turn that a geared one never does") {
  // The sphere hits the box near half a turn of its arm, which turns at a fraction of the wheel's speed.
  const std::string drive =
      link("base", "<box size=\"0.1 0.1 0.1\"/>") + link("drive") + link("arm", "<sphere radius=\"0.05\"/>");
  const auto armOf = [&](const std::string& ratio) {
    return armFrom(parsed(
        robot(drive +
              "<joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"drive\"/></joint>"
              "<joint name=\"m\" type=\"continuous\"><parent link=\"drive\"/><child link=\"middle\"/>"
              "<origin xyz=\"0.5 0 0\"/><axis xyz=\"0 0 1\"/><mimic joint=\"k\" multiplier=\"" +
              ratio +
              "\"/></joint><joint name=\"k\" type=\"continuous\"><parent link=\"base\"/>"
              "<child link=\"wheel\"/></joint>"
              "<joint name=\"f\" type=\"revolute\"><parent link=\"middle\"/><child link=\"arm\"/>"
              "<origin xyz=\"0.5 0 0\"/><limit lower=\"-0.1\" upper=\"0.1\" effort=\"1\" "
              "velocity=\"1\"/></joint>" +
              link("middle") + link("wheel"))));
  };
  for (const char* ratio : {"1", "0.5", "0.25"}) {
    const Arm arm = armOf(ratio);
    PairListOptions options;
    const PairEntry entry =
        entryOf(arm, pairList(arm.kinematics, arm.geometry, nullptr, options), "base", "arm");
    CAPTURE(ratio, reasonText(entry.reason));
    CHECK(entry.reason == PairReason::sometimes);
  }
  // Clear in the neutral posture only, or almost only there.
  const Arm bar = bars(3.1);
  for (const int samples : {1, 5, 59}) {
    PairListOptions options;
    options.samples = samples;
    options.margin = 0.2;
    options.alwaysFraction = 0;
    for (const PairEntry& entry : pairList(bar.kinematics, bar.geometry, nullptr, options))
      CHECK(entry.reason != PairReason::always);
  }
}

TEST_CASE("what has no limits is searched as far as the robot reaches") {
  const auto reasonFor = [](const std::string& still, const std::string& moves, const std::string& type) {
    GeometryOptions options;
    options.radii = {0.01, 1000};
    const Arm arm = armFrom(parsed(
        robot("<link name=\"still\">" + still + "</link>" + link("between") + link("moves", moves) +
              joint("free", type, "still", "between", type == "planar" ? "<axis xyz=\"0 0 1\"/>" : "") +
              joint("turn", "revolute", "between", "moves")),
        options));
    PairListOptions list;
    list.samples = 200;
    return entryOf(arm, pairList(arm.kinematics, arm.geometry, nullptr, list), "still", "moves").reason;
  };
  const auto block = [](const std::string& at, const std::string& size) {
    return "<collision><origin xyz=\"" + at + "\"/><geometry><box size=\"" + size +
           "\"/></geometry></collision>";
  };
  for (const char* type : {"planar", "floating"}) {
    CAPTURE(type);
    // A shelf in the far corner of a hall, and the same scene a hundred times as large.
    CHECK(reasonFor(block("200 100 0", "1 1 1"), "<box size=\"1 1 1\"/>", type) == PairReason::sometimes);
    CHECK(reasonFor(block("20000 10000 0", "100 100 100"), "<box size=\"100 100 100\"/>", type) ==
          PairReason::sometimes);
    // A slot that is narrow within 1 m of the robot, and open 4.5 m away.
    CHECK(reasonFor(block("0 2.65 0", "9 5 9") + block("0 -2.65 0", "9 5 9"), "<box size=\"0.2 0.2 0.2\"/>",
                    type) == PairReason::sometimes);
  }
}

TEST_CASE("another neutral posture is another default, and a better one is suggested") {
  const Arm arm = folded();
  PairListOptions options;
  options.samples = 50;
  options.neutral = arm.kinematics->neutral();
  options.neutral[arm.kinematics->coordinate("j2")] = 1;
  const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
  CHECK(entryOf(arm, list, "a", "c").reason == PairReason::sometimes);
  Srdf srdf;
  // An invalid posture, or only a part of one that contradicts another group, is not suggested, and does not
  // prevent other suggestions.
  srdf.states = {{"wrong", "arm", {{"j2", {1.0, 2.0}}}},
                 {"half", "arm", {{"j2", {1.0}}}},
                 {"half", "other", {{"j1", {0.0}}}},
                 {"half", "third", {{"j2", {0.0}}}},
                 {"open", "arm", {{"j2", {1.0}}}}};
  const NeutralPosture zero =
      judgeNeutral(arm.kinematics, arm.geometry, list, arm.kinematics->neutral(), &srdf, 0);
  CHECK(zero.state == "open");
  CHECK(zero.collidingThere < zero.colliding);
  const NeutralPosture bare =
      judgeNeutral(arm.kinematics, arm.geometry, list, arm.kinematics->neutral(), nullptr, 0);
  CHECK(bare.state.empty());
  CHECK(bare.collidingThere == zero.collidingThere);
  REQUIRE(bare.better.size() == arm.kinematics->size());
  CHECK(judgeNeutral(arm.kinematics, arm.geometry, list, bare.better, nullptr, 0).colliding ==
        bare.collidingThere);
}

TEST_CASE(
    "collisions in far corners of the joints' ranges are found with the default options, whatever the seed") {
  const TestRobot robot = robots()[0];
  const Arm arm = armFrom(load(robot));
  const std::vector<std::pair<std::string, std::string>> rare{{"RLEG_LINK5", "CHEST_LINK1"},
                                                              {"LLEG_LINK5", "CHEST_LINK1"},
                                                              {"RLEG_LINK1", "LARM_LINK4"},
                                                              {"RLEG_LINK3", "HEAD_LINK1"}};
  const auto isRare = [&](const std::string& a, const std::string& b) {
    return std::any_of(rare.begin(), rare.end(), [&](const auto& pair) {
      return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
    });
  };
  Srdf srdf;  // these pairs only
  for (const LinkModel& one : arm.kinematics->robot().links)
    for (const LinkModel& other : arm.kinematics->robot().links)
      if (!isRare(one.name, other.name)) srdf.disabled.push_back({one.name, other.name, "User"});
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    PairListOptions options;
    options.seed = seed;
    const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, &srdf, options);
    for (const auto& [one, other] : rare) {
      INFO(one << " - " << other << ", seed " << seed);
      const PairEntry& entry = entryOf(arm, list, one, other);
      CHECK(entry.reason == PairReason::sometimes);
      PairSearch search(arm.kinematics, arm.geometry, entry);
      CHECK(search.distance(entry.closest) <= 0);
    }
  }
}
