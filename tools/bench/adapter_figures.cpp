// The figures of docs/fcl.md: how often FCL's features map to the right patches, and what a query costs.
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "test/reference/shapes.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using benchmark::significant;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

namespace {

struct Motion {
  std::vector<Isometry3d> a, b;
};

/// The paper's motion (V.B): both bodies turn about three axes, and the distance of their centres goes to and
/// fro.
Motion paperMotion(double degrees, double step, int queries, double nearest) {
  const double angle = degrees * std::acos(-1.0) / 180;
  const auto turn = [&](double f) {
    return Eigen::Matrix3d(Eigen::AngleAxisd(angle * f, Vector3d::UnitX()) *
                           Eigen::AngleAxisd(0.77 * angle * f, Vector3d::UnitY()) *
                           Eigen::AngleAxisd(1.31 * angle * f, Vector3d::UnitZ()));
  };
  Motion motion;
  Eigen::Matrix3d ra = Eigen::Matrix3d::Identity(), rb = ra;
  double d = nearest, sign = 1;
  for (int i = 0; i < queries; ++i) {
    ra = turn(1) * ra;
    rb = turn(-0.83) * rb;
    d += sign * step;
    if (d > nearest + 0.42) sign = -1;
    if (d < nearest) sign = 1;
    motion.a.push_back(pose(ra, {0, 0, 0}));
    motion.b.push_back(pose(rb, {d, 0.01, 0.02}));
  }
  return motion;
}

using Query = std::function<double(const Isometry3d&, const Isometry3d&)>;

/// Nanoseconds per query of each way: the best of nine passes over the motion. The ways take turns, so that a
/// temporary slowdown of the machine affects all of them.
std::vector<double> nanoseconds(const Motion& motion, const std::vector<Query>& ways) {
  std::vector<double> best(ways.size(), 1e300);
  double sum = 0;  // keeps the compiler from dropping queries
  for (int pass = 0; pass < 9; ++pass)
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const auto start = std::chrono::steady_clock::now();
      for (std::size_t i = 0; i < motion.a.size(); ++i) sum += ways[k](motion.a[i], motion.b[i]);
      const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
      best[k] = std::min(best[k], spent.count() / static_cast<double>(motion.a.size()));
    }
  if (!std::isfinite(sum)) std::fprintf(stderr, "a query gave no finite distance\n");
  return best;
}

/// Shares (%) of the mapped queries, and the share of all queries without features.
Json shares(const char* shape, const char* motion, const MappingCounts& counts) {
  const auto percent = [](auto part, auto whole) {
    return significant(100 * static_cast<double>(part) / static_cast<double>(whole), 6);
  };
  const auto mapped = counts.total() - counts.unmapped;
  return {{"shape", shape},
          {"motion", motion},
          {"right", percent(counts.right, mapped)},
          {"neighbour", percent(counts.neighbour, mapped)},
          {"farther", percent(counts.farther, mapped)},
          {"none", percent(counts.unmapped, counts.total())}};
}

/// Mapping over random poses, with the distance of the centres between `near` and `far` enclosing radii.
Json sharesApart(const char* name, const Cloud& cloud, int queries, double near, double far) {
  const StpBvGeometry g(StpBv::build(cloud, {0.01, 10.0}));
  Random random(1);
  MappingCounts counts;
  for (int i = 0; i < queries; ++i) {
    const double d = g.volume().enclosingRadius() * random.uniform(near, far);
    const Isometry3d a = pose(random.rotation(), {0, 0, 0}),
                     b = pose(random.rotation(), d * random.direction());
    distance(g, a, g, b, {nullptr, &counts});
  }
  return shares(name, "apart", counts);
}

/// Shares and times of a motion.
Json figures(const char* name, const Cloud& cloud, int queries, bool large) {
  const StpBvGeometry g(StpBv::build(cloud, {0.01, 10.0}));
  const double nearest = 1.9 * g.volume().enclosingRadius();
  const Motion motion = paperMotion(large ? 20 : 1, large ? 0.02 : 0.001, queries, nearest);
  MappingCounts counts;
  for (std::size_t i = 0; i < motion.a.size(); ++i)
    distance(g, motion.a[i], g, motion.b[i], {nullptr, &counts});
  Json result = shares(name, large ? "large" : "small", counts);
  fcl::DistanceRequestd request;
  WitnessStart start;
  PairCache cache;
  QueryContext fromWitness;
  fromWitness.start = StartFrom::fclWitness;
  const std::vector<double> ns = nanoseconds(
      motion,
      {[&](const Isometry3d& a, const Isometry3d& b) {
         fcl::DistanceResultd answer;
         return fcl::distance(&g, a, &g, b, request, answer);
       },
       [&](const Isometry3d& a, const Isometry3d& b) {
         return polyhedralWitness(g.hull(), a, g.hull(), b).upper;
       },
       [&](const Isometry3d& a, const Isometry3d& b) {
         const PolyhedralWitness w = polyhedralWitness(g.hull(), a, g.hull(), b, start);
         start = w.start();
         return w.upper;
       },
       [&](const Isometry3d& a, const Isometry3d& b) { return distance(g, a, g, b, fromWitness).distance; },
       [&](const Isometry3d& a, const Isometry3d& b) { return distance(g, a, g, b).distance; },
       [&](const Isometry3d& a, const Isometry3d& b) {
         return distance(g, a, g, b, {&cache, nullptr}).distance;
       },
       [&](const Isometry3d& a, const Isometry3d& b) {
         return distance(g.volume(), a, g.volume(), b).distance;
       }});
  std::size_t k = 0;
  for (const char* way :
       {"fcl", "witness_cold", "witness_warm", "exact_from_witness", "exact_cold", "exact_warm", "core_cold"})
    result[std::string("ns_") + way] = std::round(ns[k++]);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app(
      "How often FCL's features map to the right patches, and what a query costs: a JSON object a line",
      "adapter_figures");
  int queries = 20000;
  app.option("QUERIES", queries, "a shape and motion").whole(1).shown();
  const std::vector<std::pair<const char*, Cloud>> shapes{
      {"geodesic 12", geodesicSphere(0.2, 0)},
      {"geodesic 42", geodesicSphere(0.2, 1)},
      {"geodesic 162", geodesicSphere(0.2, 2)},
      {"geodesic 642", geodesicSphere(0.2, 3)},
      {"geodesic 2562", geodesicSphere(0.2, 4)},
      {"box", box(0.2, 0.3, 0.4)},
      {"cylinder", cylinder(0.1, 0.4)},
      {"plate", plate(0.3, 0.2)},
      {"hull of 200", randomHull(200, {0.2, 0.15, 0.1}, 3)}};
  return benchmark::runBenchmark(app, argc, argv, "adapter", [&](benchmark::Measurement& result) {
    for (const auto& [name, cloud] : shapes)
      for (const bool large : {true, false}) result.add(figures(name, cloud, queries, large));
    for (const auto& [name, cloud] : shapes) result.add(sharesApart(name, cloud, queries, 3.8, 7.6));
  });
}
