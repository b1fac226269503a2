#include "fcl_stpbv/distance/penetration.h"

#include <algorithm>

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// The few best of many starts, apart from each other so that they do not all lead to the same maximum.
class Starts {
 public:
  void offer(const Sample& s) {
    constexpr double kSame = 0.97;  // cosine of 14 degrees
    for (int i = 0; i < count_; ++i) {
      Sample& kept = sample_[static_cast<std::size_t>(i)];
      if (kept.n.dot(s.n) > kSame) {
        if (s.core > kept.core) kept = s;
        return;
      }
    }
    if (count_ < kKept) {
      sample_[static_cast<std::size_t>(count_++)] = s;
      return;
    }
    const auto worst = std::min_element(sample_.begin(), sample_.end(),
                                        [](const Sample& p, const Sample& q) { return p.core < q.core; });
    if (s.core > worst->core) *worst = s;
  }
  Sample* begin() { return sample_.data(); }
  Sample* end() { return sample_.data() + count_; }

 private:
  static constexpr int kKept = 4;
  std::array<Sample, kKept> sample_;
  int count_ = 0;
};

constexpr int kFaces =
    64;  // face normals tried per body; more faces than that are small ones of a round body

}  // namespace

void leastPenetration(const BodyPair& pair, Sample& x, Work& work) {
  constexpr std::array<int, 2> kNoHint{-1, -1};
  Starts starts;
  int ignored = 0;
  const auto tryNormal = [&](const Vector3d& n, const std::array<int, 2>& hint) {
    starts.offer(pair.sampleFrom(n, hint, ignored));
  };
  starts.offer(x);
  for (int code = 0; code < 27; ++code) {
    const Vector3d d(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (code == 13) continue;
    tryNormal(d.normalized(), kNoHint);
    tryNormal(pair.pose().rotation * d.normalized(), kNoHint);
  }
  const StpBv &a = pair.a(), &b = pair.b();
  const int strideA = 1 + a.faceCount() / kFaces, strideB = 1 + b.faceCount() / kFaces;
  for (int f = 0; f < a.faceCount(); f += strideA)
    tryNormal(a.patch(a.facePatch(f)).axis, {a.facePatch(f), -1});
  for (int f = 0; f < b.faceCount(); f += strideB)
    tryNormal(-(pair.pose().rotation * b.patch(b.facePatch(f)).axis), {-1, b.facePatch(f)});

  for (Sample& start : starts) {
    ascend(pair, start, work);
    if (start.core > x.core) x = start;
  }
}

}  // namespace fcl_stpbv
