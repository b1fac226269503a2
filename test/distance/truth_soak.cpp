// Checks that lower <= true value <= upper exactly as returned: random pairs of volumes with sizes from a
// micrometre to 1000 km, with and without a margin, R up to 1e8 m, near the origin and 10 km from it, in both
// orders.
//
//   truth_soak [QUERIES [SEED [DIGITS]]]
//
// The true value is enclosed along the answer's normal (enclosure.h), for every DIGITS-th query in a hundred
// digits. Returns 1 if a bound misses the true value, if the two orders exclude each other, or if too few
// true values were known accurately enough.
#include <cmath>
#include <cstdio>

#include "test/distance/enclosure.h"
#include "test/reference/arguments.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

struct Body {
  Cloud cloud;
  StpBvOptions radii;
  StpBv::Ptr volume;
};

/// A body of about `scale` metres, with R from 1.5 times the least to 1e8 m.
Body randomBody(Random& random, double scale) {
  Body body;
  switch (random.below(4)) {
    case 0:
      body.cloud = box(0.3, 0.2, 0.5);
      break;
    case 1:
      body.cloud = cylinder(0.1, 0.3, 12);
      break;
    case 2:
      body.cloud = randomHull(30, {0.2, 0.1, 0.3}, static_cast<std::uint64_t>(random.below(1000)));
      break;
    default:
      body.cloud = {{0, 0, -0.2}, {0.1, 0, 0.2}};
      break;
  }
  for (Vector3d& p : body.cloud) p *= scale;
  body.radii.r = random.below(3) == 0 ? 0.0 : scale * std::pow(10, random.uniform(-4, -1));
  const double least = std::log10(scale), most = std::max(8.0, least + 1);
  body.radii.R = std::pow(10, random.uniform(least, most));
  body.volume = StpBv::build(body.cloud, body.radii);
  return body;
}

class Soak {
 public:
  explicit Soak(std::uint64_t seed) : random_(seed) {}

  void query(bool hundred) {
    if (count_ % kQueriesOfAPair == 0) {
      const double scale = std::pow(10, random_.uniform(-6, 6));
      scale_ = scale;
      a_ = randomBody(random_, scale);
      b_ = randomBody(random_, scale);
    }
    ++count_;
    const Vector3d away = (random_.below(4) == 0 ? 1e4 : scale_) * random_.direction();
    const Isometry3d pa = pose(random_.rotation(), away);
    Isometry3d pb = pose(random_.rotation(), away + 2 * scale_ * random_.direction());
    const Distance far = distance(*a_.volume, pa, *b_.volume, pb);
    const double margin = a_.radii.r + b_.radii.r;
    const double gap =
        random_.below(3) ? scale_ * std::pow(10, -random_.uniform(0, 9)) : -margin * random_.uniform(0, 0.99);
    pb.translation() += (gap - far.distance) * far.normal;
    const Distance d = distance(*a_.volume, pa, *b_.volume, pb), e = distance(*b_.volume, pb, *a_.volume, pa);
    if (!(e.lower <= d.upper && d.lower <= e.upper)) fail("the two orders exclude each other", d);
    // 10 km away, a pair of micrometres may end up in any position.
    if (d.status != DistanceStatus::exact) return;
    ++exact_;
    const double size = a_.radii.R + b_.radii.R + scale_ + (pb.translation() - pa.translation()).norm();
    const double fine = kFine * (d.upper - d.lower);
    if (hundred)
      check<Hundred>(d, pa, pb, true);
    else if (roundings<long double>(size) <= fine)
      check<long double>(d, pa, pb, true);
    else
      check<Quad>(d, pa, pb, exact_ % kSearchedQuads == 0);
  }

  int report() const {
    std::printf(
        "%ld queries, %ld of them exact; their truth is known to 4 %% of the certificate's width for %ld, "
        "%ld of them in a hundred digits; %ld violations\n",
        count_, exact_, known_, hundred_, failures_);
    return failures_ > 0 || 2 * known_ < exact_ ? 1 : 0;
  }

 private:
  static constexpr long kQueriesOfAPair = 50;
  // A true value that is known to this share of the certificate's width reveals every miss.
  static constexpr double kFine = 1e-2;
  // A search in 113 bits takes a tenth of a second, so only one of this many queries gets one.
  static constexpr long kSearchedQuads = 500;
  template <class Real>
  void check(const Distance& d, const Isometry3d& pa, const Isometry3d& pb, bool search) {
    const double fine = kFine * (d.upper - d.lower);
    const Enclosure<Real> truth = enclose<Real>(d, {a_.cloud, a_.radii.r, a_.radii.R, pa},
                                                {b_.cloud, b_.radii.r, b_.radii.R, pb}, fine, search);
    hundred_ += std::numeric_limits<Real>::digits10 >= 100;
    known_ += truth.width() <= 4 * fine;
    if (!truth.holdsLower(d.lower)) fail("lower is above the truth", d);
    if (!truth.holdsUpper(d.upper)) fail("upper is below the truth", d);
    if (!(d.lower <= d.distance && d.distance <= d.upper)) fail("the distance is outside its bounds", d);
  }

  void fail(const char* what, const Distance& d) {
    if (++failures_ > 20) return;
    std::printf("FAILED: %s: size %g, r %g %g, R %g %g, distance %.17g in [%.17g, %.17g]\n", what, scale_,
                a_.radii.r, b_.radii.r, a_.radii.R, b_.radii.R, d.distance, d.lower, d.upper);
  }

  Random random_;
  double scale_ = 1;
  Body a_, b_;
  long count_ = 0, exact_ = 0, known_ = 0, hundred_ = 0, failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[QUERIES [SEED [DIGITS]]]", 3);
  const long queries = arguments.number(1, 20000L), digits = arguments.number(3, 10000L);
  Soak soak(arguments.number(2, std::uint64_t{1}, std::uint64_t{0}));
  for (long i = 0; i < queries; ++i) soak.query(i % digits == digits - 1);
  return soak.report();
}
