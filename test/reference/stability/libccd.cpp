// libccd alone: it distinguishes overlap from separation, and computes the depth of an overlap, but no
// distance.
#include <ccd/ccd.h>

#include "test/reference/stability/contestant.h"

namespace fcl_stpbv::stability {

using Eigen::Vector3d;

namespace {

struct PlacedCorners {
  const Cloud& points;
  Eigen::Isometry3d pose;
};

Vector3d from(const ccd_vec3_t& v) { return {v.v[0], v.v[1], v.v[2]}; }

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const auto& body = *static_cast<const PlacedCorners*>(object);
  const Vector3d n = body.pose.linear().transpose() * from(*direction);
  const Vector3d* best = &body.points[0];
  for (const Vector3d& p : body.points)
    if (n.dot(p) > n.dot(*best)) best = &p;
  const Vector3d x = body.pose * *best;
  ccdVec3Set(point, x[0], x[1], x[2]);
}

void middle(const void* object, ccd_vec3_t* centre) {
  const auto& body = *static_cast<const PlacedCorners*>(object);
  Vector3d sum(0, 0, 0);
  for (const Vector3d& p : body.points) sum += p;
  const Vector3d x = body.pose * Vector3d(sum / static_cast<double>(body.points.size()));
  ccdVec3Set(centre, x[0], x[1], x[2]);
}

using Penetration = int (*)(const void*, const void*, const ccd_t*, ccd_real_t*, ccd_vec3_t*, ccd_vec3_t*);

class Libccd : public Contestant {
 public:
  Libccd(const Situation& s, Penetration penetration)
      : a_{s.a->corners, {}}, b_{s.b->corners, {}}, penetration_(penetration) {
    CCD_INIT(&ccd_);
    ccd_.support1 = ccd_.support2 = support;
    ccd_.center1 = ccd_.center2 = middle;
    ccd_.max_iterations = 500;  // as in FCL; libccd's default is no limit
    ccd_.epa_tolerance = ccd_.mpr_tolerance = ccd_.dist_tolerance = 1e-10;
  }

  Answer query(const Placement& at) override {
    a_.pose = at.a;
    b_.pose = at.b;
    ccd_real_t depth = 0;
    ccd_vec3_t direction, position;
    Answer answer;
    switch (penetration_(&a_, &b_, &ccd_, &depth, &direction, &position)) {
      case 0:
        answer.kind = Answer::Kind::distance;
        answer.distance = -depth;
        Eigen::Map<Vector3d>(answer.normal, 3) = from(direction);
        break;
      case -1:
        answer.kind = Answer::Kind::apart;
        break;
      default:
        answer.kind = Answer::Kind::refusal;
        break;
    }
    return answer;
  }

 private:
  PlacedCorners a_, b_;
  Penetration penetration_;
  ccd_t ccd_;
};

}  // namespace

std::unique_ptr<Contestant> libccdEpa(const Situation& s) {
  return std::make_unique<Libccd>(s, ccdGJKPenetration);
}
std::unique_ptr<Contestant> libccdMpr(const Situation& s) {
  return std::make_unique<Libccd>(s, ccdMPRPenetration);
}

}  // namespace fcl_stpbv::stability
