// Nanoseconds of fcl_stpbv::collide beside fcl::collide of the same hulls, the ways taking turns; for
// docs/fcl.md. Usage: collide_figures [QUERIES]
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "fcl_stpbv/adapter/collide.h"
#include "test/reference/arguments.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;

namespace {

using Query = std::function<std::size_t(const Isometry3d&, const Isometry3d&)>;

/// The best of nine passes each.
std::vector<double> nanoseconds(const benchmark::Poses& poses, const std::vector<Query>& ways,
                                std::size_t& hits) {
  std::vector<double> best(ways.size(), 1e300);
  for (int pass = 0; pass < 9; ++pass)
    for (std::size_t k = 0; k < ways.size(); ++k) {
      hits = 0;
      const auto start = std::chrono::steady_clock::now();
      for (std::size_t i = 0; i < poses.a.size(); ++i) hits += ways[k](poses.a[i], poses.b[i]);
      const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
      best[k] = std::min(best[k], spent.count() / static_cast<double>(poses.a.size()));
    }
  return best;
}

/// Centres `nearest` and up to 0.42 m more apart (m).
void report(const char* name, const Cloud& cloud, int queries, double nearest) {
  const StpBvGeometry g(StpBv::build(cloud, {0.01, 10.0}));
  for (const bool contact : {false, true}) {
    benchmark::Poses poses;
    benchmark::GeodesicMotion(benchmark::smallStep(), 1, nearest).next(poses, queries);
    const fcl::CollisionRequestd request(1, contact);
    PairCache cache;
    const auto ours = [&](PairCache* known) {
      return [&, known](const Isometry3d& a, const Isometry3d& b) {
        fcl::CollisionResultd result;
        return fcl_stpbv::collide(&g, a, &g, b, request, result, known);
      };
    };
    std::size_t hits = 0;
    const std::vector<double> ns = nanoseconds(poses,
                                               {[&](const Isometry3d& a, const Isometry3d& b) {
                                                  fcl::CollisionResultd result;
                                                  return fcl::collide(&g, a, &g, b, request, result);
                                                },
                                                ours(nullptr), ours(&cache)},
                                               hits);
    std::printf("| %s | %.2f | %.0f %% | %s | %.0f | %.0f | %.0f | %.2f | %.2f |\n", name, nearest,
                100 * static_cast<double>(hits) / queries, contact ? "contact" : "yes or no", ns[0], ns[1],
                ns[2], ns[1] / ns[0], ns[2] / ns[0]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int queries = Arguments(argc, argv, "[QUERIES]", 1).number(1, 8400);
  std::printf(
      "| body | nearest centres (m) | collide | asked | fcl::collide | cold | warm | cold / FCL | warm / FCL "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const double nearest : {0.15, 0.38}) {
    report("geodesic 42", geodesicSphere(0.2, 1), queries, nearest);
    report("geodesic 642", geodesicSphere(0.2, 3), queries, nearest);
    report("box", box(0.2, 0.3, 0.4), queries, nearest);
    report("hull of 200", randomHull(200, {0.2, 0.15, 0.1}, 3), queries, nearest);
  }
}
