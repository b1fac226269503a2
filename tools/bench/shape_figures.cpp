// Nanoseconds of queries of a body and one of FCL's simple shapes, by fcl_stpbv and by FCL. The two take
// turns. For the table of docs/fcl.md.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
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
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Named = std::pair<const char*, Geometry>;
using Json = nlohmann::ordered_json;

namespace {

/// Two bodies under the paper's small motions, with their centres between `nearest` and 0.42 m more apart
/// (m). `asked`: "distance", a contact, or yes or no. FCL gets the hull of an STP-BV. This library starts
/// from the last answer, and without one.
Json figures(const Named& body, const Named& shape, int queries, double nearest, const std::string& asked) {
  benchmark::Poses poses;
  benchmark::GeodesicMotion(benchmark::smallStep(), 1, nearest).next(poses, queries);
  const fcl::CollisionGeometryd &a = *body.second, &b = *shape.second;
  const bool isDistance = asked == "distance";
  fcl::DistanceRequestd points(true);
  const fcl::CollisionRequestd contact(1, asked == "contact");
  PairCache cache;
  const auto fcls = [&](std::size_t i) {
    fcl::DistanceResultd distance;
    fcl::CollisionResultd collision;
    return isDistance ? fcl::distance(&a, poses.a[i], &b, poses.b[i], points, distance)
                      : static_cast<double>(fcl::collide(&a, poses.a[i], &b, poses.b[i], contact, collision));
  };
  const auto ours = [&](PairCache* known) {
    return [&, known](std::size_t i) {
      fcl::CollisionResultd collision;
      return isDistance ? distance(a, poses.a[i], b, poses.b[i], {known}).distance
                        : static_cast<double>(fcl_stpbv::collide(&a, poses.a[i], &b, poses.b[i], contact,
                                                                 collision, {known}));
    };
  };
  const std::vector<double> ns =
      benchmark::mediansInTurns(9, poses.a.size(), {fcls, ours(nullptr), ours(&cache)});
  std::size_t hits = 0;
  for (std::size_t i = 0; i < poses.a.size(); ++i) hits += !isFartherThan(0.0, a, poses.a[i], b, poses.b[i]);
  return {{"body", body.first},
          {"shape", shape.first},
          {"nearest", nearest},
          {"asked", asked},
          {"hits", benchmark::significant(100.0 * static_cast<double>(hits) / queries, 3)},
          {"ns_fcl", std::round(ns[0])},
          {"ns_cold", std::round(ns[1])},
          {"ns_warm", std::round(ns[2])}};
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Times of queries of a body and a simple shape beside FCL's own: a JSON object a line",
                     "shape_figures");
  int queries = 2100;
  app.option("QUERIES", queries, "a body, a shape and a nearest distance").whole(1).shown();
  const auto smooth = [](const Cloud& cloud) {
    return std::make_shared<StpBvGeometry>(StpBv::build(cloud, {0.01, 10.0}));
  };
  const std::vector<Named> bodies{{"STP-BV of 162", smooth(geodesicSphere(0.2, 2))},
                                  {"STP-BV of a box", smooth(box(0.2, 0.3, 0.4))},
                                  {"ball", std::make_shared<fcl::Sphered>(0.15)},
                                  {"capsule", std::make_shared<fcl::Capsuled>(0.1, 0.3)},
                                  {"box", std::make_shared<fcl::Boxd>(0.2, 0.3, 0.4)},
                                  {"cylinder", std::make_shared<fcl::Cylinderd>(0.1, 0.4)}};
  const std::vector<Named> shapes{
      {"ball", std::make_shared<fcl::Sphered>(0.15)},
      {"capsule", std::make_shared<fcl::Capsuled>(0.1, 0.3)},
      {"box", std::make_shared<fcl::Boxd>(0.2, 0.3, 0.4)},
      {"cylinder", std::make_shared<fcl::Cylinderd>(0.1, 0.4)},
      {"cone", std::make_shared<fcl::Coned>(0.1, 0.4)},
      {"ellipsoid", std::make_shared<fcl::Ellipsoidd>(0.1, 0.15, 0.2)},
      {"convex of 8", detail::hullGeometry(box(0.2, 0.3, 0.4))},
      {"convex of 162", detail::hullGeometry(geodesicSphere(0.15, 2))},
      {"convex of 642", detail::hullGeometry(geodesicSphere(0.15, 3))},
      {"half space", std::make_shared<fcl::Halfspaced>(Eigen::Vector3d::UnitZ(), -0.3)}};
  const std::vector<std::pair<std::string, double>> questions{
      {"distance", 0.45}, {"yes or no", 0.45}, {"yes or no", 0.15}, {"contact", 0.45}, {"contact", 0.15}};
  return benchmark::runBenchmark(app, argc, argv, "shapes", [&](benchmark::Measurement& result) {
    for (const Named& body : bodies)
      for (const auto& [asked, nearest] : questions)
        for (const Named& shape : shapes) {
          const bool unbounded = shape.second->getNodeType() == fcl::GEOM_HALFSPACE;
          if (unbounded && asked == "distance") continue;  // FCL dereferences a null pointer
          result.add(figures(body, shape, queries, nearest, asked));
        }
  });
}
