// Yes or no for one pair of bodies of 162 vertices: apart, overlapping, and deep. FCL and Bullet are asked
// about the polyhedra, this library about the STP-BVs. The methods take turns on the same poses.
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "tools/bench/method.h"
#include "tools/bench/speed_accuracy.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

using Eigen::Isometry3d;

namespace {

constexpr int kPasses = 9;

/// Distances of the centres (m). The spheres have a radius of 0.20 m, with the margins 0.21 m.
struct Band {
  const char* name;
  double nearest, farthest;
};
constexpr std::array<Band, 4> kBands{{{"4 to 46 cm apart", 0.44, 0.86},
                                      {"2 cm deep to 4 cm apart", 0.38, 0.44},
                                      {"4 to 10 cm deep", 0.30, 0.36},
                                      {"10 to 35 cm deep", 0.05, 0.30}}};

/// The first `count` poses of the paper's small steps in a band.
Poses posesIn(const Band& band, std::uint64_t seed, std::size_t count) {
  GeodesicMotion motion(smallStep(), seed, band.nearest);
  Poses all, chosen;
  while (chosen.a.size() < count) {
    motion.next(all, GeodesicMotion::kCycle);
    for (std::size_t i = 0; i < all.a.size() && chosen.a.size() < count; ++i) {
      if ((all.b[i].translation() - all.a[i].translation()).norm() > band.farthest) continue;
      chosen.a.push_back(all.a[i]);
      chosen.b.push_back(all.b[i]);
    }
  }
  return chosen;
}

/// Whether two bodies meet.
struct Way {
  std::string name;
  std::function<bool(const Isometry3d&, const Isometry3d&)> meet;
};

Way fclCollide(const Bodies& bodies, const char* name, fcl::GJKSolverType solver) {
  fcl::CollisionRequestd request;
  request.gjk_solver_type = solver;
  return {name, [=](const Isometry3d& a, const Isometry3d& b) {
            fcl::CollisionResultd result;
            return fcl::collide(bodies.a.get(), a, bodies.b.get(), b, request, result) > 0;
          }};
}

/// A method of distances, of which only the verdict counts.
Way verdictOf(const char* name, MethodPtr method) {
  const std::shared_ptr<Method> shared = std::move(method);
  return {name, [shared, answer = Answer()](const Isometry3d& a, const Isometry3d& b) mutable {
            shared->query(a, b, answer);
            return answer.outcome == Outcome::overlap;
          }};
}

/// This library's ways first: the other times are compared with the first one.
std::vector<Way> ways(const Bodies& bodies) {
  const auto cache = std::make_shared<PairCache>();
  const auto ask = [bodies](const Isometry3d& a, const Isometry3d& b, const QueryContext& context) {
    return collides(*bodies.a, a, *bodies.b, b, 0, context);
  };
  std::vector<Way> all{
      {"collides(), cold", [ask](const Isometry3d& a, const Isometry3d& b) { return ask(a, b, {}); }},
      {"collides(), with a PairCache",
       [ask, cache](const Isometry3d& a, const Isometry3d& b) { return ask(a, b, {cache.get()}); }},
      fclCollide(bodies, "fcl::collide, libccd", fcl::GST_LIBCCD),
      fclCollide(bodies, "fcl::collide, indep", fcl::GST_INDEP),
      verdictOf("FCL's GJK, duality-gap stop, cold", fclGapStop(bodies, false)),
      verdictOf("FCL's GJK, duality-gap stop, warm", fclGapStop(bodies, true))};
  if (MethodPtr bullet = bulletGjk(bodies)) all.push_back(verdictOf("Bullet GJK", std::move(bullet)));
  return all;
}

}  // namespace

Measurement verdictTimes(const SpeedOptions& options) {
  Measurement result;
  result.name = "verdict";
  const Bodies bodies = geodesicSpheres(2);
  const auto count = static_cast<std::size_t>(std::max(1, options.blocks)) * 175;
  result.about = {{"seed", options.seed},
                  {"vertices", bodies.a->volume().vertexCount()},
                  {"poses", count},
                  {"passes", kPasses}};
  for (const Band& band : kBands) {
    const Poses poses = posesIn(band, options.seed, count);
    const std::vector<Way> all = ways(bodies);
    std::vector<std::size_t> hits(all.size());
    std::vector<std::function<void(std::size_t)>> timed;
    for (std::size_t k = 0; k < all.size(); ++k)
      timed.emplace_back([&, k](std::size_t i) { hits[k] += all[k].meet(poses.a[i], poses.b[i]); });
    const std::vector<std::vector<double>> ns = passesInTurns(kPasses, count, timed);
    for (std::size_t k = 0; k < all.size(); ++k) {
      nlohmann::ordered_json row{
          {"bodies", band.name}, {"way", all[k].name}, {"ns", std::round(median(ns[k]))}};
      row.update(ratios(ns[k], ns[0], result.spread));
      row["hits"] =
          significant(100.0 * static_cast<double>(hits[k]) / static_cast<double>(kPasses * count), 4);
      result.rows.push_back(std::move(row));
    }
  }
  return result;
}

}  // namespace fcl_stpbv::benchmark
