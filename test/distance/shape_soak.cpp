// shape_soak POSES SEED [SHAPE]: random poses of an STP-BV against each simple shape, all against the
// independent reference. Prints one line a shape and fails on any error above 1e-12 m (1e-9 for cone and
// ellipsoid).
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fcl_stpbv/distance/shape_distance.h"
#include "test/distance/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Body {
  Cloud cloud;
  double r, R;
  StpBv::Ptr volume;
};

std::vector<Body> bodies() {
  std::vector<Body> all;
  const auto add = [&](const Cloud& cloud, double r, double R) {
    all.push_back({cloud, r, R, StpBv::build(cloud, {r, R})});
  };
  add(box(0.3, 0.2, 0.1), 0.01, 10);
  add(plate(0.3, 0.2), 0.005, 10);
  add(needle(0.5), 0.01, 1);
  add(cylinder(0.1, 0.4, 16), 0.02, 100);
  add(geodesicSphere(0.2, 1), 0.01, 1);
  add(randomHull(20, {0.2, 0.15, 0.1}, 3), 0.01, 10);
  add({{0, 0, 0}, {0.3, 0, 0}}, 0.02, 0.5);
  add(box(0.2, 0.2, 0.2), 0, 10);
  return all;
}

/// A pose at which the bodies are near, touching, slightly deep or far, some of them parallel.
Isometry3d placed(Random& random, const TestShape& shape, const Body& body) {
  Eigen::Matrix3d turn = random.rotation();
  if (random.below(4) == 0) {
    turn = Eigen::Matrix3d::Identity();
    if (random.below(2) == 0) turn = random.rotation(1e-6);
  }
  const Vector3d d = random.direction();
  Isometry3d at = pose(turn, d);
  // Along d the shape's near side comes to a chosen gap from the volume's far side.
  const double reach = d.dot(at.linear() * shape.shape.support(-(turn.transpose() * d))) - shape.shape.margin;
  const double gap = random.below(3) == 0 ? random.uniform(-2, 2) * body.r : random.uniform(0, 0.5);
  at.translation() = (body.volume->support(d) + gap - reach) * d + 0.05 * random.direction();
  return at;
}

}  // namespace

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int seed = argc > 2 ? std::atoi(argv[2]) : 1;
  const std::string only = argc > 3 ? argv[3] : "";
  const std::vector<Body> all = bodies();
  bool good = true;
  std::printf("%-10s %8s %8s %8s %8s %8s %9s %9s %9s\n", "shape", "exact", "bounded", "overlap", "missed",
              "pairs", "error", "gap", "ns/query");
  for (const std::string& name : boundedShapes()) {
    if (!only.empty() && only != name) continue;
    Random random(static_cast<std::uint64_t>(seed));
    int exact = 0, bounded = 0, overlap = 0, missed = 0;
    double worst = 0, gap = 0, time = 0, pairs = 0;
    for (int i = 0; i < poses; ++i) {
      const Body& body = all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
      const TestShape shape = randomShape(name, random);
      const Isometry3d base = pose(random.rotation(), random.direction());
      const Isometry3d at = base * placed(random, shape, body);
      const auto begin = std::chrono::steady_clock::now();
      const Distance d = distance(*body.volume, base, shape.shape, at);
      time += std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
      pairs += d.patchPairs;
      const ReferenceAnswer truth =
          referenceDistance(referenceBody(body.cloud, body.r, body.R, base), shape.posed(at),
                            (at * shape.shape.centre - base.translation()).cast<long double>());
      if (truth.overlap) {
        ++overlap;
        if (d.status == DistanceStatus::exact && d.distance + body.r + shape.shape.margin > 1e-13) {
          ++missed;
        }
        continue;
      }
      const double error = std::abs(static_cast<double>(d.distance - truth.distance));
      if (d.status == DistanceStatus::exact) ++exact;
      if (d.status == DistanceStatus::bounded) ++bounded;
      if (d.status == DistanceStatus::local) ++missed;
      if (error > 1e-12 || d.status != DistanceStatus::exact)
        std::printf("  %s %d: body %d status %d distance %.17g truth %.17Lg error %.2g upper-lower %.2g\n",
                    name.c_str(), i, static_cast<int>(&body - all.data()), static_cast<int>(d.status),
                    d.distance, truth.distance, error, d.upper - d.lower);
      worst = std::max(worst, error);
      gap = std::max(gap, d.upper - d.lower);
    }
    std::printf("%-10s %8d %8d %8d %8d %8.1f %9.1e %9.1e %9.0f\n", name.c_str(), exact, bounded, overlap,
                missed, pairs / poses, worst, gap, time / poses);
    const double allowed = name == "cone" || name == "ellipsoid" ? 1e-9 : 1e-12;
    good = good && missed == 0 && bounded == 0 && worst <= allowed;
  }
  return good ? 0 : 1;
}
