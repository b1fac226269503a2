// Microseconds of queries of a body against a mesh of many triangles or an octree, by fcl_stpbv and by FCL.
// The two take turns. For the table of docs/fcl.md.
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Json = nlohmann::ordered_json;

namespace {

/// A closed bumpy surface about 0.6 m across, of 4 n (n - 1) triangles.
Geometry bumpySurface(int n) {
  const double pi = std::acos(-1.0);
  std::vector<Vector3d> points;
  std::vector<fcl::Triangle> triangles;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double a = pi * i / n, b = pi * j / n;
      const double radius = 0.3 * (1 + 0.05 * std::sin(7 * b) * std::sin(a) * std::cos(5 * a));
      points.emplace_back(radius * std::sin(a) * std::cos(b), 0.7 * radius * std::sin(a) * std::sin(b),
                          1.3 * radius * std::cos(a));
    }
  const auto at = [n](int i, int j) { return static_cast<std::size_t>(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i < n - 1) triangles.emplace_back(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  mesh->beginModel();
  mesh->addSubModel(points, triangles);
  mesh->endModel();
  return mesh;
}

/// Poses turned at random, with the origins `away` apart (m).
benchmark::Poses posesAt(double away, int count) {
  Random random(7);
  benchmark::Poses poses;
  for (int i = 0; i < count; ++i) {
    poses.a.push_back(pose(random.rotation(), {0, 0, 0}));
    poses.b.push_back(pose(random.rotation(), away * random.direction()));
  }
  return poses;
}

#if FCL_HAVE_OCTOMAP
/// A map of a room 2.4 m wide and 1 m high, with cells of 5 cm: its floor, a wall, and 300 cells in random
/// places. The other cells are known to be free.
Geometry roomMap() {
  constexpr int kWide = 48, kHigh = 20;
  auto cells = std::make_shared<octomap::OcTree>(0.05);
  const auto mark = [&](int i, int j, int k, bool occupied) {
    const auto at = [](int cell) { return 0.05F * (static_cast<float>(cell) + 0.5F); };
    cells->updateNode(octomap::point3d(at(i - kWide / 2), at(j - kWide / 2), at(k)), occupied);
  };
  for (int i = 0; i < kWide; ++i)
    for (int j = 0; j < kWide; ++j)
      for (int k = -1; k < kHigh; ++k) mark(i, j, k, k < 0 || j == 0);
  Random random(4);
  for (int i = 0; i < 300; ++i)
    for (int seen = 0; seen < 4; ++seen)  // often enough to override the known free space
      mark(random.below(kWide), random.below(kWide), random.below(kHigh), true);
  cells->updateInnerOccupancy();
  cells->prune();
  return std::make_shared<fcl::OcTreed>(cells);
}

/// Poses anywhere over the map's floor, at heights from `low` to 0.3 m more, turned at random.
benchmark::Poses posesOver(double low, int count) {
  Random random(7);
  benchmark::Poses poses;
  for (int i = 0; i < count; ++i) {
    const Vector3d place(random.uniform(-1, 1), random.uniform(-1, 1), low + random.uniform(0, 0.3));
    poses.a.push_back(pose(random.rotation(), place));
    poses.b.push_back(Isometry3d::Identity());
  }
  return poses;
}
#endif

/// `asked`: "distance", a contact, or yes or no. FCL gets the hull of an STP-BV.
Json figures(const Geometry& body, const Geometry& surface, const benchmark::Poses& poses,
             const char* asked) {
  const bool isDistance = std::string(asked) == "distance";
  const fcl::CollisionRequestd contacts(1, std::string(asked) == "contact");
  const fcl::DistanceRequestd points(true);
  const auto ask = [&](const auto& distances, const auto& collides) {
    return [&, distances, collides](std::size_t i) {
      const Isometry3d &a = poses.a[i], &b = poses.b[i];
      fcl::DistanceResultd distance;
      fcl::CollisionResultd collision;
      if (isDistance)
        distances(body.get(), a, surface.get(), b, points, distance);
      else
        collides(body.get(), a, surface.get(), b, contacts, collision);
    };
  };
  const auto fcls =
      ask([](auto&&... all) { fcl::distance(all...); }, [](auto&&... all) { fcl::collide(all...); });
  const auto ours = ask([](auto&&... all) { fcl_stpbv::distance(all...); },
                        [](auto&&... all) { fcl_stpbv::collide(all...); });
  const std::vector<double> ns = benchmark::mediansInTurns(5, poses.a.size(), {fcls, ours});
  return {{"us_fcl", benchmark::significant(1e-3 * ns[0], 3)},
          {"us", benchmark::significant(1e-3 * ns[1], 3)}};
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Times of queries of bodies against meshes beside FCL's own: a JSON object a line",
                     "mesh_figures");
  int queries = 100;
  app.option("QUERIES", queries, "a body and a place").whole(1).shown();
  return benchmark::runBenchmark(app, argc, argv, "meshes", [&](benchmark::Measurement& result) {
    const auto measure = [&](const std::string& surface, const Geometry& geometry, const Geometry& mesh,
                             const char* place, const benchmark::Poses& poses) {
      const std::vector<std::pair<const char*, Geometry>> bodies{
          {"STP-BV",
           std::make_shared<StpBvGeometry>(StpBv::build(randomHull(60, {0.2, 0.2, 0.25}, 3), {0.01, 10}))},
          {"box", std::make_shared<fcl::Boxd>(0.4, 0.4, 0.5)},
          {"cylinder", std::make_shared<fcl::Cylinderd>(0.2, 0.4)},
          {"ball", std::make_shared<fcl::Sphered>(0.2)},
          {"mesh", mesh}};
      for (const char* asked : {"distance", "contact", "yes or no"})
        for (const auto& [name, body] : bodies) {
          Json row{{"surface", surface}, {"body", name}, {"place", place}, {"asked", asked}};
          row.update(figures(body, geometry, poses, asked));
          result.add(std::move(row));
        }
    };
    for (const auto& [n, name] : {std::pair(10, "360 triangles"), {100, "39,600 triangles"}}) {
      const Geometry mesh = bumpySurface(n);
      measure(name, mesh, mesh, "meets", posesAt(0.3, queries));
      measure(name, mesh, mesh, "apart", posesAt(0.8, queries));
    }
#if FCL_HAVE_OCTOMAP
    const Geometry map = roomMap(), mesh = bumpySurface(10);
    measure("octree", map, mesh, "meets", posesOver(0.0, queries));
    measure("octree", map, mesh, "apart", posesOver(1.5, queries));
#endif
  });
}
