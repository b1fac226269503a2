// Nanoseconds of fcl_stpbv::collide and of fcl::collide on the same hulls. The two take turns. For the table
// and the chart of docs/fcl.md.
#include <fcl/narrowphase/collision.h>

#include <cmath>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/collide.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Json = nlohmann::ordered_json;

namespace {

/// The share of FCL's contacts (%) that are deeper than the shortest way out by more than 1 %. The shortest
/// way out is that of the cores, which contain the hulls. NaN if there is no query in which both find a
/// contact, as among few queries.
double tooDeep(const StpBvGeometry& g, const benchmark::Poses& poses) {
  const fcl::CollisionRequestd request(1, true);
  std::size_t contacts = 0, deep = 0;
  for (std::size_t i = 0; i < poses.a.size(); ++i) {
    fcl::CollisionResultd theirs, ours;
    if (fcl::collide(&g, poses.a[i], &g, poses.b[i], request, theirs) == 0 ||
        fcl_stpbv::collide(&g, poses.a[i], &g, poses.b[i], request, ours) == 0)
      continue;
    ++contacts;
    const double least = ours.getContact(0).penetration_depth - 2.0 * g.volume().radii().r;
    deep += theirs.getContact(0).penetration_depth > 1.01 * least;
  }
  return benchmark::significant(100.0 * static_cast<double>(deep) / static_cast<double>(contacts), 3);
}

/// Two equal bodies under the paper's small motions, with their centres between `nearest` and 0.42 m more
/// apart (m).
Json figures(const char* name, const Cloud& cloud, int queries, double nearest, bool contact) {
  const StpBvGeometry g(StpBv::build(cloud, {0.01, 10.0}));
  benchmark::Poses poses;
  benchmark::GeodesicMotion(benchmark::smallStep(), 1, nearest).next(poses, queries);
  const fcl::CollisionRequestd request(1, contact);
  PairCache cache;
  const auto ours = [&](PairCache* known) {
    return [&, known](std::size_t i) {
      fcl::CollisionResultd result;
      return fcl_stpbv::collide(&g, poses.a[i], &g, poses.b[i], request, result, {known});
    };
  };
  const auto fcls = [&](std::size_t i) {
    fcl::CollisionResultd result;
    return fcl::collide(&g, poses.a[i], &g, poses.b[i], request, result);
  };
  const std::vector<double> ns =
      benchmark::mediansInTurns(9, poses.a.size(), {fcls, ours(nullptr), ours(&cache)});
  std::size_t hits = 0;
  for (std::size_t i = 0; i < poses.a.size(); ++i) hits += ours(&cache)(i);
  Json row{{"body", name},
           {"nearest", nearest},
           {"hits", benchmark::significant(100.0 * static_cast<double>(hits) / queries, 3)},
           {"asked", contact ? "contact" : "yes or no"},
           {"ns_fcl", std::round(ns[0])},
           {"ns_cold", std::round(ns[1])},
           {"ns_warm", std::round(ns[2])}};
  const double share = contact && hits > 0 ? tooDeep(g, poses) : NAN;
  if (!std::isnan(share)) row["fcl_too_deep"] = share;
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Times of collide() beside fcl::collide() on the same hulls: a JSON object a line",
                     "collide_figures");
  int queries = 4200;
  app.option("QUERIES", queries, "a body and nearest distance").whole(1).shown();
  const std::vector<std::pair<const char*, Cloud>> bodies{
      {"geodesic 42", geodesicSphere(0.2, 1)},
      {"geodesic 642", geodesicSphere(0.2, 3)},
      {"box", box(0.2, 0.3, 0.4)},
      {"cylinder", cylinder(0.1, 0.4)},
      {"plate", plate(0.3, 0.2, 0.01)},
      {"hull of 200", randomHull(200, {0.2, 0.15, 0.1}, 3)}};
  return benchmark::runBenchmark(app, argc, argv, "collide", [&](benchmark::Measurement& result) {
    for (const bool contact : {true, false})
      for (const double nearest : {0.05, 0.15, 0.38})
        for (const auto& [name, cloud] : bodies) result.add(figures(name, cloud, queries, nearest, contact));
  });
}
