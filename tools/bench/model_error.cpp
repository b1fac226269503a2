// Model error: how far the volume exceeds its hull, against what a query takes and how steep the gradient is,
// over r, R and the over-cover that `reduce` may use.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/distance/hessian.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/reduce.h"
#include "tools/bench/charts.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A body with flat faces and a fine rim: where r, R and fewer vertices all matter.
test::Cloud bodyCloud() { return test::cylinder(0.1, 0.4, 64); }

constexpr double kNearestCentres = 0.5;  // m: shortest way between centres, the same for all volumes

/// How far the volume's support exceeds the cloud's.
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
  double shift = 0;  ///< over both bodies' translations (1/m); at most 2 / (distance + 2 r)
  double turn = 0;   ///< over both bodies' rotations about their middles (m/rad^2)
};

/// Of the rows and columns from `first` on, three a body.
double largestEigenvalue(const DistanceHessian& h, int first) {
  Eigen::Matrix<double, 6, 6> block;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) block(i, j) = h.matrix(first + i % 3 + i / 3 * 6, first + j % 3 + j / 3 * 6);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(block, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

/// Over random poses 1 to 50 mm apart; half of them with ends or sides nearly parallel, where the gradient
/// turns fastest.
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
    result.push_back({"r", text("%g mm", 1000 * r), StpBv::build(cloud, {r, 10})});
  for (const double R : {0.3, 0.5, 1.0, 3.0, 10.0, 100.0})
    result.push_back({"R", text("%g m", R), StpBv::build(cloud, {0.01, R})});
  for (const double most : {0.0125, 0.015, 0.03, 0.05, 0.08}) {
    const StpBv::Ptr volume = reduce(cloud, {0.01, 10}, most);
    result.push_back({"vertices", text("%d", volume->vertexCount()), volume});
  }
  return result;
}

std::string panel(const std::vector<std::pair<std::string, std::string>>& data, int column, const char* label,
                  bool key) {
  static const char* colours[] = {"#c44e52", "#1f4e96", "#55a868"};
  static const char* titles[] = {"r from 1 to 50 mm", "R from 0.3 to 100 m",
                                 "number of vertices left by reduce"};
  static const char* offsets[] = {"0,-0.8", "0,0.8", "1.2,0.4"};
  std::string plot = text("set ylabel '%s'\n%s\n", label,
                          key ? "set key at screen 0.72,0.985 horizontal maxrows 1 width -2" : "set key off"),
              curves;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::string name = text("$model%zu", i), colour = text("lc rgb '%s'", colours[i]);
    curves += (curves.empty() ? "plot " : ", ") + name +
              text(" using 1:%d with linespoints pt 7 ps 0.7 lw 2 ", column) + colour +
              text(" title '%s', ", titles[i]) + name +
              text(" using 1:%d:5 with labels font ',9' offset %s tc rgb '%s' notitle", column, offsets[i],
                   colours[i]);
  }
  return plot + curves + "\n";
}

}  // namespace

Chart modelErrorChart(const ChartOptions& options) {
  Chart chart;
  chart.name = "model_error";
  chart.header =
      "sweep,setting,vertices,over_cover_least_m,over_cover_most_m,ns_p5,ns_p50,ns_p99,gradient_lipschitz_m,"
      "queries,"
      "failed,spread";
  chart.width = 1300;
  chart.height = 560;
  const test::Cloud cloud = bodyCloud();
  const std::vector<Model> all = models();
  std::vector<std::pair<std::string, std::string>> data;
  std::vector<MethodPtr> methods;
  for (const Model& model : all) {
    const auto geometry = std::make_shared<StpBvGeometry>(model.volume);
    methods.push_back(stpBvWarm({geometry, std::make_shared<StpBvGeometry>(model.volume)}));
  }
  GeodesicMotion motion(smallStep(), options.seed, kNearestCentres);
  std::vector<int> failed(all.size());
  std::vector<Times> times = timed(methods, motion, 30, GeodesicMotion::kCycle, true,
                                   [&](std::size_t m, const Poses&, const std::vector<Answer>& answers) {
                                     for (const Answer& a : answers)
                                       failed[m] += a.outcome == Outcome::failed;
                                   });
  for (std::size_t m = 0; m < all.size(); ++m) {
    const Model& model = all[m];
    const Cover cover = coverOf(*model.volume, cloud, options.seed);
    const Steepness steep = steepnessOf(*model.volume, options.seed);
    std::vector<double>& ns = times[m].query;
    const double low = percentile(ns, 0.05), middle = percentile(ns, 0.5), high = percentile(ns, 0.99),
                 apart = spread(times[m].block);
    chart.spread = std::max(chart.spread, apart);
    chart.rows.push_back(text("%s,%s,%d,%.6g,%.6g,%.0f,%.0f,%.0f,%.4g,%.4g,%zu,%d,%.3f", model.sweep,
                              model.label.c_str(), model.volume->vertexCount(), cover.least, cover.most, low,
                              middle, high, steep.shift, steep.turn, ns.size(), failed[m], apart));
    if (data.empty() || data.back().first != model.sweep) data.emplace_back(model.sweep, "");
    data.back().second +=
        text("%g %g %g %g \"%s\"\n", 1000 * cover.most, middle, steep.shift, steep.turn, model.label.c_str());
  }
  for (std::size_t i = 0; i < data.size(); ++i)
    chart.plot += text("$model%zu << EOD\n", i) + data[i].second + "EOD\n";
  chart.plot +=
      "set multiplot layout 1,3 margins 0.05,0.99,0.2,0.9 spacing 0.065\nset logscale x\nset xrange "
      "[0.8:120]\n"
      "set xlabel 'largest over-cover (mm)'\nset yrange [0:*]\n" +
      panel(data, 2, "ns a query, warm, small steps", false) + "set autoscale y\nset logscale y\n" +
      panel(data, 3, "steepest gradient, shifting (1/m)", true) +
      panel(data, 4, "steepest gradient, turning (m/rad^2)", false) + "unset multiplot\n";
  chart.caption = text(
      "Cylinder of radius 0.1 m and length 0.4 m as a prism of 64 sides, against itself. The volume never "
      "covers less than "
      "r beyond the hull (CSV: least). Where not varied, r = 1 cm, R = 10 m, 128 vertices. Hessian's "
      "eigenvalues over 6000 poses. Seed "
      "%llu",
      static_cast<unsigned long long>(options.seed));
  return chart;
}

}  // namespace fcl_stpbv::benchmark
