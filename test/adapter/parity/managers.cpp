// The seven broadphase managers with FCL's callbacks and with the library's, on the same balls and boxes.
#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/adapter/parity/questions.h"

namespace fcl_stpbv::parity {

using namespace test;
using Eigen::Vector3d;
using Manager = fcl::BroadPhaseCollisionManagerd;
using Object = fcl::CollisionObjectd;
using Make = std::function<std::unique_ptr<Manager>()>;

namespace {

struct Scene {
  std::vector<std::unique_ptr<Object>> objects;
  std::vector<std::vector<Piece>> pieces;
};

/// Balls and boxes at random places in a cube with this half side.
Scene sceneOf(int count, double half, std::uint64_t seed) {
  const std::vector<Type> all = allTypes();
  Random random(seed);
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const Type& type = all[i % 2 ? 0 : 3];
    const Vector3d place(random.uniform(-half, half), random.uniform(-half, half),
                         random.uniform(-half, half));
    scene.objects.push_back(std::make_unique<Object>(type.geometry, pose(random.rotation(), place)));
    scene.objects.back()->computeAABB();
    scene.pieces.push_back(type.pieces(scene.objects.back()->getTransform()));
  }
  return scene;
}

/// The number of colliding pairs and the least distance, over all pairs within `a`, or over all pairs of one
/// object of `a` and one of `b`.
struct Expected {
  std::size_t contacts = 0;
  double least = std::numeric_limits<double>::max();
};
Expected expectedOf(const Scene& a, const Scene& b) {
  Expected expected;
  for (std::size_t i = 0; i < a.pieces.size(); ++i)
    for (std::size_t j = &a == &b ? i + 1 : 0; j < b.pieces.size(); ++j) {
      const Truth truth = truthOf(a.pieces[i], b.pieces[j]);
      expected.contacts += truth.overlap;
      expected.least = std::min(expected.least, truth.distance);
    }
  return expected;
}

std::vector<std::pair<std::string, Make>> managers() {
  using Hash = fcl::SpatialHashingCollisionManager<double>;
  return {{"naive", [] { return std::make_unique<fcl::NaiveCollisionManagerd>(); }},
          {"SSaP", [] { return std::make_unique<fcl::SSaPCollisionManagerd>(); }},
          {"SaP", [] { return std::make_unique<fcl::SaPCollisionManagerd>(); }},
          {"interval tree", [] { return std::make_unique<fcl::IntervalTreeCollisionManagerd>(); }},
          {"spatial hash",
           [] { return std::make_unique<Hash>(0.5, Vector3d::Constant(-5), Vector3d::Constant(5)); }},
          {"dynamic AABB tree", [] { return std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>(); }},
          {"the same as an array",
           [] { return std::make_unique<fcl::DynamicAABBTreeCollisionManager_Array<double>>(); }}};
}

enum class With { itself, object, manager };

/// Queries a manager in one of three ways.
template <class Ask>
void asked(const Make& make, const Scene& scene, const Scene& others, With with, const Ask& ask) {
  const std::unique_ptr<Manager> manager = make(), other = make();
  for (const auto& object : scene.objects) manager->registerObject(object.get());
  for (const auto& object : others.objects) other->registerObject(object.get());
  manager->setup();
  other->setup();
  ask(*manager, *other, *others.objects[0], with);
}

template <class Data, class Callback>
auto collideBy(Data& data, Callback callback) {
  return [&data, callback](Manager& m, Manager& other, Object& object, With with) {
    if (with == With::itself) m.collide(&data, callback);
    if (with == With::object) m.collide(&object, &data, callback);
    if (with == With::manager) m.collide(&other, &data, callback);
  };
}

template <class Data, class Callback>
auto distanceBy(Data& data, Callback callback) {
  return [&data, callback](Manager& m, Manager& other, Object& object, With with) {
    if (with == With::itself) m.distance(&data, callback);
    if (with == With::object) m.distance(&object, &data, callback);
    if (with == With::manager) m.distance(&other, &data, callback);
  };
}

void askManager(const Make& make, With with, Findings& found) {
  for (const double half : {2.0, 0.6}) {  // scattered, and crowded
    const Scene scene = sceneOf(30, half, 7), others = sceneOf(with == With::object ? 1 : 20, half, 8);
    const Expected expected = expectedOf(scene, with == With::itself ? scene : others);
    CollisionData ours;
    fcl::DefaultCollisionData<double> theirs;
    ours.request.num_max_contacts = theirs.request.num_max_contacts = 100000;
    asked(make, scene, others, with, collideBy(ours, collisionCallback));
    asked(make, scene, others, with, collideBy(theirs, fcl::DefaultCollisionFunction<double>));
    // One contact per pair, because no depth is requested. The manager decides which pairs there are.
    found.ours("pairs in contact", ours.result.numContacts() != theirs.result.numContacts());
    found.theirs('m', theirs.result.numContacts() < expected.contacts);
    found.theirs('t', theirs.result.numContacts() > expected.contacts);
    DistanceData nearest;
    fcl::DefaultDistanceData<double> theirNearest;
    asked(make, scene, others, with, distanceBy(nearest, distanceCallback));
    asked(make, scene, others, with, distanceBy(theirNearest, fcl::DefaultDistanceFunction<double>));
    const double d = nearest.result.distance, e = theirNearest.result.min_distance;
    const bool overlap = expected.least <= 0;
    found.ours("the nearest pair", overlap ? d > 0 : std::abs(d - expected.least) > 1e-9);
    found.theirs('d', overlap ? e > 0 : std::abs(e - expected.least) > 1e-6);
    // In a crowded scene the kept pair must be the deepest.
    double deepest = 0;
    if (overlap)
      for (std::size_t i = 0; i < scene.objects.size(); ++i)
        for (std::size_t j = with == With::itself ? i + 1 : 0;
             j < (with == With::itself ? scene : others).objects.size(); ++j)
          deepest = std::min(
              deepest,
              distance(*scene.objects[i], *(with == With::itself ? scene : others).objects[j]).distance);
    found.ours("the deepest pair", overlap && d > deepest + 1e-9);
    found.theirs('p', overlap && e > deepest + 1e-4);
  }
}

}  // namespace

std::string managerTable() {
  std::string text = "| manager | itself | an object | another manager |\n|---|---|---|---|\n";
  const std::vector<Type> types = allTypes();
  for (const auto& [name, make] : managers()) {
    text += "| " + name + " |";
    for (const With with : {With::itself, With::object, With::manager}) {
      const auto question = [&, &maker = make](const Type&, const Type&, int, Random&, Findings& found) {
        askManager(maker, with, found);
      };
      text += " " + cellsOf({{&types[0], &types[3]}}, question, 1)[0] + " |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace fcl_stpbv::parity
