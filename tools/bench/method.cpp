// The methods that are timed. Polyhedra: fcl::distance with each of FCL's solvers, and FCL's GJK with the
// duality gap as its stopping criterion. STP-BVs: started from FCL's witness, or from the last answer.
// Bullet's method is in bullet.cpp.
#include "tools/bench/method.h"

#include <fcl/narrowphase/distance.h>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/formatted.h"

namespace fcl_stpbv::benchmark {

using namespace detail;

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

class Fcl : public Method {
 public:
  Fcl(const Bodies& bodies, const char* itsName, fcl::GJKSolverType solver, double tolerance)
      : Method(itsName, formatted("tolerance %.0e", tolerance), false), bodies_(bodies), request_(true) {
    request_.gjk_solver_type = solver;
    request_.distance_tolerance = tolerance;
  }

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    fcl::DistanceResultd result;
    answer = {};
    try {
      answer.distance = fcl::distance(bodies_.a.get(), a, bodies_.b.get(), b, request_, result);
    } catch (const std::exception&) {
      return;  // FCL throws if one of its own checks fails
    }
    answer.outcome = answer.distance > 0 ? Outcome::apart : Outcome::overlap;
    answer.point = {result.nearest_points[0], result.nearest_points[1]};
  }

 private:
  Bodies bodies_;
  fcl::DistanceRequestd request_;
};

class GapStop : public Method {
 public:
  GapStop(const Bodies& bodies, bool warm)
      : Method("FCL with gap stop", warm ? "warm" : "cold", false), bodies_(bodies), warm_(warm) {}

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    const PolyhedralWitness w = polyhedralWitness(bodies_.a->hull(), a, bodies_.b->hull(), b, start_);
    if (warm_) start_ = w.start();
    answer.outcome = w.verdict == PolyhedralWitness::Verdict::separated     ? Outcome::apart
                     : w.verdict == PolyhedralWitness::Verdict::overlapping ? Outcome::overlap
                                                                            : Outcome::failed;
    answer.distance = w.upper;
    answer.point = w.point;
    answer.normal = w.direction;
  }

 private:
  Bodies bodies_;
  bool warm_;
  WitnessStart start_;
};

Outcome outcomeOf(DistanceStatus status, double distance) {
  if (status == DistanceStatus::invalid || status == DistanceStatus::bounded) return Outcome::failed;
  return distance > 0 ? Outcome::apart : Outcome::overlap;
}

class ThroughFcl : public Method {
 public:
  explicit ThroughFcl(const Bodies& bodies) : Method("STP-BV through FCL", "cold", true), bodies_(bodies) {}

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    QueryContext context;
    context.start = StartFrom::fclWitness;
    const DistanceAnswer d = distance(*bodies_.a, a, *bodies_.b, b, context);
    answer.outcome = outcomeOf(d.status, d.distance);
    answer.distance = d.distance;
    answer.point = d.points;
    answer.normal = d.normal;
    answer.gradient = d.gradient;
  }

 private:
  Bodies bodies_;
};

class Warm : public Method {
 public:
  explicit Warm(const Bodies& bodies) : Method("STP-BV warm", "warm", true), bodies_(bodies) {}

  void query(const Isometry3d& a, const Isometry3d& b, Answer& answer) override {
    const Distance d = distance(bodies_.a->volume(), a, bodies_.b->volume(), b, &cache_);
    answer.outcome = outcomeOf(d.status, d.distance);
    answer.distance = d.distance;
    answer.point = d.point;
    answer.normal = d.normal;
    answer.gradient = {d.gradient(0, a.translation()), d.gradient(1, b.translation())};
  }

 private:
  Bodies bodies_;
  PairCache cache_;
};

}  // namespace

Bodies twice(const test::Cloud& cloud, const StpBvOptions& options) {
  return {std::make_shared<StpBvGeometry>(StpBv::build(cloud, options)),
          std::make_shared<StpBvGeometry>(StpBv::build(cloud, options))};
}

Bodies geodesicSpheres(int subdivisions) {
  return twice(test::geodesicSphere(0.2, subdivisions), {0.01, 10.0});
}

MethodPtr fclLibccd(const Bodies& bodies, double tolerance) {
  return std::make_unique<Fcl>(bodies, "FCL libccd", fcl::GST_LIBCCD, tolerance);
}
MethodPtr fclIndep(const Bodies& bodies, double tolerance) {
  return std::make_unique<Fcl>(bodies, "FCL indep", fcl::GST_INDEP, tolerance);
}
MethodPtr fclGapStop(const Bodies& bodies, bool warm) { return std::make_unique<GapStop>(bodies, warm); }
MethodPtr stpBvThroughFcl(const Bodies& bodies) { return std::make_unique<ThroughFcl>(bodies); }
MethodPtr stpBvWarm(const Bodies& bodies) { return std::make_unique<Warm>(bodies); }

std::vector<MethodPtr> peers(const Bodies& bodies) {
  std::vector<MethodPtr> methods;
  methods.push_back(fclLibccd(bodies));
  methods.push_back(fclIndep(bodies));
  if (MethodPtr bullet = bulletGjk(bodies)) methods.push_back(std::move(bullet));
  methods.push_back(fclGapStop(bodies, true));
  methods.push_back(stpBvThroughFcl(bodies));
  methods.push_back(stpBvWarm(bodies));
  return methods;
}

}  // namespace fcl_stpbv::benchmark
