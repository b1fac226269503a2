// Model error: how far the volume exceeds its hull, compared with the time of a query and the steepness of
// the gradient, over r, R and the over-cover that `reduce` may use.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/distance/hessian.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "tools/bench/speed_accuracy.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A body with flat faces and a finely divided rim, for which r, R and fewer vertices all matter.
test::Cloud bodyCloud() { return test::cylinder(0.1, 0.4, 64); }

constexpr double kNearestCentres = 0.5;  // m: least distance of the centres, the same for all volumes

/// How far the volume's support function exceeds the cloud's.
struct Cover {
  double least, most;
};

Cover coverOf(const StpBv& volume, const test::Cloud& cloud, std::uint64_t seed) {
  test::Random random(seed);
  Cover cover{1e300, overCover(volume, cloud).max};
  for (int i = 0; i < 20000; ++i) {
    const Vector3d n = random.direction();
    double hull = -1e300;
    for (const Vector3d& p : cloud) hull = std::max(hull, n.dot(p));
    cover.least = std::min(cover.least, volume.support(n) - hull);
  }
  return cover;
}

/// Lipschitz constants of the gradient: the largest eigenvalues of the distance's second derivative.
struct Steepness {
  double shift = 0;  ///< for both bodies' translations (1/m); at most 2 / (distance + 2 r)
  double turn = 0;   ///< for both bodies' rotations about their middles (m/rad^2)
};

/// The largest eigenvalue of the block of rows and columns from `first` on, three for each body.
double largestEigenvalue(const DistanceHessian& h, int first) {
  Eigen::Matrix<double, 6, 6> block;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) block(i, j) = h.matrix(first + i % 3 + i / 3 * 6, first + j % 3 + j / 3 * 6);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(block, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

/// The steepness over random poses 1 to 50 mm apart. In half of them, ends or sides are nearly parallel,
/// where the gradient turns fastest.
Steepness steepnessOf(const StpBv& volume, std::uint64_t seed) {
  test::Random random(seed);
  Steepness steepest;
  for (int i = 0; i < 6000; ++i) {
    const Isometry3d a = Isometry3d::Identity();
    Matrix3d rotation = random.rotation();
    Vector3d towards = random.direction();
    if (i % 2) {
      rotation = random.rotation(std::pow(10.0, random.uniform(-4, -1)));
      if (i % 4 == 1) towards = (Vector3d::UnitZ() + 0.1 * random.direction()).normalized();
    }
    Isometry3d b = test::pose(rotation, 1.0 * towards);
    const Distance far = distance(volume, a, volume, b);
    b.translation() -= (far.distance - random.uniform(0.001, 0.05)) * far.normal;
    const Distance near = distance(volume, a, volume, b);
    DistanceHessian h;
    if (near.status != DistanceStatus::exact || !hessian(volume, a, volume, b, near, h)) continue;
    steepest.shift = std::max(steepest.shift, largestEigenvalue(h, 0));
    steepest.turn = std::max(steepest.turn, largestEigenvalue(h, 3));
  }
  return steepest;
}

struct Model {
  const char* sweep;
  std::string label;
  StpBv::Ptr volume;
};

std::vector<Model> models() {
  const test::Cloud cloud = bodyCloud();
  std::vector<Model> result;
  for (const double r : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05})
    result.push_back({"r", shown(1000 * r) + " mm", StpBv::build(cloud, {r, 10})});
  for (const double R : {0.3, 0.5, 1.0, 3.0, 10.0, 100.0})
    result.push_back({"R", shown(R) + " m", StpBv::build(cloud, {0.01, R})});
  for (const double most : {0.0125, 0.015, 0.03, 0.05, 0.08}) {
    const StpBv::Ptr volume = reduce(cloud, {0.01, 10}, most);
    result.push_back({"vertices", std::to_string(volume->vertexCount()), volume});
  }
  return result;
}

}  // namespace

Measurement modelError(const SpeedOptions& options) {
  Measurement result;
  result.name = "model_error";
  result.about = {{"seed", options.seed}, {"radius", 0.1}, {"length", 0.4}, {"sides", 64}};
  const test::Cloud cloud = bodyCloud();
  const std::vector<Model> all = models();
  std::vector<MethodPtr> methods;
  for (const Model& model : all) {
    const auto geometry = std::make_shared<StpBvGeometry>(model.volume);
    methods.push_back(stpBvWarm({geometry, std::make_shared<StpBvGeometry>(model.volume)}));
  }
  GeodesicMotion motion(smallStep(), options.seed, kNearestCentres);
  std::vector<int> failed(all.size());
  std::vector<Times> times = timed(methods, motion, options.blocks, GeodesicMotion::kCycle, true,
                                   [&](std::size_t m, const Poses&, const std::vector<Answer>& answers) {
                                     for (const Answer& a : answers)
                                       failed[m] += a.outcome == Outcome::failed;
                                   });
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Model& model = all[m];
    const Cover cover = coverOf(*model.volume, cloud, options.seed);
    const Steepness steep = steepnessOf(*model.volume, options.seed);
    std::vector<double>& ns = times[m].query;
    const double apart = spread(times[m].block);
    result.spread = std::max(result.spread, apart);
    result.rows.push_back({{"sweep", model.sweep},
                           {"setting", model.label},
                           {"vertices", model.volume->vertexCount()},
                           {"over_cover_least_m", significant(cover.least, 6)},
                           {"over_cover_most_m", significant(cover.most, 6)},
                           {"ns_p5", std::round(percentile(ns, 0.05))},
                           {"ns_p50", std::round(percentile(ns, 0.5))},
                           {"ns_p99", std::round(percentile(ns, 0.99))},
                           {"steepness_shift", significant(steep.shift, 4)},
                           {"steepness_turn", significant(steep.turn, 4)},
                           {"queries", ns.size()},
                           {"failed", failed[m]},
                           {"spread", significant(apart, 2)}});
  }
  return result;
}

}  // namespace fcl_stpbv::benchmark
