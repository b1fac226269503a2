// Random queries over hard shapes, radii and placements. Every query must converge and certify its answer.
//
//   distance_soak [QUERIES] [SEED]
//
// Prints a row per big radius and kind of placement as soon as it is complete. Returns 1 if a query did not
// converge, a certificate is wider than rounding, or memory grew after the first row. "wide": certificates
// wider than 1e-12 of the two bodies' size.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/arguments.h"
#include "test/reference/shapes.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Row {
  int queries = 0, notExact = 0, wide = 0, maxPairs = 0;
  long pairs = 0, steps = 0;
  double gap = 0, nanoseconds = 0;

  void add(const Distance& d, double size, double ns) {
    ++queries;
    wide += !(d.upper - d.lower <= 1e-12 * size);
    notExact += d.status != DistanceStatus::exact;
    maxPairs = std::max(maxPairs, d.patchPairs);
    pairs += d.patchPairs;
    steps += d.patchSteps;
    gap = std::max(gap, d.upper - d.lower);
    nanoseconds += ns;
  }
};

/// Resident memory (kB); 0 if the system does not give it.
long residentMemory() {
  std::ifstream status("/proc/self/statm");
  long whole = 0, resident = 0;
  return status >> whole >> resident ? resident * 4 : 0;
}

void report(const Distance& d, const char* kind, double R, int a, int b, const Isometry3d& pa,
            const Isometry3d& pb) {
  static int printed = 0;
  if (d.status == DistanceStatus::exact || ++printed > 20) return;
  std::fprintf(stderr, "not exact: %s, R %g, bodies %d %d, status %d, distance %.17g, gap %.3g, pairs %d\n",
               kind, R, a, b, static_cast<int>(d.status), d.distance, d.upper - d.lower, d.patchPairs);
  const Isometry3d relative = pa.inverse() * pb;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) std::fprintf(stderr, " %.17g", relative(i, j));
    std::fprintf(stderr, "\n");
  }
}

Distance timed(const StpBv& a, const Isometry3d& pa, const StpBv& b, const Isometry3d& pb, PairCache* cache,
               double& ns) {
  const auto start = std::chrono::steady_clock::now();
  const Distance d = distance(a, pa, b, pb, cache);
  ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  return d;
}

std::vector<StpBv::Ptr> bodies(double R) {
  const std::vector<Cloud> clouds{box(0.3, 0.2, 0.5),
                                  plate(0.4, 0.6),
                                  needle(0.8),
                                  cylinder(0.15, 0.4),
                                  geodesicSphere(0.2, 1),
                                  geodesicSphere(0.2, 2),
                                  randomHull(60, {0.3, 0.2, 0.25}, 1),
                                  randomHull(40, {0.02, 0.3, 0.3}, 2),
                                  randomHull(300, {0.2, 0.2, 0.2}, 3),
                                  {Vector3d(0, 0, 0)},
                                  {Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)},
                                  {Vector3d(0.2, 0, 0), Vector3d(-0.1, 0.2, 0), Vector3d(-0.1, -0.2, 0)}};
  std::vector<StpBv::Ptr> result;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const double r = i % 3 == 0 ? 0.0 : 0.01;
    result.push_back(StpBv::build(clouds[i], {r, R}));
  }
  return result;
}

/// A rotation that aligns the axes of one body with axes of the other, except for `tilt` about a random axis.
Matrix3d parallel(Random& random, double tilt) {
  Matrix3d q = Matrix3d::Zero();
  const int first = random.below(3), second = (first + 1 + random.below(2)) % 3;
  q(first, 0) = random.below(2) ? 1 : -1;
  q(second, 1) = random.below(2) ? 1 : -1;
  q.col(2) = q.col(0).cross(q.col(1));
  return tilt > 0 ? Matrix3d(random.rotation(tilt) * q) : q;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[QUERIES [SEED]]", 2);
  const long queries = arguments.number(1, 20000L);
  const std::uint64_t seed = arguments.number(2, std::uint64_t{1});
  const double radii[] = {0.6, 1, 10, 100, 1e4, 1e6};
  const char* kinds[] = {"random", "tilt 1e-3", "tilt 1e-9", "parallel"};
  const double tilts[] = {-1, 1e-3, 1e-9, 0};

  int failures = 0;
  long asked = 0, wide = 0;
  const long memoryAtStart = residentMemory();
  std::printf("%8s %10s %6s %9s %9s %9s %5s %7s %6s %7s %8s\n", "R", "placement", "start", "queries",
              "not exact", "max gap", "wide", "pairs", "max", "steps", "ns");
  for (const double R : radii) {
    const std::vector<StpBv::Ptr> pool = bodies(R);
    long memory = 0;  // after all bodies of this R were queried once
    for (int kind = 0; kind < 4; ++kind) {
      Random random(seed * 1000 + static_cast<std::uint64_t>(kind));
      Row cold, warm;
      const long rounds = queries / (6 * 4 * 4);
      for (long i = 0; i < rounds; ++i) {
        const int ia = random.below(static_cast<int>(pool.size())),
                  ib = random.below(static_cast<int>(pool.size()));
        const StpBv &a = *pool[static_cast<std::size_t>(ia)], &b = *pool[static_cast<std::size_t>(ib)];
        const double size = a.enclosingRadius() + b.enclosingRadius();
        const Matrix3d qa = kind == 3 ? Matrix3d(Matrix3d::Identity()) : random.rotation();
        const Matrix3d qb = kind == 0 ? random.rotation() : Matrix3d(qa * parallel(random, tilts[kind]));
        Isometry3d pa = pose(qa, 0.3 * random.direction());
        Isometry3d pb = pose(qb, pa.translation() + 3.0 * random.direction());
        double ns = 0;
        const Distance far = timed(a, pa, b, pb, nullptr, ns);
        // A shift along the normal does not move the optimum, so this sets the distance.
        const double margin = a.radii().r + b.radii().r;
        const double target = random.below(3) ? std::pow(10.0, random.uniform(-6, 0))
                                              : -margin * random.uniform(0.0, 0.999) + 1e-9;
        pb.translation() += (target - far.distance) * far.normal;
        Distance d = timed(a, pa, b, pb, nullptr, ns);
        cold.add(d, size, ns);
        report(d, kinds[kind], R, ia, ib, pa, pb);
        if (std::abs(d.distance - target) > 1e-13 * std::max(1.0, R / 100)) {
          std::fprintf(stderr, "distance %.17g should be %.17g\n", d.distance, target);
          ++failures;
        }
        PairCache cache;
        cache.normal = d.normal;
        cache.patch = d.patch;
        for (int step = 0; step < 3; ++step) {
          const bool large = step == 2;
          const Matrix3d turn = random.rotation(large ? 0.35 : 0.0175);
          pb.linear() = turn * pb.linear();
          pb.translation() += (large ? 0.02 : 0.001) * random.direction() + 0.03 * d.normal;
          d = timed(a, pa, b, pb, &cache, ns);
          if (d.status == DistanceStatus::local) {
            pb.translation() += 0.3 * d.normal;  // the turn went too deep, which is not tested here
            continue;
          }
          warm.add(d, size, ns);
          report(d, kinds[kind], R, ia, ib, pa, pb);
        }
      }
      const auto print = [&](const char* start, const Row& row) {
        std::printf("%8g %10s %6s %9d %9d %9.1e %5d %7.2f %6d %7.2f %8.0f\n", R, kinds[kind], start,
                    row.queries, row.notExact, row.gap, row.wide,
                    static_cast<double>(row.pairs) / row.queries, row.maxPairs,
                    static_cast<double>(row.steps) / row.queries, row.nanoseconds / row.queries);
        failures += row.notExact;
        asked += row.queries;
        wide += row.wide;
        // A unit normal is accurate to an ulp, and a face's point moves R times as far. So wide is the
        // certificate of bodies that touch without margins.
        // Both bounds are rounded outward by 40 roundings of all coordinates that enter (docs/theory.md, 5):
        // the bodies' and the second origin's, together below 6 m here.
        if (row.gap > std::numeric_limits<double>::epsilon() * (8 * (2 * R + 10) + 3 * 40 * 6)) ++failures;
      };
      print("cold", cold);
      print("warm", warm);
      std::fflush(stdout);
      if (kind == 0) continue;  // until all bodies of this R were queried
      const long resident = residentMemory();
      if (memory > 0 && resident > memory + 1024) {
        std::fprintf(stderr, "memory has grown from %ld to %ld kB\n", memory, resident);
        ++failures;
      }
      memory = resident;
    }
  }
  std::printf(
      "%ld queries, %ld certificates wider than 1e-12 of the bodies; memory %ld kB at start, %ld kB at end\n",
      asked, wide, memoryAtStart, residentMemory());
  std::printf(failures ? "FAILED: %d\n" : "all converged\n", failures);
  return failures ? 1 : 0;
}
