// Two hulls for libccd's GJK: scales the pair by a power of two to size about 1, because libccd's tolerances
// are absolute, brings both into one frame, and answers libccd's callbacks for support points. The vertices
// behind the points are logged, so that a simplex can name them afterwards.
#include "fcl_stpbv/adapter/posed_hulls.h"

#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// A pair this many times farther apart than it is large is scaled by its distance instead, so that products
// of three coordinates stay far from overflow.
constexpr double kFar = 1e8;

Vector3d fromCcd(const ccd_vec3_t& v) { return {v.v[0], v.v[1], v.v[2]}; }
void toCcd(const Vector3d& v, ccd_vec3_t* out) { ccdVec3Set(out, v[0], v[1], v[2]); }

}  // namespace

void PosedHulls::fit() {
  const Vector3d far = unpack(offset_);
  double size = std::max(a_.radius() + b_.radius(), far.lpNorm<1>() / kFar);
  if (!far.allFinite() || !std::isfinite(size)) return;  // nor is the offset where the rotation is not
  if (!(size > 0)) size = 1;                             // two points on one spot
  int exponent = 0;
  std::frexp(size, &exponent);
  scale_ = std::ldexp(1.0, -exponent);
  offset_ *= scale_;
  usable_ = std::isfinite(scale_) && scale_ > 0;
}

void PosedHulls::ccdSupportA(const void* pair, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  // libccd passes its objects as const; these are ours and live on one query's stack.
  auto& self = *const_cast<PosedHulls*>(static_cast<const PosedHulls*>(pair));
  ++self.supports_;
  const int v = self.climbA(fromCcd(*direction));
  self.logA_.add(v);
  toCcd(self.pointA(v), point);
}

void PosedHulls::ccdSupportB(const void* pair, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  auto& self = *const_cast<PosedHulls*>(static_cast<const PosedHulls*>(pair));
  const int v = self.climbB(-fromCcd(*direction));
  self.logB_.add(v);
  toCcd(self.pointB(v), point);
}

void PosedHulls::ccdFirstDirection(const void* pair, const void*, ccd_vec3_t* direction) {
  toCcd(static_cast<const PosedHulls*>(pair)->first_, direction);
}

int PosedHulls::loggedVertexA(const ccd_vec3_t& point) const {
  const Vector3d p = fromCcd(point);
  int best = -1;
  double nearest = kInfinity;
  for (int i = 0; i < std::min(logA_.count, kLog); ++i) {
    const int v = logA_.vertex[static_cast<std::size_t>(i)];
    const double d = (pointA(v) - p).squaredNorm();
    if (d < nearest) nearest = d, best = v;
  }
  return best;
}

int PosedHulls::loggedVertexB(const ccd_vec3_t& point) const {
  const Vector3d p = fromCcd(point);
  int best = -1;
  double nearest = kInfinity;
  for (int i = 0; i < std::min(logB_.count, kLog); ++i) {
    const int v = logB_.vertex[static_cast<std::size_t>(i)];
    const double d = (pointB(v) - p).squaredNorm();
    if (d < nearest) nearest = d, best = v;
  }
  return best;
}

}  // namespace fcl_stpbv::detail
