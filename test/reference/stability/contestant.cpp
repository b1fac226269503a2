// The table of methods, and the methods of FCL and of the library: fcl::distance with either solver, signed
// or not; STP-BVs started from FCL's witness or from the last answer; the paper's mapping alone (IV.C, IV.D),
// whose features are not checked. Bullet and libccd have their own files.
#include "test/reference/stability/contestant.h"

#include <fcl/narrowphase/distance.h>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/feature_map.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv::stability {

using namespace fcl_stpbv::detail;

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

template <fcl::GJKSolverType kSolver, bool kSigned, int kExponent>
class Fcl : public Contestant {
 public:
  explicit Fcl(const Situation& s) : a_(*s.a->sharp), b_(*s.b->sharp), request_(true, kSigned) {
    request_.gjk_solver_type = kSolver;
    request_.distance_tolerance = std::pow(10.0, -kExponent);
  }

  static std::unique_ptr<Contestant> make(const Situation& s) { return std::make_unique<Fcl>(s); }

  Answer query(const Placement& at) override {
    fcl::DistanceResultd result;
    Answer answer;
    answer.distance = fcl::distance(&a_, at.a, &b_, at.b, request_, result);
    answer.kind = Answer::Kind::distance;
    if (!kSigned && answer.distance == -1) {  // FCL's value for an overlap, and for an error
      answer.kind = Answer::Kind::overlap;
      return answer;
    }
    const Vector3d p = result.nearest_points[0], q = result.nearest_points[1];
    put(answer.distance < 0 ? Vector3d(p - q).normalized() : Vector3d(q - p).normalized(), answer.normal);
    put(p, answer.point[0]);
    put(q, answer.point[1]);
    answer.hasPoints = true;
    return answer;
  }

 private:
  const fcl::Convexd &a_, &b_;
  fcl::DistanceRequestd request_;
};

template <typename Found>
Answer smoothAnswer(const Found& found, const std::array<Vector3d, 2>& points) {
  Answer answer;
  if (found.status == DistanceStatus::invalid) {
    answer.kind = Answer::Kind::refusal;
    return answer;
  }
  answer.kind = Answer::Kind::distance;
  answer.distance = found.distance;
  answer.lower = found.lower;
  answer.upper = found.upper;
  answer.onlyLocal = found.status != DistanceStatus::exact;
  put(found.normal, answer.normal);
  put(points[0], answer.point[0]);
  put(points[1], answer.point[1]);
  answer.hasPoints = true;
  return answer;
}

class ThroughFcl : public Contestant {
 public:
  explicit ThroughFcl(const Situation& s) : a_(*s.a->smooth), b_(*s.b->smooth) {}

  Answer query(const Placement& at) override {
    QueryContext context;
    context.start = StartFrom::fclWitness;
    const DistanceAnswer d = distance(a_, at.a, b_, at.b, context);
    return smoothAnswer(d, d.points);
  }

 private:
  const StpBvGeometry &a_, &b_;
};

class Warm : public Contestant {
 public:
  explicit Warm(const Situation& s) : a_(s.a->smooth->volume()), b_(s.b->smooth->volume()) {}

  Answer query(const Placement& at) override {
    const Distance d = distance(a_, at.a, b_, at.b, &cache_);
    return smoothAnswer(d, d.point);
  }

 private:
  const StpBv &a_, &b_;
  PairCache cache_;
};

/// Only the paper's mapping (IV.C, IV.D): polyhedral witness, smooth features, their distance. It is not
/// checked that these are the right features.
class Heuristic : public Contestant {
 public:
  explicit Heuristic(const Situation& s) : a_(*s.a->smooth), b_(*s.b->smooth) {}

  Answer query(const Placement& at) override {
    Answer answer;
    const PolyhedralWitness witness = polyhedralWitness(a_.hull(), at.a, b_.hull(), at.b);
    const std::array<int, 2> mapped = mapFeatures(a_, at.a, b_, at.b, witness);
    if (mapped[0] < 0 || mapped[1] < 0) {
      answer.kind = Answer::Kind::refusal;  // the polyhedra overlap, so there are no closest features
      return answer;
    }
    const Matrix3d toA = at.a.linear().transpose();
    const RelativePose pose(at.a, at.b);
    const BodyPair pair(a_.volume(), b_.volume(), pose);
    const PosedPatch p = pair.patchA(mapped[0]), q = pair.patchB(mapped[1]);
    const Packed widest = widestNormal(p, q, pack(toA * witness.direction)).unit();
    const Vector3d n = unpack(widest);
    const CoreGap gap = coreGap(p, q, widest);
    answer.kind = Answer::Kind::distance;
    answer.distance = gap.value - pair.margins();
    put(at.a.linear() * n, answer.normal);
    const Vector3d y = unpack(gap.point) + a_.volume().radii().r * n;
    put(at.a * y, answer.point[0]);
    put(at.a * Vector3d(y + unpack(gap.across) + answer.distance * n), answer.point[1]);
    answer.hasPoints = true;
    return answer;
  }

 private:
  const StpBvGeometry &a_, &b_;
};

template <typename T>
std::unique_ptr<Contestant> made(const Situation& s) {
  return std::make_unique<T>(s);
}

}  // namespace

std::vector<Method> allMethods() {
  std::vector<Method> all{
      {"fcl_libccd_1e-6", "FCL libccd, 1e-6", false, false, Fcl<fcl::GST_LIBCCD, false, 6>::make},
      {"fcl_libccd_1e-10", "FCL libccd, 1e-10", false, false, Fcl<fcl::GST_LIBCCD, false, 10>::make},
      {"fcl_libccd_signed_1e-6", "FCL libccd signed, 1e-6", false, true, Fcl<fcl::GST_LIBCCD, true, 6>::make},
      {"fcl_libccd_signed_1e-10", "FCL libccd signed, 1e-10", false, true,
       Fcl<fcl::GST_LIBCCD, true, 10>::make},
      {"fcl_indep", "FCL indep", false, false, Fcl<fcl::GST_INDEP, false, 6>::make},
      {"fcl_indep_signed", "FCL indep signed", false, true, Fcl<fcl::GST_INDEP, true, 6>::make},
      {"libccd_epa", "libccd GJK+EPA", false, true, libccdEpa},
      {"libccd_mpr", "libccd MPR", false, true, libccdMpr},
      {"bullet", "Bullet GJK/EPA", false, true, bullet},
      {"stpbv_heuristic", "STP-BV, paper's mapping alone", true, true, made<Heuristic>},
      {"stpbv_fcl", "STP-BV through FCL", true, true, made<ThroughFcl>},
      {"stpbv_warm", "STP-BV warm", true, true, made<Warm>}};
#ifndef FCL_STPBV_BULLET
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].id == "bullet") all.erase(all.begin() + static_cast<std::ptrdiff_t>(i--));
#endif
  return all;
}

}  // namespace fcl_stpbv::stability
