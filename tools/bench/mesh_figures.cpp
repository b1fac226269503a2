// Microseconds of fcl_stpbv's queries of a body against a mesh of many triangles beside FCL's own, the two
// taking turns; for the table of docs/fcl.md.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>
#include <cstdio>
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

/// Turned at random, their origins `away` apart (m).
benchmark::Poses posesAt(double away, int count) {
  Random random(7);
  benchmark::Poses poses;
  for (int i = 0; i < count; ++i) {
    poses.a.push_back(pose(random.rotation(), {0, 0, 0}));
    poses.b.push_back(pose(random.rotation(), away * random.direction()));
  }
  return poses;
}

/// `distance`, else a contact or a yes or no. FCL sees an STP-BV's hull.
Json figures(const Geometry& body, const Geometry& mesh, const benchmark::Poses& poses, const char* asked) {
  const bool isDistance = std::string(asked) == "distance";
  const fcl::CollisionRequestd contacts(1, std::string(asked) == "contact");
  const fcl::DistanceRequestd points(true);
  const auto ask = [&](const auto& distances, const auto& collides) {
    return [&, distances, collides](std::size_t i) {
      const Isometry3d &a = poses.a[i], &b = poses.b[i];
      fcl::DistanceResultd distance;
      fcl::CollisionResultd collision;
      if (isDistance)
        distances(body.get(), a, mesh.get(), b, points, distance);
      else
        collides(body.get(), a, mesh.get(), b, contacts, collision);
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
  std::string folder;
  app.option("QUERIES", queries, "a body and a place").whole(1).shown();
  app.option("-o,--output", folder, "folder for meshes.json");
  return app.run(argc, argv, [&] {
    benchmark::Measurement result;
    result.name = "meshes";
    benchmark::requirePlace(folder, result.name);
    for (const int n : {10, 100}) {
      const Geometry mesh = bumpySurface(n);
      const std::vector<std::pair<const char*, Geometry>> bodies{
          {"STP-BV",
           std::make_shared<StpBvGeometry>(StpBv::build(randomHull(60, {0.2, 0.2, 0.25}, 3), {0.01, 10}))},
          {"box", std::make_shared<fcl::Boxd>(0.4, 0.4, 0.5)},
          {"cylinder", std::make_shared<fcl::Cylinderd>(0.2, 0.4)},
          {"ball", std::make_shared<fcl::Sphered>(0.2)},
          {"the mesh", mesh}};
      for (const auto& [place, away] : {std::pair("meets", 0.3), std::pair("apart", 0.8)})
        for (const char* asked : {"distance", "contact", "yes or no"})
          for (const auto& [name, body] : bodies) {
            Json row{{"triangles", 4 * n * (n - 1)}, {"body", name}, {"place", place}, {"asked", asked}};
            row.update(figures(body, mesh, posesAt(away, queries), asked));
            std::printf("%s\n", row.dump().c_str());
            result.rows.push_back(std::move(row));
          }
    }
    if (!folder.empty()) benchmark::write(result, benchmark::commandLine(argc, argv), folder);
    return 0;
  });
}
